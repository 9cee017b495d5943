"""The scene, while a browser is connected.

Subscribes:
    gazebo/view/scene, gazebo/view/motion: between `open` and `close`.
"""

import threading
from collections.abc import Callable

import rospy
from std_msgs.msg import Float64MultiArray, String

from ...sim.description import SceneChange, ShownMotion
from ..messages import read_motion, scene_change

EARLY = 100  # motions that wait: the simulator queues as many changes


class RosView:
    """The scene of the simulator `gazebo` of this node's namespace."""

    def __init__(self) -> None:
        self._subscribers: list[rospy.Subscriber] = []

    def open(
        self, change: Callable[[SceneChange], None], motion: Callable[[ShownMotion], None]
    ) -> None:
        """Subscribe; the callbacks are called from threads of their own, in the order sent."""
        order = InOrder(change, motion)
        self._subscribers = [
            rospy.Subscriber('gazebo/view/scene', String, lambda m: order.change(scene_change(m))),
            # Each message: it alone has the poses of links that have come to rest since.
            rospy.Subscriber(
                'gazebo/view/motion',
                Float64MultiArray,
                lambda m: order.motion(read_motion(m)),
                tcp_nodelay=True,
            ),
        ]

    def close(self) -> None:
        """Unsubscribe: the simulator computes nothing for this view any more."""
        for subscriber in self._subscribers:
            subscriber.unregister()
        self._subscribers = []


class InOrder:
    """Passes a motion on after the change that brought its links.

    Each topic is read by a thread of its own, and a scene takes longer to read than a motion.
    Links are numbered in the order in which they come: a motion of a link with a higher number
    than those of the scene is early. It waits, and so do those after it. Changes of
    what others were shown may come before the first whole scene; they are left out.
    """

    def __init__(
        self, change: Callable[[SceneChange], None], motion: Callable[[ShownMotion], None]
    ) -> None:
        self._show_change, self._show_motion = change, motion
        self._lock = threading.Lock()
        self._is_begun = False  # whether a whole scene has come
        self._newest = -1  # number of a link of the scene
        self._early: list[ShownMotion] = []  # one for each change that is missing

    def change(self, change: SceneChange) -> None:
        """Pass on a change, then the motions that waited for it."""
        numbers = [link.number for model in change.models for link in model.links]
        with self._lock:
            self._is_begun |= change.reset
            if not self._is_begun:
                return
            self._newest = max(numbers, default=-1 if change.reset else self._newest)
            self._show_change(change)
            while self._early and _newest(self._early[0]) <= self._newest:
                self._show_motion(self._early.pop(0))

    def motion(self, motion: ShownMotion) -> None:
        """Pass on a motion, unless it is early or comes after one that is."""
        with self._lock:
            if not self._early and _newest(motion) <= self._newest:
                self._show_motion(motion)
            elif self._early and (
                len(self._early) == EARLY or _newest(motion) <= _newest(self._early[-1])
            ):
                self._early[-1] = motion.after(self._early[-1])
            else:
                self._early.append(motion)


def _newest(motion: ShownMotion) -> int:
    return max(motion.poses, default=-1)
