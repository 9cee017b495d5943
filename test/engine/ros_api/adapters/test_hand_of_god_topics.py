"""Topics of the hand of god: it follows a TF frame and publishes the pose of its link."""

from contextlib import closing

import pytest
from support import urdf_spec
from support.scenes import box
from support.wire import Wire, transforms

from rosbots_description.sim.core.transforms import Pose
from rosbots_description.sim.runtime.world import World

STEP = Pose((1.0, 0.0, 0.0))
PLUGIN = (
    '<gazebo><plugin name="hog" filename="libgazebo_ros_hand_of_god.so">'
    '<linkName>base</linkName></plugin></gazebo>'
)


@pytest.fixture
def world():
    with closing(World()) as made:
        yield made


def test_hand_of_god_follows_a_frame_and_publishes_its_pose(world, monkeypatch):
    wire = Wire(monkeypatch)
    spec = urdf_spec(box('base', (1.0, 1.0, 1.0), 1.0) + PLUGIN)
    plugin = world.spawn(spec, 'thing', Pose()).plugin('hand_of_god')
    adapter = wire.join(plugin)
    take, topic = wire.subscribers['/tf'], wire.publishers['/tf']
    world.run(3)
    take(transforms(('world', 'other', STEP)))
    assert plugin.target is None
    take(transforms(('/world', '/hog_desired', STEP)))
    assert plugin.target == STEP
    topic.read('/unnamed')  # this node, by its subscription
    world.run(2)
    assert not topic.sent
    topic.read()
    world.run(1)
    (edge,) = topic.sent[-1].transforms
    assert (edge.header.frame_id, edge.child_frame_id) == ('world', 'hog_actual')
    assert edge.header.stamp.to_nsec() == 6_000_000
    adapter.close()
    assert not wire.subscribers
