"""A model that is held stays where it is, until it is let go or the time has passed."""

import math

import pytest
from geometry_msgs.msg import Point as PointMessage
from geometry_msgs.msg import Pose, Quaternion
from rosbots_msgs.srv import HoldModelRequest
from support.bench import BOX, Bench, empty_world

from rosbots_description.ros_api.services import holding
from rosbots_description.sim.core.transforms import Pose as SimPose
from rosbots_description.sim.formats import load_urdf
from rosbots_description.sim.runtime import NEVER

HIGH = Pose(PointMessage(0.0, 0.0, 5.0), Quaternion(0.0, 0.0, 0.0, 1.0))


@pytest.fixture
def clock(monkeypatch):
    """The wall clock, which a test moves."""
    now = [100.0]
    monkeypatch.setattr(holding.time, 'monotonic', lambda: now[0])
    return now


@pytest.fixture
def world():
    with empty_world() as world:
        spec, _ = load_urdf(BOX, 'b', find_package=lambda _: None, find_model=lambda _: None)
        world.spawn(spec, 'b', SimPose((0.0, 0.0, 0.5)))
        yield world


@pytest.fixture
def box(world):
    return world.models['b']


def hold(world, duration, name='b', pose=HIGH):
    return Bench(world).call('hold_model', HoldModelRequest(name, pose, duration))


def test_model_is_held_at_rest_until_the_time_has_passed(clock, world, box):
    assert hold(world, 1.0).success
    world.run(2000)  # simulated time does not count
    assert box.pose.position == pytest.approx((0.0, 0.0, 5.0), abs=1e-4)
    assert math.dist(box.twist.linear, (0.0, 0.0, 0.0)) < 0.02
    clock[0] += 1.1
    world.run(500)
    assert box.pose.position[2] == pytest.approx(5.0 - 0.5 * 9.8 * 0.25, rel=0.02)


def test_hold_without_duration_places_the_model_and_lets_it_go(clock, world, box):
    hold(world, 10.0)
    assert hold(world, 0.0).success
    assert box.pose.position == (0.0, 0.0, 5.0)
    world.run(500)
    assert box.pose.position[2] < 4.0


def test_model_that_goes_and_a_reset_end_a_hold(clock, world, box):
    hold(world, 10.0)
    world.reset_simulation()
    world.run(100)
    assert box.pose.position[2] == pytest.approx(0.5, abs=1e-3)
    hold(world, 10.0)
    world.delete('b')
    assert world.holds.due == NEVER


@pytest.mark.parametrize(
    ('duration', 'name', 'pose'),
    [
        (11.0, 'b', HIGH),
        (-1.0, 'b', HIGH),
        (math.nan, 'b', HIGH),
        (1.0, 'x', HIGH),
        (1.0, 'b', Pose(PointMessage(math.inf, 0.0, 0.0), HIGH.orientation)),
    ],
)
def test_bad_requests_are_refused(world, box, duration, name, pose):
    before = box.pose
    assert not hold(world, duration, name, pose).success
    assert box.pose == before
