"""The static transforms of other nodes, so that the simulator gives no frame a second parent.

With the tutorial's parameters the simulator publishes odom -> base_link and base_footprint ->
wheels. A robot_state_publisher publishes base_footprint -> base_link as a static transform, and the
wheels. TF keeps one parent per frame, so the robot falls apart, and every listener prints warnings
for each wheel (TF_REPEATED_DATA; TF_OLD_DATA if that node uses the wall clock). So the simulator
publishes the transform to the root of the static tree, and leaves the wheels to the other node.

Subscribes:
    /tf_static (tf2_msgs/TFMessage).
"""

import contextlib
from collections.abc import Callable

import rospy
from tf2_msgs.msg import TFMessage

from ...sim.core import Pose, compose, inverse
from ...sim.runtime import FrameTransform
from ..messages import Parents, read_transforms
from ..transport import publisher_names, sender_of
from .loop import Loop

STATIC_TOPIC = '/tf_static'
PERIOD = 0.5  # how often it is checked which publishers still exist [s, wall]


class StaticFrames:
    """The static transforms of other nodes on /tf_static; any thread may read them.

    `parents` and `nodes` are replaced and never modified, so a reader has a consistent copy.
    `listeners` are called after each replacement, on the thread that owns the world.
    """

    def __init__(self) -> None:
        self._by_node: dict[str, dict[str, tuple[str, Pose]]] = {}
        self._watching = False
        self.listeners: list[Callable[[], None]] = []
        self.parents: Parents = {}
        self.nodes: frozenset[str] = frozenset()  # names of the publishing nodes

    def watch(self, loop: Loop) -> None:
        """Subscribe to /tf_static."""
        self._watching = True

        def receive(message: TFMessage) -> None:
            loop.post(lambda: self.add(sender_of(message), message))

        subscriber = rospy.Subscriber(STATIC_TOPIC, TFMessage, receive)

        def poll() -> None:
            with contextlib.suppress(rospy.ROSInterruptException):
                self.retain(publisher_names(subscriber))

        loop.every(PERIOD, poll)

    def add(self, node: str, message: TFMessage) -> None:
        """Store the transforms of a node; invalid ones are ignored, as in TF."""
        self._by_node[node] = self._by_node.get(node, {}) | read_transforms(message)
        self._merge()

    def expect(self, nodes: set[str]) -> None:
        """Add nodes that are registered as publishers, though no message of theirs has arrived.

        No effect before `watch`.
        """
        if self._watching:
            for node in nodes:
                self._by_node.setdefault(node, {})
            self._merge()

    def retain(self, nodes: set[str]) -> None:
        """Remove the transforms of all nodes but these; the others are gone."""
        gone = self._by_node.keys() - nodes
        if gone:
            for node in gone:
                del self._by_node[node]
            self._merge()

    def _merge(self) -> None:
        self.parents = {
            child: edge
            for transforms in self._by_node.values()
            for child, edge in transforms.items()
        }
        self.nodes = frozenset(self._by_node)
        for listener in self.listeners:
            listener()


def from_root(edge: FrameTransform, parents: Parents) -> FrameTransform:
    """Return the transform from the parent of `edge` to the root of its child's static tree.

    It is `edge` itself if its child has no static parent, or if that is the parent of `edge`.
    """
    parent, root, pose = edge
    if root not in parents:
        return edge
    seen = {root}
    while root in parents:
        root, transforms = parents[root]
        if root == parent or root in seen:
            return edge
        seen.add(root)
        pose = compose(pose, inverse(transforms))
    return FrameTransform(parent, root, pose)
