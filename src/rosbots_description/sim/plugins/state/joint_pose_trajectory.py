"""Set joint positions along a trajectory, point by point, while physics is disabled.

Tags and behaviour are those of libgazebo_ros_joint_pose_trajectory.so in gazebo_ros_pkgs 2.9.2: a
point holds for its own `time_from_start`; physics of the whole world is disabled from the arrival
of a trajectory to the end of its last point; joints keep their velocities. Physics is enabled when
a trajectory ends or its model is deleted; Gazebo's stays disabled if another one replaces it.
"""

import logging
import math
from collections.abc import Sequence

from ...core import Pose, compose, inverse
from ...plugin_registry import register
from ...runtime import NEVER, WORLD_FRAMES, Joint, Link, Model
from ..base import ModelPlugin

Point = tuple[Sequence[float], int]  # positions [rad or m], and how long they hold [ns]


@register('libgazebo_ros_joint_pose_trajectory.so')
class JointPoseTrajectory(ModelPlugin):
    """Play trajectories of joint positions."""

    prefix = 'joint_pose_trajectory: '
    missing_level = logging.DEBUG

    def load(self) -> None:
        """Read the tags."""
        self.params.read('topicName', 'set_joint_trajectory')
        self.params.ignore('serviceName', 'updateRate')
        self._points: list[Point] = []

    def play(
        self, frame: str, start_ns: int, joints: Sequence[str], points: Sequence[Point]
    ) -> None:
        """Play a trajectory; it replaces any other.

        Unknown joints are reported, and the others move.

        Args:
            frame: the link to keep in place; it may be of another model, which then moves. A name
                of the world: the model keeps its pose.
            start_ns: start time [ns, simulated]; a past time means now.
        Raises:
            ValueError: a position is not finite.
        """
        if not all(math.isfinite(position) for point, _ in points for position in point):
            raise ValueError('a trajectory takes finite positions')
        in_world = frame in WORLD_FRAMES[1:]
        link = None if in_world else self.world.find_entity(frame)
        if not (isinstance(link, Link) or in_world):
            what = f'ros_joint_trajectory plugin needs a reference link [{frame}] as frame_id'
            self.world.faults.report(f'{what}, aborting.', logging.ERROR, **self.place)
            return
        self._held: Link | Model = link if isinstance(link, Link) else self.model
        self._model: Model = link.model if isinstance(link, Link) else self.model
        self._joints: list[Joint | None] = [self._model.joints.get(name) for name in joints]
        unknown = [name for name, joint in zip(joints, self._joints, strict=True) if joint is None]
        if unknown:
            what = f"{self.log_prefix}model '{self._model.name}' has no joint {', '.join(unknown)}"
            what += f'; its joints: {", ".join(self._model.joints)}'
            self.world.faults.report(what, **self.place)
        now_ns = self.world.clock.now_ns
        if start_ns > now_ns:
            what = f'{self.log_prefix}a trajectory begins at {start_ns / 1e9:g} s'
            self.world.faults.report(f'{what}; until it has ended nothing moves', **self.place)
        self._points, self._next = list(points), 0
        self._start_ns = max(start_ns, now_ns)
        self.world.hold_physics(self)
        self._set_due()

    def before_step(self) -> None:
        """Set the joints to the next point; after the last one enable physics."""
        is_there = self.world.models.get(self._model.name) is self._model
        if self._next == len(self._points) or not is_there:
            self.restart()
            return
        positions, duration_ns = self._points[self._next]
        if len(positions) == len(self._joints):
            self._put(positions)
        else:
            what = (
                f'point[{self._next}] in JointTrajectory has different number of joint '
                f'names[{len(self._joints)}] and positions[{len(positions)}].'
            )
            self.world.faults.report(what, logging.ERROR, **self.place)
        self._next += 1
        self._start_ns += duration_ns
        self._set_due()

    def restart(self) -> None:
        """Drop the trajectory."""
        self._points, self.due = [], NEVER
        self.world.release_physics(self)

    unload = restart

    def _put(self, positions: Sequence[float]) -> None:
        before = self._held.pose
        for joint, position in zip(self._joints, positions, strict=True):
            if joint is not None:
                joint.set_position(position, joint.velocity)
        moved: Pose = compose(before, inverse(self._held.pose))
        self._model.set_pose(compose(moved, self._model.pose))

    def _set_due(self) -> None:
        clock = self.world.clock
        self.due = max(clock.steps + 1, clock.first_step_after(self._start_ns - 1))
