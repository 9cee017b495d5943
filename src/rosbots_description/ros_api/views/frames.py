"""Frames of the models, for a view that follows a model.

Publishes:
    ~view/frames (tf2_msgs/TFMessage, as on /tf_static): world to each model, named as the model;
        all of them for a new subscriber, then those that moved. gzclient uses no other frames,
        since on /tf a robot may have two parents or none, and stamps may jump back.
"""

from geometry_msgs.msg import TransformStamped
from tf2_msgs.msg import TFMessage

from ...sim.core import Pose
from ...sim.runtime import NOTHING, World
from ..messages import fill_transform
from ..server import Server
from .markers import FRAME
from .visuals import publish_changes


class ShownFrames:
    """A reader of a world's changes: the frames of the models that moved."""

    def __init__(self, world: World) -> None:
        self._world = world
        self._seen = NOTHING

    def reset(self) -> None:
        """Publish all frames next time."""
        self._seen = NOTHING

    def changes(self) -> list[TransformStamped]:
        """Return the frames of the models that moved since the last call."""
        changes = self._world.revisions.since(self._seen)
        self._seen = changes.revision
        return [
            _transform(link.model.name, link.model.frame(pose))
            for link, pose in changes.moved.items()
            if link.spec is link.model.spec.links[0]
        ]


def _transform(name: str, pose: Pose) -> TransformStamped:
    made = TransformStamped(child_frame_id=name)
    made.header.frame_id = FRAME
    fill_transform(made.transform, pose)
    return made


def advertise_frames(server: Server) -> None:
    """Advertise the frames and update them in wall time, also while paused."""
    publish_changes(server, '~view/frames', TFMessage, ShownFrames(server.world))
