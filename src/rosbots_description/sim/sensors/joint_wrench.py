"""Force and torque in a joint: the plugin libgazebo_ros_ft_sensor.so of gazebo_ros_pkgs 2.9.2.

It publishes the wrench of the child on the parent, in the axes of the child and about the joint's
origin. Gazebo needs <provideFeedback>; here a joint is measured while the output has readers.
"""

from collections.abc import Mapping, Sequence
from typing import NamedTuple

from ..core import Vector
from ..plugin_registry import register
from ..plugins import PeriodicPlugin
from .base import LogsDefaults
from .noise import RandomSteps, gaussian, noisy


class JointWrench(NamedTuple):
    """The wrench of a joint's child on its parent, in the axes of the child."""

    force: Vector  # [N]
    torque: Vector  # about the origin of the joint [N m]


@register('libgazebo_ros_ft_sensor.so')
class JointWrenchPlugin(LogsDefaults, PeriodicPlugin):
    """Publishes the wrench in <jointName>. Output: `wrench`. `frame` is the child's name."""

    topic_names: Mapping[str, str] = {'wrench': '<topicName>'}
    prefix = 'ft_sensor plugin '
    strictly_after = False
    _measured: object = None  # the body whose joint the engine measures

    def load(self) -> None:
        """Read the tags; find the joint."""
        self._joint = self.joint(self.params.required('jointName'), 'measured')
        self.params.required('topicName')
        self.frame = self.params.values['frame'] = self._joint.spec.child
        self._noise = gaussian(self.params.read('gaussianNoise', 0.0), '<gaussianNoise>')
        self.set_rate(self.params.rate('updateRate', 0.0))
        self._random = RandomSteps(self.world, f'{self.model.name}::{self.spec.name}')
        self.wrench = self.output('wrench')

    def before_step(self) -> None:
        """Enable the measurement; the model's body may have been replaced."""
        if self._measured is not self.model.body:
            self._measured = self.model.body
            self.world.engine.measure_reaction(self.model.body, self._joint.name)
        super().before_step()

    def readers_changed(self) -> None:
        """Disable the measurement when there are no readers."""
        super().readers_changed()
        if self._measured is not None and not self.is_read:
            self.world.engine.measure_reaction(self.model.body, self._joint.name, wanted=False)
            self._measured = None

    def report(self) -> None:
        """Send the wrench."""
        force, torque = self.world.engine.joint_reaction(self.model.body, self._joint.name)
        numbers: Sequence[float] = [-number for number in (*force, *torque)]
        if self._noise:
            numbers = noisy(numbers, [self._noise] * 6, self._random, self.world.clock.steps)
        fx, fy, fz, tx, ty, tz = numbers
        self.wrench.send(JointWrench((fx, fy, fz), (tx, ty, tz)))
