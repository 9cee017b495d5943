"""Follows trajectories of joints, within tolerances.

Parameters, defaults, timing and errors are those of joint_trajectory_controller 0.22.
"""

import logging
from collections.abc import Iterable, Iterator, Mapping, Sequence

from ..core import NANOSECONDS, reporting_to
from ..description import CONTINUOUS
from ..runtime import Output
from .angles import shortest
from .controller import RUNNING, Controller, RateGate, require_finite
from .errors import ControllerError, InterfaceError, ResourceError
from .goal import ABORTED, CANCELED, REJECTED, SUCCEEDED, Goal
from .hardware import EFFORT, POSITION, VELOCITY, JointHandle
from .registry import register_controller
from .trajectory import (
    MOST,
    JointPoint,
    SplineSegment,
    Tolerance,
    Tolerances,
    Trajectory,
    TrajectoryGoal,
    TrajectoryPoint,
    TrajectoryState,
    active,
    check_points,
    coefficients,
)
from .trajectory_splicing import points_to_come, rest_of, spliced

SUCCESSFUL, INVALID_GOAL, INVALID_JOINTS, PATH_TOLERANCE_VIOLATED, GOAL_TOLERANCE_VIOLATED = (
    0,
    -1,
    -2,
    -4,
    -5,
)


class FollowedGoal(Goal):
    """A trajectory that is followed, or was.

    Attributes:
        error_code: as in control_msgs/FollowJointTrajectory; 0 without an error.
        feedback: output of states while it is active.
    """

    def __init__(self, goal: TrajectoryGoal) -> None:
        super().__init__()
        self.goal = goal
        self.error_code, self.error_string = SUCCESSFUL, ''
        self.feedback: Output[TrajectoryState] = Output(lambda: None)

    def finish(self, status: str, code: int = SUCCESSFUL, text: str = '') -> None:
        """End it."""
        self.error_code, self.error_string = code, text
        self.end(status)


# The simulated hardware has no joints of the first two, as in Gazebo.
@register_controller(
    'pos_vel_controllers/JointTrajectoryController', 'hardware_interface::PosVelJointInterface'
)
@register_controller(
    'pos_vel_acc_controllers/JointTrajectoryController',
    'hardware_interface::PosVelAccJointInterface',
)
@register_controller('effort_controllers/JointTrajectoryController', EFFORT)
@register_controller('position_controllers/JointTrajectoryController', POSITION)
@register_controller('velocity_controllers/JointTrajectoryController', VELOCITY)
class JointTrajectoryController(Controller):
    """Move joints along splines; the newest trajectory replaces the rest of the one before.

    Output: state. A position is set; an effort or a velocity is that of a PID for each joint
    (gains/<joint>), and velocity_ff/<joint> times the desired velocity.
    """

    topic_names: Mapping[str, str] = {
        'play': 'command',
        'state': 'state',
        'follow': 'follow_joint_trajectory',
    }

    def load(self) -> None:
        """Read the parameters and find the joints."""
        if self.interface not in (EFFORT, POSITION, VELOCITY):
            raise InterfaceError(self.interface)
        read = self.params.read
        self._state_gate = RateGate(read('state_publish_rate', 50.0))
        self._feedback_gate = RateGate(read('action_monitor_rate', 20.0))
        self._stop_duration = min(read('stop_trajectory_duration', 0.0), MOST)
        self._allows_partial = read('allow_partial_joints_goal', False)
        names = self.params.strings('joints')
        if not names:
            raise ControllerError(
                f"Could not find 'joints' parameter (namespace: {self.params.namespace})."
            )
        self.joint_names = tuple(names)
        for name in names:
            if name not in self.robot.control.joints:
                raise ControllerError(f"Could not find joint '{name}' in URDF model.")
        self.joints = tuple(self._find(name) for name in names)
        self._wraps = tuple(one.described.type == CONTINUOUS for one in self.joints)
        self._tolerances = self._read_tolerances()
        self._pids = (
            [] if self.interface == POSITION else [self.pid(f'gains/{name}') for name in names]
        )
        self._feedforward = [read(f'velocity_ff/{name}', 0.0) for name in names]
        self.state_output: Output[TrajectoryState] = self.output('state')
        self._active: FollowedGoal | None = None
        self._reached: set[int] = set()
        self._origin_ns = self._now_ns = self._next_ns = 0
        self._segments: list[list[SplineSegment]] = [[] for _ in names]
        self._desired: list[tuple[float, float, float]] = []
        self._times = (0.0, 0.0)  # from start: desired, actual

    def _find(self, name: str) -> JointHandle:
        try:
            return self.joint(name)
        except ResourceError:
            raise ControllerError(f"Could not find joint '{name}' in '{self.interface}'.") from None

    def _read_tolerances(self) -> tuple[Tolerances, ...]:
        read = self.params.read
        stopped, late = (
            read(f'constraints/{key}', default)
            for key, default in (('stopped_velocity_tolerance', 0.01), ('goal_time', 0.0))
        )
        return tuple(
            Tolerances(
                Tolerance(read(f'constraints/{name}/trajectory', 0.0)),
                Tolerance(read(f'constraints/{name}/goal', 0.0), stopped),
                late,
            )
            for name in self.joint_names
        )

    def starting(self, now_ns: int) -> None:
        """Hold the position."""
        self._origin_ns = self._now_ns = self._next_ns = now_ns
        self._desired = [(one.position, one.velocity, 0.0) for one in self.joints]
        self._hold(None)
        self._state_gate.restart(now_ns)
        self._feedback_gate.restart(now_ns)
        for pid in self._pids:
            pid.reset()
        for joint in self.joints:
            joint.command = joint.position if self.interface == POSITION else 0.0

    def stopping(self, now_ns: int) -> None:
        """Cancel the goal."""
        self._preempt()

    def time_reset(self, now_ns: int) -> None:
        """Hold the position: the times of its trajectory have gone."""
        self._preempt()
        self.starting(now_ns)

    def command(self, positions: Sequence[float], seconds: float = 1.0) -> None:
        """Move all joints to positions [rad or m] in a time [s], and end at rest there.

        Raises:
            ValueError: a number is not finite, or there is not one per joint.
            ControllerError: the controller does not run.
        """
        require_finite(positions)
        if len(positions) != len(self.joints):
            raise ValueError(
                f'Dimension of command ({len(positions)}) does not match number of '
                f'joints ({len(self.joints)})! Not executing!'
            )
        self.play(
            Trajectory(
                self.joint_names,
                [TrajectoryPoint(positions, (0.0,) * len(positions), time_from_start=seconds)],
            )
        )

    def play(self, trajectory: Trajectory) -> None:
        """Move along a trajectory, without a goal; one without points stops the joints.

        Raises:
            ControllerError: it cannot be followed, and the one before goes on.
        """
        self.require_running()
        self._replace(trajectory, None, self._tolerances)
        self._preempt()

    def follow(self, goal: TrajectoryGoal) -> FollowedGoal:
        """Follow a goal; the one before is canceled. A goal that is not accepted is rejected."""
        followed = FollowedGoal(goal)
        names = goal.trajectory.joint_names
        is_complete = self._allows_partial or len(names) == len(self.joint_names)
        if self.state != RUNNING:
            what = "Can't accept new action goals. Controller is not running."
            self.world.faults.report(what, logging.ERROR, **self.place)
            followed.finish(REJECTED, INVALID_GOAL)
        elif not is_complete or not names or not set(names) <= set(self.joint_names):
            what = "Joints on incoming goal don't match the controller joints."
            self.world.faults.report(what, logging.ERROR, **self.place)
            followed.finish(REJECTED, INVALID_JOINTS)
        else:
            self._accept(followed)
        return followed

    def _accept(self, followed: FollowedGoal) -> None:
        goal = followed.goal
        late = goal.goal_time_tolerance
        tolerances = tuple(
            Tolerances(
                own.path.replaced_by(goal.path_tolerances.get(name, Tolerance())),
                own.goal.replaced_by(goal.goal_tolerances.get(name, Tolerance())),
                max(0.0, late) if late else own.goal_time,
            )
            for name, own in zip(self.joint_names, self._tolerances, strict=True)
        )
        try:
            self._replace(goal.trajectory, followed, tolerances)
        except ControllerError as error:
            followed.finish(REJECTED, INVALID_GOAL, error.sentences[0])
            return
        self._preempt()
        self._active = followed
        self._reached.clear()
        self._feedback_gate.restart(self._now_ns)

    def cancel(self, followed: FollowedGoal) -> None:
        """Stop the joints, if they follow this goal."""
        if self._active is followed:
            self._active = None
            self._hold(None)
            followed.finish(CANCELED)

    def query(self, time_ns: int) -> TrajectoryPoint:
        """Return the desired state at a time [ns] of the current trajectory.

        Raises:
            ControllerError: the controller does not run, or the trajectory begins later.
        """
        if self.state != RUNNING:
            raise ControllerError("Can't sample trajectory. Controller is not running.")
        time = self._uptime(time_ns)
        states = []
        for segments in self._segments:
            index = active(segments, time)
            if index < 0:
                raise ControllerError('Requested sample time precedes trajectory start time.')
            states.append(segments[index].sample(time))
        positions, velocities, accelerations = zip(*states, strict=True)
        return TrajectoryPoint(positions, velocities, accelerations)

    def update(self, now_ns: int, period: float) -> None:
        """Sample the trajectory, check tolerances, and command the joints."""
        self._now_ns = now_ns
        self._next_ns = now_ns + round(period * NANOSECONDS)
        time = self._uptime(now_ns)
        current = [segments[max(0, active(segments, time))] for segments in self._segments]
        self._desired = [segment.sample(time) for segment in current]
        errors = [
            (shortest(joint.position, position), velocity - joint.velocity)
            for joint, (position, velocity, _) in zip(self.joints, self._desired, strict=True)
        ]
        first = current[0]
        self._times = (first.time_from_start, time - first.start + first.time_from_start)
        if self._active is not None:
            self._check(time, current, errors)
        if self._pids:
            for i, (joint, pid) in enumerate(zip(self.joints, self._pids, strict=True)):
                joint.command = self._desired[i][1] * self._feedforward[i] + pid.update(
                    errors[i][0], period, errors[i][1]
                )
        else:
            for joint, (position, _, _) in zip(self.joints, self._desired, strict=True):
                joint.command = position
        if self._state_gate.opens(now_ns) and self.is_read:
            self.state_output.send(self.read_state())
        goal = self._active
        if goal is not None and self._feedback_gate.opens(now_ns) and goal.feedback.wanted:
            goal.feedback.send(self.read_state())

    def read_state(self) -> TrajectoryState:
        """Return the state as of the last update."""
        positions, velocities, accelerations = zip(*self._desired, strict=True)
        actual = [(joint.position, joint.velocity) for joint in self.joints]
        desired_time, actual_time = self._times
        return TrajectoryState(
            self.joint_names,
            TrajectoryPoint(positions, velocities, accelerations, desired_time),
            TrajectoryPoint([p for p, _ in actual], [v for _, v in actual], (), actual_time),
            TrajectoryPoint(
                [shortest(p, wanted) for (p, _), wanted in zip(actual, positions, strict=True)],
                [wanted - v for (_, v), wanted in zip(actual, velocities, strict=True)],
                (),
                desired_time - actual_time,
            ),
        )

    def _check(
        self, time: float, current: Sequence[SplineSegment], errors: Sequence[tuple[float, float]]
    ) -> None:
        """Abort the active goal if a tolerance is violated; succeed if all joints have ended."""
        for i, (segment, (position, velocity)) in enumerate(zip(current, errors, strict=True)):
            goal = self._active
            if goal is None or segment.goal is not goal:
                continue
            if time < segment.end:
                if not segment.tolerances.path.permits(position, velocity):
                    self._abort(i, 'path', PATH_TOLERANCE_VIOLATED, position)
            elif segment is self._segments[i][-1]:
                if segment.tolerances.goal.permits(position, velocity):
                    self._reached.add(i)
                elif time >= segment.end + segment.tolerances.goal_time:
                    self._abort(i, 'goal', GOAL_TOLERANCE_VIOLATED, position)
        goal = self._active
        if goal is not None and len(self._reached) == len(self.joints):
            self._active = None
            self._reached.clear()
            goal.finish(SUCCEEDED)

    def _abort(self, joint: int, what: str, code: int, error: float) -> None:
        goal, self._active = self._active, None
        self._reached.clear()
        assert goal is not None
        goal.finish(ABORTED, code, f'{self.joint_names[joint]} {what} error {error:.6f}')

    def _preempt(self) -> None:
        """Cancel the active goal; the joints move on."""
        goal, self._active = self._active, None
        self._reached.clear()
        if goal is not None:
            goal.finish(CANCELED)

    def _uptime(self, time_ns: int) -> float:
        """Return a simulated time in seconds since the controller was started."""
        return (time_ns - self._origin_ns) / NANOSECONDS

    def _hold(self, goal: FollowedGoal | None) -> None:
        """Replace the trajectory by one that comes to rest."""
        start, stop = self._uptime(self._now_ns), self._stop_duration
        for i, joint in enumerate(self.joints):
            if stop <= 0.0:
                rest = JointPoint(joint.position, 0.0, 0.0)
                self._segments[i] = [
                    SplineSegment(start, start, coefficients(rest, rest, 0.0), 0.0, goal)
                ]
                continue
            position, velocity, _ = self._desired[i]
            here = JointPoint(position, velocity, 0.0)
            there = JointPoint(position, -velocity, 0.0)
            # Half way of the motion to and fro the joint is at rest.
            end = JointPoint(
                *SplineSegment(0.0, 2.0 * stop, coefficients(here, there, 2.0 * stop)).sample(stop)
            )
            self._segments[i] = [
                SplineSegment(start, start + stop, coefficients(here, end, stop), 0.0, goal)
            ]

    def _replace(
        self, trajectory: Trajectory, goal: FollowedGoal | None, tolerances: Sequence[Tolerances]
    ) -> None:
        """Follow a trajectory after the rest of the current one.

        Raises:
            ControllerError: it cannot be followed.
        """
        if not trajectory.points:
            self._hold(goal)
            return
        names = trajectory.joint_names
        is_complete = self._allows_partial or len(names) == len(self.joint_names)
        if not is_complete or not set(names) <= set(self.joint_names):
            raise ControllerError(
                'Cannot create trajectory from message. It does not contain the expected joints.'
            )
        try:
            check_points(trajectory)
        except ValueError as error:
            raise ControllerError(str(error)) from None
        now = self._uptime(self._next_ns)
        start = self._uptime(trajectory.start_ns) if trajectory.start_ns else now
        with reporting_to(self.world.faults.add, **self.place):
            points = points_to_come(trajectory, start, now)
        own = tolerances if goal is not None else (Tolerances(),) * len(self.joints)
        replaced = [rest_of(segments, now, goal) for segments in self._segments]
        for index, name in enumerate(names):
            joint = self.joint_names.index(name)
            replaced[joint] = spliced(
                replaced[joint], points, index, self._wraps[joint], start, now, goal, own[joint]
            )
        self._segments = replaced

    def _goals(self) -> Iterator[FollowedGoal]:
        """Yield the goals that its state refers to, each once."""
        goals = {
            id(one): one
            for segments in self._segments
            for segment in segments
            if (one := segment.goal) is not None
        }
        if self._active is not None:
            goals[id(self._active)] = self._active
        yield from goals.values()

    def parts(self) -> Iterable[object]:
        """Return its goals."""
        return tuple(self._goals())

    def shared(self) -> Iterable[object]:
        """Also return the outputs and descriptions of its goals."""
        yield from super().shared()
        for goal in self._goals():
            yield from (goal.goal, goal.feedback, goal.done)
