"""Frames of the models, for a view that follows a model.

Publishes:
    ~view/frames (tf2_msgs/TFMessage, as on /tf_static): world to each model, named as the model;
        all of them for a new subscriber, then those that moved. gzclient uses no other frames,
        since on /tf a robot may have two parents or none, and stamps may jump back.
"""

from geometry_msgs.msg import TransformStamped
from tf2_msgs.msg import TFMessage

from ...sim.core import Pose
from ...sim.runtime import World
from ..messages import fill_transform
from ..server import Server
from .markers import FRAME
from .visuals import publish_changes


class ShownFrames:
    """Poses of the models as last published, to find those that moved."""

    def __init__(self, world: World) -> None:
        self._world = world
        self._shown: dict[str, Pose] = {}

    def reset(self) -> None:
        """Publish all frames next time."""
        self._shown.clear()

    def changes(self) -> list[TransformStamped]:
        """Return the frames of the models that moved since the last call."""
        poses = {name: model.pose for name, model in self._world.models.items()}
        moved = [
            _transform(name, pose) for name, pose in poses.items() if self._shown.get(name) != pose
        ]
        self._shown = poses
        return moved


def _transform(name: str, pose: Pose) -> TransformStamped:
    made = TransformStamped(child_frame_id=name)
    made.header.frame_id = FRAME
    fill_transform(made.transform, pose)
    return made


def advertise_frames(server: Server) -> None:
    """Advertise the frames and update them in wall time, also while paused."""
    publish_changes(server, '~view/frames', TFMessage, ShownFrames(server.world))
