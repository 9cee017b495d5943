"""The simulated hardware of a robot: its joints behind ros_control's interfaces.

It acts as gazebo_ros_control's DefaultRobotHWSim: a joint with pid_gains is driven by a force
within its effort limit; without them a position is set, and a velocity is left to the motor.
"""

import logging
import math
from collections.abc import Iterable, Iterator, Mapping
from typing import TYPE_CHECKING

from ..core import Fault, NotFoundError, PluginError, report
from ..description import ControlledJoint, RobotControl, Transmission
from .angles import position_error
from .errors import ControllerError, ResourceError
from .limits import (
    EffortSaturation,
    EffortSoftLimits,
    Enforcement,
    JointLimits,
    PositionSaturation,
    PositionSoftLimits,
    VelocitySaturation,
    VelocitySoftLimits,
    read_limits,
)
from .mimic_plugin import MimicJointPlugin
from .parameters import ControllerParameters
from .pid import Pid

if TYPE_CHECKING:
    from ..runtime import Joint, Model

STATE = 'hardware_interface::JointStateInterface'
EFFORT = 'hardware_interface::EffortJointInterface'
POSITION = 'hardware_interface::PositionJointInterface'
VELOCITY = 'hardware_interface::VelocityJointInterface'
_PREFIX = 'hardware_interface/'
_MOST_EFFORT = 1e9  # [N m or N] of a motor without a limit


class JointHandle:
    """A joint as controllers see it: its state when they are updated, and their command.

    Attributes:
        interface: of its command, e.g. POSITION.
        described: as in the URDF; `limits` are in force.
        position, velocity: [rad or m], [rad/s or m/s].
        effort: the force applied last by a command of effort or by a PID [N m or N].
        command: in the unit of the interface.
    """

    interface = EFFORT
    laws: tuple[type, type] = EffortSaturation, EffortSoftLimits

    def __init__(self, joint: 'Joint', described: ControlledJoint, limits: JointLimits) -> None:
        self.joint = joint
        self.name = joint.name
        self.described = described
        self.limits = limits
        saturation, soft = self.laws
        self._law: Enforcement = soft(limits) if limits.soft else saturation(limits)
        self.position = self.velocity = self.effort = self.command = 0.0

    def read(self) -> None:
        """Read the state of the joint."""
        self.position, self.velocity = self.joint.state()

    def hold(self) -> None:
        """Begin an emergency stop."""

    def enforce(self, period: float) -> None:
        """Keep the command within the limits, `period` [s] after the last call."""
        if math.isnan(self.command):  # of a law that overflowed, or of a diverged model
            self.command = self.position if self.interface == POSITION else 0.0
        self.command = self._law.enforce(self.command, self.position, self.velocity, period)

    def write(self, period: float, stopped: bool) -> None:
        """Apply the command for one step; `stopped`: in an emergency stop."""
        self._push(0.0 if stopped else self.command)

    @property
    def is_idle(self) -> bool:
        """Whether `write` has no effect."""
        return self.interface == EFFORT and self.command == 0.0

    def _push(self, effort: float) -> None:
        self.effort = effort = 0.0 if math.isnan(effort) else effort
        if effort:
            self.joint.apply_effort(effort)


class PositionHandle(JointHandle):
    """A joint that is set to its position command in each step."""

    interface = POSITION
    laws = PositionSaturation, PositionSoftLimits

    def hold(self) -> None:
        """Hold the current position while it is stopped."""
        self._held = self.position

    def write(self, period: float, stopped: bool) -> None:
        """Set the joint, at rest, as Gazebo does."""
        self.joint.set_position(self._held if stopped else self.command)


class PositionPidHandle(PositionHandle):
    """A joint that a force drives to its position command."""

    pid: Pid

    def write(self, period: float, stopped: bool) -> None:
        """Apply the force."""
        wanted, limits = self._held if stopped else self.command, self.limits
        error = position_error(limits.kind, self.position, wanted, limits.lower, limits.upper)
        self._push(min(max(self.pid.update(error, period), -limits.effort), limits.effort))


class VelocityHandle(JointHandle):
    """A joint whose motor drives it at its velocity command, as the wheels of our drives."""

    interface = VELOCITY
    laws = VelocitySaturation, VelocitySoftLimits

    def write(self, period: float, stopped: bool) -> None:
        """Set the motor."""
        self.joint.set_motor(
            0.0 if stopped else self.command, min(self.limits.effort, _MOST_EFFORT)
        )


class VelocityPidHandle(VelocityHandle):
    """A joint that a force drives at its velocity command."""

    pid: Pid

    def write(self, period: float, stopped: bool) -> None:
        """Apply the force."""
        most = self.limits.effort
        error = (0.0 if stopped else self.command) - self.velocity
        self._push(min(max(self.pid.update(error, period), -most), most))


class MimicJoint:
    """A joint that follows another one, driven by its motor within its effort limit.

    Its motor's speed is that of the leader, and what closes the gap of position within one step.
    """

    def __init__(self, joint: 'Joint', leader: 'Joint', described: ControlledJoint) -> None:
        assert described.mimic is not None
        self._joint, self._leader, self._mimic = joint, leader, described.mimic
        self._effort = min(described.effort or math.inf, _MOST_EFFORT)

    def follow(self, period: float) -> None:
        """Set the motor for a step of `period` [s]."""
        position, velocity = self._leader.state()
        factor, offset = self._mimic.multiplier, self._mimic.offset
        gap = factor * position + offset - self._joint.position
        self._joint.set_motor(factor * velocity + gap / period, self._effort)


_HANDLES: Mapping[str, tuple[type[JointHandle], type[JointHandle]]] = {
    'EffortJointInterface': (JointHandle, JointHandle),
    'PositionJointInterface': (PositionHandle, PositionPidHandle),
    'VelocityJointInterface': (VelocityHandle, VelocityPidHandle),
}


class SimulatedRobot:
    """The joints of a model that transmissions name, by name and in alphabetical order.

    `pids` are those of pid_gains, by their namespace below that of the robot.
    """

    def __init__(self, model: 'Model', control: RobotControl, params: ControllerParameters) -> None:
        """Build the hardware.

        Args:
            params: in the robot's namespace: `joint_limits`, `gazebo_ros_control/pid_gains`.
        Raises:
            PluginError: a joint or an interface does not exist.
        """
        self.model = model
        self.control = control
        self.pids: dict[str, Pid] = {}
        self._params = params
        for fault in control.faults:
            report(Fault(fault, logging.ERROR))
        handles = filter(None, map(self._handle_of, control.transmissions))
        self.joints = {handle.name: handle for handle in sorted(handles, key=lambda h: h.name)}
        self._handles = tuple(self.joints.values())
        self._mimics = tuple(self._find_mimics())
        self._stopped = False

    def handle(self, interface: str, name: str) -> JointHandle:
        """Return a joint.

        Raises:
            ResourceError: the interface does not have it.
        """
        found = self.joints.get(name)
        if found is None or interface not in (STATE, found.interface):
            raise ResourceError(f"Could not find resource '{name}' in '{interface}'.")
        return found

    def described(self, name: str) -> ControlledJoint:
        """Return a joint of the URDF.

        Raises:
            ControllerError: there is none.
        """
        found = self.control.joints.get(name)
        if found is None:
            raise ControllerError(f"Could not find joint '{name}' in urdf")
        return found

    def read(self) -> None:
        """Read the state of all joints."""
        for handle in self._handles:
            handle.read()

    def write(self, period: float, step: float, stopped: bool) -> None:
        """Apply all commands.

        Args:
            period: since the last call [s].
            step: duration of the step [s].
            stopped: in an emergency stop.
        """
        if stopped and not self._stopped:
            for handle in self._handles:
                handle.hold()
        self._stopped = stopped
        for handle in self._handles:
            handle.enforce(period)
            handle.write(period, stopped)
        for mimic in self._mimics:
            mimic.follow(step)

    @property
    def is_idle(self) -> bool:
        """Whether `write` has no effect while no controller runs."""
        return not self._mimics and all(handle.is_idle for handle in self._handles)

    def parts(self) -> Iterable[object]:
        """Return the objects that controllers refer to."""
        return (self, *self._handles, *self.pids.values())

    def _handle_of(self, transmission: Transmission) -> JointHandle | None:
        """Return the joint of a transmission; None, with a warning, if it cannot be simulated."""
        name = transmission.name
        if len(transmission.joints) > 1:
            what = (
                f'Transmission {name} has more than one joint. Currently the default robot '
                f'hardware simulation  interface only supports one. {transmission.type} is not '
                f'simulated: its joints ({", ".join(transmission.joints)}) are not controlled'
            )
            report(Fault(what))
            return None
        ((joint_name, interfaces),) = transmission.joints.items()
        if len(interfaces) > 1:
            what = (
                f'Joint {joint_name} of transmission {name} specifies multiple hardware '
                'interfaces. Currently the default robot hardware simulation interface only '
                'supports one. Using the first entry'
            )
            report(Fault(what))
        written = interfaces[0]
        classes = _HANDLES.get(written.removeprefix(_PREFIX))
        if classes is None:
            raise PluginError(
                f"No matching hardware interface found for '{written}' while loading "
                f'interfaces for {joint_name}'
            )
        if not written.startswith(_PREFIX):
            what = (
                f"Deprecated syntax, please prepend 'hardware_interface/' to '{written}' within "
                f"the <hardwareInterface> tag in joint '{joint_name}'."
            )
            report(Fault(what))
        try:
            joint = self.model.joint(joint_name)
        except NotFoundError:
            raise PluginError(
                f'This robot has a joint named "{joint_name}" which is not in the gazebo model.'
            ) from None
        return self._make(joint, *classes)

    def _make(
        self, joint: 'Joint', plain: type[JointHandle], forced: type[JointHandle]
    ) -> JointHandle:
        described = self.control.joints.get(joint.name)
        limits = read_limits(described, self._params.section(f'joint_limits/{joint.name}'))
        described = described or ControlledJoint(limits.kind)
        if plain is forced:
            return plain(joint, described, limits)
        path = f'gazebo_ros_control/pid_gains/{joint.name}'
        try:
            pid = Pid.from_parameters(self._params.section(path))
        except ControllerError as error:
            report(Fault(str(error), logging.ERROR))
            return plain(joint, described, limits)
        handle = forced(joint, described, limits)
        handle.pid = self.pids[path] = pid  # type: ignore[attr-defined]
        return handle

    def _find_mimics(self) -> Iterator[MimicJoint]:
        """Yield the joints that follow others, and that nothing else moves."""
        joints = self.model.joints
        of_plugins = {
            plugin.follower
            for plugin in self.model.plugins.values()
            if isinstance(plugin, MimicJointPlugin)
        }
        for name, described in self.control.joints.items():
            is_free = name in joints and name not in self.joints and name not in of_plugins
            if described.mimic is not None and is_free:
                leader = joints.get(described.mimic.joint)
                if leader is None or leader is joints[name]:
                    why = 'is itself' if leader is not None else 'the model does not have'
                    what = f"joint '{name}' mimics '{described.mimic.joint}', which {why}"
                    report(Fault(f'{what}; it is passive', logging.ERROR))
                else:
                    yield MimicJoint(joints[name], leader, described)
