"""Where frames are beside the links of robots, by TF.

Subscribes:
    /tf, /tf_static: while a frame is looked for, and while one is that moves.
"""

from collections.abc import Collection

import rospy
from tf2_msgs.msg import TFMessage

from ...sim.core import Pose, inverse
from ..messages import frames_above, read_transforms

TOPICS = '/tf', '/tf_static'


class FrameFinder:
    """Finds a link that TF connects a frame with.

    A frame below a link is fixed to it, as those of sensors are: the simulator merges links on
    fixed joints. One above it, such as odom and map, moves.

    It keeps the newest transform of each frame. tf2's buffer keeps those of the last ten seconds,
    and is never freed in Python (tf2_py has no destructor for it).
    """

    def __init__(self) -> None:
        self._parents: dict[str, tuple[str, Pose]] = {}  # and the pose of a frame in it
        self._subscribers: list[rospy.Subscriber] = []
        self._fixed: dict[str, tuple[str, Pose]] = {}
        self._followed: set[str] = set()  # frames that are missing, or move

    def locate(self, frame: str, links: Collection[str]) -> tuple[str, Pose] | None:
        """Return the nearest link above a frame, else below it, and the frame's pose in it.

        None if no link is connected with it.

        Args:
            links: names of links; a frame with a prefix is also looked for without it.
        """
        frame = frame.lstrip('/')
        found = self._fixed.get(frame)
        if found is None or found[0] not in links:
            above = frames_above(frame, self._parents)
            found = next(
                ((link, pose) for name, pose in above if (link := _link(name, links))), None
            )
            if found is None:
                self._followed.add(frame)
                self._listen()
                return self._below(frame, links)
            self._fixed[frame] = found
        self._followed.discard(frame)
        if not self._followed:
            self._rest()
        return found

    def forget(self) -> None:
        """Listen no more, and look again for every frame."""
        self._rest()
        self._followed.clear()
        self._fixed.clear()
        self._parents = {}  # a message that is still being read goes to the old ones

    def _listen(self) -> None:
        if not self._subscribers:
            self._subscribers = [
                rospy.Subscriber(topic, TFMessage, self._hear, self._parents) for topic in TOPICS
            ]

    def _rest(self) -> None:
        for subscriber in self._subscribers:
            subscriber.unregister()
        self._subscribers = []

    @staticmethod
    def _hear(message: TFMessage, parents: dict[str, tuple[str, Pose]]) -> None:
        parents.update(read_transforms(message))

    def _below(self, frame: str, links: Collection[str]) -> tuple[str, Pose] | None:
        """Return the link with the shortest way up to a frame, and the frame's pose in it."""
        found: list[tuple[int, str, str, Pose]] = []
        for child in list(self._parents):
            if link := _link(child, links):
                for steps, (above, pose) in enumerate(frames_above(child, self._parents)):
                    if above == frame:
                        found.append((steps, child, link, inverse(pose)))
        return min(found, key=lambda one: one[:2])[2:] if found else None


def _link(frame: str, links: Collection[str]) -> str | None:
    """Return the link of a frame's name, with or without its prefix; None if there is none."""
    return next((name for name in (frame, frame.rpartition('/')[2]) if name in links), None)
