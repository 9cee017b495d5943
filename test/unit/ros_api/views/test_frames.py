"""TF frames for the window: one per model, sent when it has moved."""

from dataclasses import replace

from support import urdf_spec
from support.fake_engine import FakeEngine

from rosbots_description.ros_api.views.frames import ShownFrames
from rosbots_description.sim.core.transforms import Pose
from rosbots_description.sim.runtime.world import World

BOX = urdf_spec(
    '<link name="box"><inertial><mass value="1"/>'
    '<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>'
)
ARM = replace(BOX, links=(BOX.links[0], replace(BOX.links[0], name='hand')))
UP = Pose((0.0, 0.0, 1.0))


def test_frame_of_a_model_is_sent_once_and_after_motion():
    world = World(make_engine=FakeEngine)
    world.spawn(BOX, 'crate', Pose())
    robot = world.spawn(ARM, 'robot', Pose())
    shown = ShownFrames(world)
    assert [(frame.header.frame_id, frame.child_frame_id) for frame in shown.changes()] == [
        ('world', 'crate'),
        ('world', 'robot'),
    ]
    assert shown.changes() == []
    robot.set_pose(Pose((1.0, 2.0, 3.0)))
    (moved,) = shown.changes()
    assert moved.child_frame_id == 'robot'
    assert moved.transform.translation.y == 2.0
    hand = replace(ARM.links[1], pose=UP)
    robot.body.spec = replace(ARM, links=(ARM.links[0], hand))
    world.run(1)
    assert robot.links['hand'].pose == Pose((1.0, 2.0, 4.0))
    assert shown.changes() == []  # of another link
    shown.reset()
    assert len(shown.changes()) == 2
