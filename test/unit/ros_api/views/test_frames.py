"""The frames of the window: each model, only when it has moved."""

from types import SimpleNamespace

from rosbots_description.ros_api.views.frames import ShownFrames
from rosbots_description.sim.core.transforms import IDENTITY, Pose


def test_each_model_is_shown_once_and_again_when_it_has_moved():
    robot = SimpleNamespace(pose=IDENTITY)
    shown = ShownFrames(SimpleNamespace(models={
        'ground': SimpleNamespace(pose=IDENTITY), 'robot': robot}))
    assert [(frame.header.frame_id, frame.child_frame_id) for frame in shown.look()] == [
        ('world', 'ground'), ('world', 'robot')]
    assert shown.look() == []
    robot.pose = Pose((1.0, 2.0, 3.0))
    (moved,) = shown.look()
    assert moved.child_frame_id == 'robot'
    assert moved.transform.translation.y == 2.0
    shown.begin()
    assert len(shown.look()) == 2
