"""Where the frames of sensors are on the robot, by TF.

Subscribes:
    /tf, /tf_static: while a frame is looked for.
"""

from collections.abc import Collection

import rospy
import tf2_ros
import yaml

from ...sim.core import IDENTITY, Pose
from ..messages import read_transform


class FrameFinder:
    """Finds the link that a frame is fixed to; the simulator merges links on fixed joints."""

    def __init__(self) -> None:
        self._buffer = tf2_ros.Buffer(debug=False)
        self._listener: tf2_ros.TransformListener | None = None
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
                self._listener = self._listener or tf2_ros.TransformListener(self._buffer)
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
        self._buffer = tf2_ros.Buffer(debug=False)

    def _rest(self) -> None:
        if self._listener is not None:
            self._listener.unregister()
            self._listener = None

    def _look(self, frame: str, links: Collection[str]) -> tuple[str, Pose] | None:
        # Up to 15 times a second, and of all robots: the parser in C takes a sixth of the time.
        parents = yaml.load(self._buffer.all_frames_as_yaml(), yaml.CSafeLoader) or {}
        above, seen = frame.lstrip('/'), set[str]()
        while above not in seen:
            link = next((name for name in (above, above.rpartition('/')[2]) if name in links), None)
            if link is not None:
                pose = self._pose(above, frame.lstrip('/'))
                return None if pose is None else (link, pose)
            seen.add(above)
            above = parents.get(above, {}).get('parent', above)
        return None

    def _pose(self, above: str, frame: str) -> Pose | None:
        """Return the pose of a frame in one above it; None if TF does not connect them now."""
        if above == frame:
            return IDENTITY
        try:
            newest = self._buffer.lookup_transform(above, frame, rospy.Time(0))
            return read_transform(newest.transform)
        except (tf2_ros.TransformException, ValueError):
            return None
