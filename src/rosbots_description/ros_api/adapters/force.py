"""The topics of plugins that apply forces.

Subscribes:
    <ns>/<topicName> (geometry_msgs/Wrench): the wrench of force; it acts until the next one.
    /tf, /tf_static (tf2_msgs/TFMessage): hand_of_god follows <frameId>_desired in world, by the
        latest transform of each frame in between.
Publishes:
    /tf (tf2_msgs/TFMessage): hand_of_god, world to <frameId>_actual in each step once it follows.
"""

import rospy
from geometry_msgs.msg import Wrench
from tf2_msgs.msg import TFMessage

from ...sim.core import Pose, relative
from ...sim.plugins import Force, HandOfGod
from ..messages import Parents, TransformLayout, frames_above, read_transforms
from ..server import STATIC_TOPIC
from ..transport import subscriber_names
from .adapter import Adapter
from .declarations import Endpoint, PublishedTopic, Publishes, Serializer, Subscribes, finite
from .registry import declare_topics

WORLD = 'world'
_numbers = finite(*(f'{part}.{axis}' for part in ('force', 'torque') for axis in 'xyz'))


def read_wrench(message: Wrench) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """Return force [N] and torque [N m].

    Raises:
        ValueError: a number is not finite.
    """
    numbers = _numbers(message)
    return numbers[:3], numbers[3:]


def _hand(adapter: Adapter) -> HandOfGod:
    assert isinstance(adapter.plugin, HandOfGod)
    return adapter.plugin


def actual_serializer(adapter: Adapter) -> Serializer:
    """Return what lays out where the link is; its frames take no prefix."""
    layout = TransformLayout(WORLD, f'{_hand(adapter).frame}_actual')
    return lambda _number, now_ns, edge: layout.pack(now_ns, edge.pose)


class ActualTopic(PublishedTopic):
    """Where the link is, for other nodes; this one reads /tf, too, and need not be told."""

    def is_wanted(self) -> bool:
        """Tell whether another node reads it."""
        return super().is_wanted() and bool(subscriber_names(self.publisher) - {rospy.get_name()})


class FollowedFrame(Endpoint):
    """Tells a plugin where its desired frame is, as soon as that is known and when it has moved."""

    def __init__(self, adapter: Adapter) -> None:
        super().__init__(adapter)
        self._edges: dict[str, tuple[str, Pose]] = {}  # by frame: its parent, and its pose in that
        self._desired = f'{_hand(adapter).frame}_desired'.lstrip('/')
        self._followed: Pose | None = None

    def open(self) -> None:
        """Listen to TF."""
        for topic in ('/tf', STATIC_TOPIC):
            self.adapter.subscribe(topic, TFMessage, self._receive, 100)

    def refresh(self) -> None:
        """Look again; what others hold still may have changed."""
        self._update()

    def _receive(self, message: TFMessage) -> None:
        self._edges |= read_transforms(message)
        self._update()

    def _update(self) -> None:
        server, plugin = self.adapter.server, _hand(self.adapter)
        pose = pose_between(WORLD, self._desired, {**server.static_frames.parents, **self._edges})
        if pose is not None and pose != self._followed:
            self._followed = pose
            server.loop.post(lambda: plugin.follow(pose))


def pose_between(frame: str, child: str, edges: Parents) -> Pose | None:
    """Return the pose of `child` in `frame`; None if no edges lead from one to the other."""
    (root, base), (other, pose) = (list(frames_above(name, edges))[-1] for name in (frame, child))
    return relative(pose, base) if root == other else None


declare_topics(Force, Subscribes('command', Wrench, read_wrench))
declare_topics(
    HandOfGod,
    Publishes(
        'actual', TFMessage, '/tf', serializer=actual_serializer, queue=100, endpoint=ActualTopic
    ),
    FollowedFrame,
)
