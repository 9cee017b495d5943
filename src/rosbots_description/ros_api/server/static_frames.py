"""The frames that other nodes hold still, so that the simulator gives no frame a second parent.

By the article's numbers the simulator publishes odom -> base_link and base_footprint -> wheels. A
robot_state_publisher beside it holds base_footprint -> base_link still and turns the wheels. TF
keeps one parent for each frame, so the robot falls apart, and every listener complains about each
wheel (TF_REPEATED_DATA; TF_OLD_DATA if that node follows the wall clock). So we move what the other
node holds together as a whole, and leave the wheels to it.

Subscribes:
    /tf_static (tf2_msgs/TFMessage).
"""

import contextlib
from collections.abc import Callable, Mapping

import rospy
from tf2_msgs.msg import TFMessage

from ...sim.core import Pose, compose, inverse
from ...sim.runtime import FrameTransform
from ..messages import read_transform
from ..transport import publisher_names, sender_of
from .loop import Loop

STATIC_TOPIC = '/tf_static'
PERIOD = 0.5  # time between two looks whether who published is still there [s, wall]

Parents = Mapping[str, tuple[str, Pose]]  # by frame: its parent, and where it stands in that


class StaticFrames:
    """What other nodes publish on /tf_static; any thread may read it.

    `parents` and `nodes` are replaced and never changed: what was read stays true to itself.
    `listeners` are called when they were, on the thread that owns the world.
    """

    def __init__(self) -> None:
        self._by_node: dict[str, dict[str, tuple[str, Pose]]] = {}
        self._watching = False
        self.listeners: list[Callable[[], None]] = []
        self.parents: Parents = {}
        self.nodes: frozenset[str] = frozenset()  # names of those that publish here

    def watch(self, loop: Loop) -> None:
        """Listen from now on."""
        self._watching = True
        subscriber = rospy.Subscriber(
            STATIC_TOPIC, TFMessage, lambda message: loop.post(lambda: self._take(message))
        )

        def look() -> None:
            with contextlib.suppress(rospy.ROSInterruptException):
                self.keep(publisher_names(subscriber))

        loop.every(PERIOD, look)

    def _take(self, message: TFMessage) -> None:
        self.add(sender_of(message), message)

    def add(self, node: str, message: TFMessage) -> None:
        """Note what a node holds still; what is no pose is left out, as TF leaves it out."""
        held = dict(self._by_node.get(node, ()))
        for transform in message.transforms:
            try:
                pose = read_transform(transform.transform)
            except ValueError:
                continue
            parent, child = transform.header.frame_id, transform.child_frame_id
            held[child.lstrip('/')] = parent.lstrip('/'), pose
        self._by_node[node] = held
        self._merge()

    def expect(self, nodes: set[str]) -> None:
        """Count on nodes from which nothing has come yet, though the master knows of them.

        Nobody counts as long as nothing is listened to.
        """
        if self._watching:
            for node in nodes:
                self._by_node.setdefault(node, {})
            self._merge()

    def keep(self, nodes: set[str]) -> None:
        """Forget what was published by any other node than these: it has gone."""
        gone = self._by_node.keys() - nodes
        if gone:
            for node in gone:
                del self._by_node[node]
            self._merge()

    def _merge(self) -> None:
        self.parents = {
            child: edge for held in self._by_node.values() for child, edge in held.items()
        }
        self.nodes = frozenset(self._by_node)
        for listener in self.listeners:
            listener()


def from_root(edge: FrameTransform, parents: Parents) -> FrameTransform:
    """Return the edge that moves the whole tree in which others hold the child of `edge` still.

    It is `edge` itself where nobody does, or where they hold it in its parent already.
    """
    parent, root, pose = edge
    if root not in parents:
        return edge
    seen = {root}
    while root in parents:
        root, held = parents[root]
        if root == parent or root in seen:
            return edge
        seen.add(root)
        pose = compose(pose, inverse(held))
    return FrameTransform(parent, root, pose)
