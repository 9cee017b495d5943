"""What a robot drags holds along some axes more than along others, whatever its inertia is."""

import math
from dataclasses import replace

import pytest
from support import empty_world

from rosbots_description.sim.body import HOLDS_ALL, Hold
from rosbots_description.sim.dragging import Dragged
from rosbots_description.sim.pose import Pose, from_rpy
from rosbots_description.sim.spec import (
    FIXED,
    Box,
    Collision,
    Inertial,
    JointSpec,
    LinkSpec,
    ModelSpec,
    Surface,
)
from rosbots_description.sim.tuning import Tuning
from rosbots_description.sim.wheel import Wheel

SIDEWAYS, AHEAD = (0.0, 1.0, 0.0), (1.0, 0.0, 0.0)
ROUND = Inertial(2.0, ixx=0.02, iyy=0.02, izz=0.02)
ASKEW = Inertial(2.0, ixx=0.02, iyy=0.03, izz=0.04, ixy=0.005, ixz=0.004)
PUSH = 10.0  # [N], half of what holds the sledge
FREE = Hold(sideways=0.0)
SHAPE = (Collision('c', Box((0.4, 0.4, 0.1))),)


def sledge(inertial, turn=0.0):
    """Return a box on the ground with a weightless wheel in the air, its axle along y.

    Args:
        turn: how far the box's frame is turned about z, away from the model's [rad].
    """
    base = LinkSpec('base', Pose(orientation=from_rpy(0.0, 0.0, turn)), inertial, SHAPE)
    wheel = LinkSpec('wheel', Pose((0.0, 0.0, 0.3)), Inertial(1e-3, ixx=1e-6, iyy=1e-6, izz=1e-6))
    return ModelSpec('sledge', (base, wheel), (JointSpec('axle', 'revolute', 'base', 'wheel',
                                                         axis=SIDEWAYS),))


def speed_after_a_push(spec, direction, hold):
    """Return how fast the sledge is after a push of 0.1 s against these shares of its friction."""
    with empty_world() as world:
        model = world.spawn(spec, 'sledge', Pose((0.0, 0.0, 0.05)))
        Dragged(model, Wheel(model.joint('axle'), 1.0, world.clock)).hold(hold)
        world.run(100)
        for _ in range(100):
            force = tuple(PUSH * part for part in direction)
            model.links['base'].push(force, (0.0, 0.0, 0.0))
            world.run(1)
        return math.hypot(*model.twist.linear[:2])


@pytest.mark.parametrize('turn', [0.0, math.pi / 2])
@pytest.mark.parametrize('inertial', [ROUND, ASKEW])
def test_on_the_straight_nothing_is_held_sideways_but_ahead(inertial, turn):
    spec = sledge(inertial, turn)
    assert speed_after_a_push(spec, SIDEWAYS, FREE) == pytest.approx(0.5, rel=0.02)
    assert speed_after_a_push(spec, AHEAD, FREE) < 1e-3


def test_ahead_a_share_of_it_holds():
    spec = sledge(ASKEW)
    quarter = Hold(ahead=0.25)
    assert speed_after_a_push(spec, AHEAD, quarter) == pytest.approx(0.25, abs=0.02)
    assert speed_after_a_push(spec, SIDEWAYS, quarter) < 1e-3


def test_in_curves_and_at_rest_all_holds():
    assert speed_after_a_push(sledge(ASKEW), SIDEWAYS, HOLDS_ALL) < 1e-3
    assert speed_after_a_push(sledge(ASKEW), AHEAD, HOLDS_ALL) < 1e-3


def test_what_was_free_holds_again():
    with empty_world() as world:
        model = world.spawn(sledge(ASKEW), 'sledge', Pose((0.0, 0.0, 0.05)))
        dragged = Dragged(model, Wheel(model.joint('axle'), 1.0, world.clock))
        dragged.hold(FREE)
        world.run(100)
        dragged.hold(HOLDS_ALL)
        for _ in range(100):
            model.links['base'].push((0.0, PUSH, 0.0), (0.0, 0.0, 0.0))
            world.run(1)
        assert math.hypot(*model.twist.linear[:2]) < 1e-3


def test_what_is_fixed_to_the_base_is_dragged_with_it():
    base = LinkSpec('base', Pose(), ROUND)
    skid = LinkSpec('skid', Pose(), ROUND, SHAPE)
    spec = sledge(ROUND)
    spec = ModelSpec('sledge', (base, spec.links[1], skid),
                     (*spec.joints, JointSpec('bolt', FIXED, 'base', 'skid')))
    assert speed_after_a_push(spec, SIDEWAYS, FREE) > 0.2
    assert speed_after_a_push(spec, AHEAD, FREE) < 1e-3


def test_a_robot_bolted_to_the_world_has_nothing_to_drag_but_itself():
    spec = sledge(ROUND)
    spec = ModelSpec('sledge', spec.links, (JointSpec('bolt', FIXED, 'world', 'base'),
                                            *spec.joints))
    assert speed_after_a_push(spec, SIDEWAYS, FREE) == 0.0


@pytest.mark.parametrize('kp', [1e12, 1e5])
def test_what_is_dragged_sinks_in_by_a_hair_or_as_described(kp):
    shape = replace(SHAPE[0], surface=Surface(kp=kp))
    base, wheel = sledge(ROUND).links
    spec = replace(sledge(ROUND), links=(replace(base, collisions=(shape,)), wheel))
    with empty_world() as world:
        model = world.spawn(spec, 'sledge', Pose((0.0, 0.0, 0.05)))
        dragged = Dragged(model, Wheel(model.joint('axle'), 1.0, world.clock))
        dragged.hold(HOLDS_ALL)
        world.run(2000)
        depth = Tuning().dragged_sinks if kp > 1e9 else 2.001 * 9.8 / kp
        # on four corners
        assert 0.05 - model.pose.position[2] == pytest.approx(depth / 4.0, abs=1e-5)
