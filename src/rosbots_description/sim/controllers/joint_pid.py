"""Controllers that drive joints to positions or velocities by PIDs."""

from collections.abc import Iterable, Mapping
from typing import NamedTuple

from ..runtime import Output
from .angles import position_error
from .controller import Controller, require_finite
from .errors import ControllerError
from .hardware import EFFORT, VELOCITY, JointHandle
from .joint_command import checked_group, find_group, required_joint
from .pid import Gains, Pid
from .registry import register_controller

_REPORT_PERIOD = 10  # updates between two states, as upstream


class JointPidState(NamedTuple):
    """State of a PID on a joint, in the units of position or velocity, and of the command.

    Attributes:
        process_value_dot: velocity of the joint; 0 for a velocity controller, as upstream.
        time_step: period of the update [s].
    """

    set_point: float
    process_value: float
    process_value_dot: float
    error: float
    time_step: float
    command: float
    gains: Gains


class ReportingPid(Controller):
    """A PID on one joint. Output: state, in every tenth update.

    Parameters: joint, pid. Its `command` holds until the next one.
    """

    topic_names: Mapping[str, str] = {'command': 'command', 'state': 'state'}

    def load(self) -> None:
        """Read the parameters and find the joint."""
        name = required_joint(self)
        self._pid = self.pid('pid')
        self.handle = self.joint(name)
        self._updates = 0
        self._wanted = 0.0
        self.state_output: Output[JointPidState] = self.output('state')

    def command(self, value: float) -> None:
        """Set the command [rad or m], or [rad/s or m/s].

        Raises:
            ValueError: it is not finite.
        """
        require_finite((value,))
        self._wanted = float(value)

    def _drive(
        self, wanted: float, actual: float, rate: float, error: float, period: float
    ) -> None:
        command = self.handle.command = self._pid.update(error, period)
        if self.is_read and self._updates % _REPORT_PERIOD == 0:
            self.state_output.send(
                JointPidState(wanted, actual, rate, error, period, command, self._pid.gains)
            )
        self._updates += 1


@register_controller('effort_controllers/JointPositionController', EFFORT)
@register_controller('velocity_controllers/JointPositionController', VELOCITY)
class JointPositionController(ReportingPid):
    """Drive a joint to a position; it starts where the joint is."""

    def load(self) -> None:
        """Also find the joint in the URDF."""
        super().load()
        self.robot.described(self.handle.name)

    def starting(self, now_ns: int) -> None:
        """Hold the position."""
        self._wanted = self.handle.position
        self._pid.reset()

    def update(self, now_ns: int, period: float) -> None:
        """Set the effort or velocity."""
        wanted = within_limits(self.handle, self._wanted)
        self._drive(
            wanted,
            self.handle.position,
            self.handle.velocity,
            error_of(self.handle, wanted),
            period,
        )


@register_controller('effort_controllers/JointVelocityController', EFFORT)
class JointVelocityController(ReportingPid):
    """Drive a joint at a velocity; it starts with 0."""

    def starting(self, now_ns: int) -> None:
        """Command no velocity."""
        self._wanted = 0.0
        self._pid.reset()

    def update(self, now_ns: int, period: float) -> None:
        """Set the effort."""
        velocity = self.handle.velocity
        self._drive(self._wanted, velocity, 0.0, self._wanted - velocity, period)


@register_controller('effort_controllers/JointGroupPositionController', EFFORT)
class JointGroupPositionController(Controller):
    """Drive several joints to positions. Parameters: joints, <joint>/pid."""

    topic_names: Mapping[str, str] = {'command': 'command'}

    def load(self) -> None:
        """Find the joints and their gains."""
        self.joints = find_group(self)
        self._pids: list[Pid] = []
        for joint in self.joints:
            self.robot.described(joint.name)
            path = f'{joint.name}/pid'
            try:
                self._pids.append(self.pid(path))
            except ControllerError as error:
                raise ControllerError(
                    *error.sentences, f'Failed to load PID parameters from {path}'
                ) from None

    def starting(self, now_ns: int) -> None:
        """Hold the positions."""
        self._commands = tuple(joint.position for joint in self.joints)
        for pid in self._pids:
            pid.reset()

    def command(self, values: Iterable[float]) -> None:
        """Set the positions [rad or m] of all joints, in the order of `joints`.

        Raises:
            ValueError: a number is not finite, or there is not one per joint.
        """
        self._commands = checked_group(values, len(self.joints))

    def update(self, now_ns: int, period: float) -> None:
        """Set the efforts."""
        for joint, pid, command in zip(self.joints, self._pids, self._commands, strict=True):
            joint.command = pid.update(error_of(joint, within_limits(joint, command)), period)


def within_limits(joint: JointHandle, position: float) -> float:
    """Return the closest position within the limits of the URDF."""
    return min(max(position, joint.described.lower), joint.described.upper)


def error_of(joint: JointHandle, wanted: float) -> float:
    """Return the way to a position."""
    described = joint.described
    return position_error(described.type, joint.position, wanted, described.lower, described.upper)
