"""The scene, while somebody looks.

Subscribes:
    gazebo/view/scene, gazebo/view/motion: between `open` and `close`.
"""

from collections.abc import Callable

import rospy
from std_msgs.msg import Float64MultiArray, String

from ...sim.description import SceneChange, ShownMotion
from ..messages import read_motion, scene_change


class RosView:
    """The scene of the simulator `gazebo` of this node's namespace."""

    def __init__(self) -> None:
        self._subscribers: list[rospy.Subscriber] = []

    def open(self, change: Callable[[SceneChange], None],
             motion: Callable[[ShownMotion], None]) -> None:
        """Subscribe; the callbacks are called from threads of their own."""
        self._subscribers = [
            rospy.Subscriber('gazebo/view/scene', String, lambda m: change(scene_change(m))),
            # Each message: it alone has the poses of links that have come to rest since.
            rospy.Subscriber('gazebo/view/motion', Float64MultiArray,
                             lambda m: motion(read_motion(m)), tcp_nodelay=True)]

    def close(self) -> None:
        """Unsubscribe: the simulator computes nothing for this view any more."""
        for subscriber in self._subscribers:
            subscriber.unregister()
        self._subscribers = []
