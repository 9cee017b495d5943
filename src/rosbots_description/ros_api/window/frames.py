"""Where the frames of sensors are on the robot, by TF.

Subscribes:
    /tf, /tf_static: while a frame is looked for.
"""

from collections.abc import Collection

import rospy
from geometry_msgs.msg import Transform
from tf2_msgs.msg import TFMessage

from ...sim.core import IDENTITY, Pose, compose
from ..messages import read_transform

TOPICS = '/tf', '/tf_static'


class FrameFinder:
    """Finds the link that a frame is fixed to; the simulator merges links on fixed joints.

    It keeps the newest transform of each frame, which is enough for frames that are fixed. tf2's
    buffer keeps those of the last ten seconds, and is never freed in Python (tf2_py has no
    destructor for it).
    """

    def __init__(self) -> None:
        self._parents: dict[str, tuple[str, Transform]] = {}  # and where a frame is in it
        self._subscribers: list[rospy.Subscriber] = []
        self._found: dict[str, tuple[str, Pose]] = {}
        self._missing: set[str] = set()

    def locate(self, frame: str, links: Collection[str]) -> tuple[str, Pose] | None:
        """Return the nearest link above a frame, and the frame's pose in it; None if unknown.

        Args:
            links: names of links; a frame with a prefix is also looked for without it.
        """
        found = self._found.get(frame)
        if found is None or found[0] not in links:
            found = self._look(frame, links)
            if found is None:
                self._missing.add(frame)
                self._listen()
                return None
            self._found[frame] = found
        self._missing.discard(frame)
        if not self._missing:
            self._rest()
        return found

    def forget(self) -> None:
        """Listen no more, and look again for every frame."""
        self._rest()
        self._missing.clear()
        self._found.clear()
        self._parents = {}  # a message that is still being read goes to the old ones

    def _listen(self) -> None:
        if not self._subscribers:
            self._subscribers = [rospy.Subscriber(topic, TFMessage, self._hear, self._parents)
                                 for topic in TOPICS]

    def _rest(self) -> None:
        for subscriber in self._subscribers:
            subscriber.unregister()
        self._subscribers = []

    @staticmethod
    def _hear(message: TFMessage, parents: dict[str, tuple[str, Transform]]) -> None:
        for one in message.transforms:
            parents[one.child_frame_id.lstrip('/')] = (
                one.header.frame_id.lstrip('/'), one.transform)

    def _look(self, frame: str, links: Collection[str]) -> tuple[str, Pose] | None:
        above, pose, seen = frame.lstrip('/'), IDENTITY, set[str]()
        while above not in seen:
            link = next((name for name in (above, above.rpartition('/')[2]) if name in links), None)
            if link is not None:
                return link, pose
            seen.add(above)
            if above in self._parents:
                above, transform = self._parents[above]
                try:
                    pose = compose(read_transform(transform), pose)
                except ValueError:  # it is no pose
                    return None
        return None
