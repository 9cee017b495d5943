"""Where frames are beside the links of robots, by TF.

Subscribes:
    /tf, /tf_static: while a frame is looked for, and while one is that moves.
"""

from collections.abc import Collection, Iterator

import rospy
from geometry_msgs.msg import Transform
from tf2_msgs.msg import TFMessage

from ...sim.core import IDENTITY, Pose, compose, inverse
from ..messages import read_transform

TOPICS = '/tf', '/tf_static'


class FrameFinder:
    """Finds a link that TF connects a frame with.

    A frame below a link is fixed to it, as those of sensors are: the simulator merges links on
    fixed joints. One above it, such as odom and map, moves.

    It keeps the newest transform of each frame. tf2's buffer keeps those of the last ten seconds,
    and is never freed in Python (tf2_py has no destructor for it).
    """

    def __init__(self) -> None:
        self._parents: dict[str, tuple[str, Transform]] = {}  # and where a frame is in it
        self._subscribers: list[rospy.Subscriber] = []
        self._fixed: dict[str, tuple[str, Pose]] = {}
        self._followed: set[str] = set()  # frames that are missing, or move

    def locate(self, frame: str, links: Collection[str]) -> tuple[str, Pose] | None:
        """Return the nearest link above a frame, else below it, and the frame's pose in it.

        None if no link is connected with it.

        Args:
            links: names of links; a frame with a prefix is also looked for without it.
        """
        found = self._fixed.get(frame)
        if found is None or found[0] not in links:
            found = _above(self._ways(frame), links)
            if found is None:
                self._followed.add(frame)
                self._listen()
                return self._below(frame.lstrip('/'), links)
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
    def _hear(message: TFMessage, parents: dict[str, tuple[str, Transform]]) -> None:
        for one in message.transforms:
            parents[one.child_frame_id.lstrip('/')] = (
                one.header.frame_id.lstrip('/'),
                one.transform,
            )

    def _ways(self, frame: str) -> Iterator[tuple[str, Pose]]:
        """Yield a frame and those above it, the nearest first, with its pose in each."""
        above, pose, seen = frame.lstrip('/'), IDENTITY, set[str]()
        while above not in seen:
            yield above, pose
            seen.add(above)
            if above in self._parents:
                above, transform = self._parents[above]
                try:
                    pose = compose(read_transform(transform), pose)
                except ValueError:  # it is no pose
                    return

    def _below(self, frame: str, links: Collection[str]) -> tuple[str, Pose] | None:
        """Return the link with the shortest way up to a frame, and the frame's pose in it."""
        found: list[tuple[int, str, Pose]] = []
        for child in [name for name in list(self._parents) if _link(name, links)]:
            for steps, (above, pose) in enumerate(self._ways(child)):
                if above == frame:
                    found.append((steps, child, inverse(pose)))
        if not found:
            return None
        _, child, pose = min(found, key=lambda one: one[:2])
        link = _link(child, links)
        assert link is not None
        return link, pose


def _above(ways: Iterator[tuple[str, Pose]], links: Collection[str]) -> tuple[str, Pose] | None:
    return next(((link, pose) for above, pose in ways if (link := _link(above, links))), None)


def _link(frame: str, links: Collection[str]) -> str | None:
    """Return the link of a frame's name, with or without its prefix; None if there is none."""
    return next((name for name in (frame, frame.rpartition('/')[2]) if name in links), None)
