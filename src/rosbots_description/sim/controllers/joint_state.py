"""The states of joints, at a rate."""

import logging
from collections.abc import Mapping

from ..core import Fault, report
from ..runtime import JointStates, Output
from .controller import Controller, RateGate
from .errors import ControllerError
from .hardware import STATE
from .registry import register_controller


@register_controller('joint_state_controller/JointStateController', STATE)
class JointStateController(Controller):
    """Report positions, velocities and efforts of all joints, or of `joints`. Output: joint_states.

    Parameters: publish_rate [Hz]; joints; extra_joints, a list of name, position, velocity and
    effort, which never change.
    """

    in_root_namespace = True
    topic_names: Mapping[str, str] = {'joint_states': 'joint_states'}

    def load(self) -> None:
        """Read the parameters and find the joints."""
        names = self.params.strings('joints')
        rate = self.params.number('publish_rate')
        if rate is None:
            raise ControllerError("Parameter 'publish_rate' not set")
        self._handles = [
            self.robot.handle(self.interface, name)
            for name in (self.robot.joints if names is None else names)
        ]
        self._gate = RateGate(rate)
        self._names = [handle.name for handle in self._handles]
        self._extra: list[tuple[float, float, float]] = []
        self._add_extra_joints()
        self.joint_states: Output[JointStates] = self.output('joint_states')

    def starting(self, now_ns: int) -> None:
        """Start the rate, in the first start only."""
        self._gate.start(now_ns)

    def time_reset(self, now_ns: int) -> None:
        """Start the rate again."""
        self._gate.restart(now_ns)

    def update(self, now_ns: int, period: float) -> None:
        """Send the states when they are due."""
        if self._gate.opens(now_ns) and self.is_read:
            self.joint_states.send(self.read_states())

    def read_states(self) -> JointStates:
        """Return the states as of the last update of the hardware."""
        rows = [(one.position, one.velocity, one.effort) for one in self._handles]
        rows += self._extra
        positions, velocities, efforts = zip(*rows, strict=True) if rows else ((), (), ())
        return JointStates(tuple(self._names), positions, velocities, efforts)

    def _ignore(self, what: str) -> None:
        report(Fault(f'{what}. Ignoring.', logging.ERROR))

    def _add_extra_joints(self) -> None:
        given = self.params.find('extra_joints')
        if given is None:
            return
        if not isinstance(given, list | tuple):
            self._ignore('Extra joints specification is not an array')
            return
        for one in given:
            if not isinstance(one, Mapping):
                self._ignore('Extra joint specification is not a struct')
                continue
            name = one.get('name')
            if not isinstance(name, str):
                self._ignore('Extra joint does not specify name')
            elif name in self._names:
                what = 'Joint state interface already contains specified extra joint'
                report(Fault(f"{what} '{name}'."))
            else:
                self._add_extra_joint(name, one)

    def _add_extra_joint(self, name: str, given: Mapping[str, object]) -> None:
        values = []
        for key in ('position', 'velocity', 'effort'):
            value = given.get(key, 0.0)
            if not isinstance(value, float):
                self._ignore(f"Extra joint '{name}' does not specify a valid default {key}")
                return
            values.append(value)
        self._names.append(name)
        self._extra.append((values[0], values[1], values[2]))
