"""External static transforms: the edge that moves the whole tree; publishers that end."""

import math
from types import SimpleNamespace

import pytest
from support.fake_drive import make, run
from support.wire import Wire, transforms

from rosbots_description.ros_api.adapters import drives
from rosbots_description.ros_api.server.static_frames import StaticFrames, from_root
from rosbots_description.sim.core.transforms import Pose, compose, from_rpy
from rosbots_description.sim.runtime.outputs import FrameTransform

HELD = Pose((0.0, 0.1, 0.05), from_rpy(0.0, 0.0, 0.3))
MOVED = Pose((1.0, 2.0, 0.0), from_rpy(0.1, 0.0, 1.2))


@pytest.fixture
def frames():
    return StaticFrames()


@pytest.fixture
def wire(monkeypatch):
    return Wire(monkeypatch)


def join_wheels(wire):
    """Return a drive that publishes its wheels, with a reader of /tf, and the static frames."""
    plugin = make(publishWheelTF='true', publishWheelJointState='true', publishOdomTF='false')
    frames = wire.join(plugin).server.static_frames
    wire.publishers['/tf'].read()
    return plugin, frames


def test_edge_stays_without_external_transforms_of_its_child(frames):
    frames.add('/rsp', transforms(('base_link', 'laser', HELD)))
    edge = FrameTransform('odom', 'base_link', MOVED)
    assert from_root(edge, frames.parents) is edge


def test_external_static_tree_is_moved_by_its_root(frames):
    frames.add(
        '/rsp', transforms(('base_footprint', 'base_link', HELD), ('base_link', 'laser', HELD))
    )
    for child, chain in (('base_link', HELD), ('laser', compose(HELD, HELD))):
        edge = from_root(FrameTransform('odom', child, MOVED), frames.parents)
        assert (edge.parent, edge.child) == ('odom', 'base_footprint')
        again = compose(edge.pose, chain)
        assert again.position == pytest.approx(MOVED.position, abs=1e-12)
        assert math.fabs(
            sum(a * b for a, b in zip(again.orientation, MOVED.orientation, strict=True))
        ) == pytest.approx(1.0)


@pytest.mark.parametrize(
    'edges',
    [
        [('odom', 'base_link', HELD)],
        [('odom', 'base_footprint', HELD), ('base_footprint', 'base_link', HELD)],
        [('base_link', 'base_footprint', HELD), ('base_footprint', 'base_link', HELD)],
    ],
)
def test_edge_stays_if_external_transforms_contain_it_or_form_a_loop(frames, edges):
    frames.add('/other', transforms(*edges))
    edge = FrameTransform('odom', 'base_link', MOVED)
    assert from_root(edge, frames.parents) is edge


def test_transforms_of_an_ended_node_are_forgotten(frames):
    frames.add('/rsp', transforms(('base_footprint', 'base_link', HELD)))
    frames.add('/camera', transforms(('base_link', 'camera', HELD)))
    frames.retain({'/camera'})
    assert frames.nodes == {'/camera'}
    assert set(frames.parents) == {'camera'}


@pytest.mark.parametrize(
    'pose', [Pose((math.nan, 0.0, 0.0)), Pose(orientation=(0.0, 0.0, 0.0, math.inf))]
)
def test_transform_that_is_not_finite_is_left_out(frames, pose):
    before = Pose((1.0, 0.0, 0.0))
    frames.add('/rsp', transforms(('a', 'b', before), ('a', 'b', pose)))
    assert frames.parents == {'b': ('a', before)}


@pytest.mark.parametrize(
    ('readers', 'holder', 'wanted'),
    [
        (set(), '/rsp', True),
        ({'/rsp'}, '/rsp', False),
        ({'/plotter'}, '/camera', True),  # one reads joint states, another holds a camera
    ],
)
def test_wheel_transforms_are_left_to_a_state_publisher(wire, readers, holder, wanted):
    plugin, frames = join_wheels(wire)
    for node in readers:
        wire.publishers['/joint_states'].read(node)
    run(plugin, 20)
    wheels = wire.publishers['/tf'].sent
    assert wheels
    wheels.clear()
    frames.add(holder, transforms(('base_footprint', 'base_link', HELD)))
    assert plugin.wheel_transform.wanted is wanted
    run(plugin, 20)
    assert bool(wheels) is wanted


def test_state_publisher_that_the_master_knows_counts_before_it_is_connected(wire, monkeypatch):
    monkeypatch.setattr(drives, 'subscribers', lambda *_: ({'/rsp'}, set()))
    plugin, frames = join_wheels(wire)
    assert plugin.wheel_transform.wanted
    frames.add('/rsp', transforms(('base_footprint', 'base_link', HELD)))
    assert not plugin.wheel_transform.wanted


def test_new_state_publisher_counts_before_its_notification(wire):
    plugin, frames = join_wheels(wire)
    frames.add('/rsp', transforms(('base_footprint', 'base_link', HELD)))
    states = wire.publishers['/joint_states']
    states.impl.subscriber_listeners.clear()
    states.read('/rsp')
    run(plugin, 20)
    assert not wire.publishers['/tf'].sent


@pytest.mark.parametrize('watching', [True, False])
def test_connected_node_counts_before_its_first_transforms(frames, watching, monkeypatch):
    monkeypatch.setattr('rospy.Subscriber', lambda *_: SimpleNamespace(impl=None))
    if watching:
        frames.watch(SimpleNamespace(every=lambda *_: None, post=None))
    frames.expect({'/rsp'})
    assert frames.nodes == ({'/rsp'} if watching else frozenset())
    assert frames.parents == {}
    frames.retain(set())
    assert frames.nodes == frozenset()
