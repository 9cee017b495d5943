"""A joint that follows another one, as the plugin of roboticsgroup makes it.

Tags and behaviour are those of libroboticsgroup_gazebo_mimic_joint_plugin.so 0.1.0, and of its
successor from upatras. Without <hasPID> the joint is set to its position in each step.
"""

import logging
import math
from collections.abc import Mapping

from ..core import PluginError
from ..plugin_registry import register
from ..plugins import ModelPlugin
from .errors import ControllerError
from .parameters import ControllerParameters
from .pid import Gains, Pid


@register('libroboticsgroup_gazebo_mimic_joint_plugin.so')
@register('libroboticsgroup_upatras_gazebo_mimic_joint_plugin.so')
class MimicJointPlugin(ModelPlugin):
    """Keep a joint at multiplier * position of another joint + offset.

    `follower` is the name of that joint. With <hasPID> a force within <maxEffort> does so;
    `gains_path` is where `configure` finds the gains of its PID.
    """

    missing_level = logging.DEBUG

    def load(self) -> None:
        """Read the tags and find the joints."""
        for tag in ('joint', 'mimicJoint'):
            if self.params.text(tag) is None:
                raise PluginError(
                    f'No {tag} element present. MimicJointPlugin could not be loaded.'
                )
        names = self.params.required('joint'), self.params.required('mimicJoint')
        for what, name in zip(('', '(mimic) '), names, strict=True):
            if name not in self.model.joints:
                raise PluginError(
                    f'No {what}joint named "{name}". MimicJointPlugin could not be loaded.'
                )
        if names[0] == names[1]:
            raise PluginError(
                f'Joint "{names[0]}" is to mimic itself; name another one in <joint>. '
                'MimicJointPlugin could not be loaded.'
            )
        self._leader, self._joint = (self.model.joints[name] for name in names)
        self.follower = names[1]
        self.multiplier = self.params.read('multiplier', 1.0)
        self.offset = self.params.read('offset', 0.0)  # [rad or m]
        self.sensitiveness = self.params.read('sensitiveness', 0.0)  # [rad or m]
        limit = self._joint.spec.effort
        # [N m or N]
        self.max_effort = abs(self.params.read('maxEffort', 1e9 if limit is None else limit))
        gains = self.params.text('hasPID')
        self.gains_path = (
            '' if gains is None else (gains or f'gazebo_ros_control/pid_gains/{names[1]}')
        )
        self.pid: Pid | None = None

    def configure(self, parameters: Mapping[str, object]) -> None:
        """Set the gains of the PID.

        Args:
            parameters: those in the robot's namespace, nested as in YAML; the gains are at
                `gains_path`. Without them the joint is passive, which is reported as an error.
        """
        own = f'/{self.namespace}'.replace('//', '/').rstrip('/')
        try:
            self.pid = Pid.from_parameters(
                ControllerParameters(parameters, own).section(self.gains_path)
            )
        except ControllerError as error:
            self.world.faults.report(str(error), logging.ERROR, **self.place)
            self.pid = Pid(Gains(0.0))

    def restart(self) -> None:
        """Follow from the next step on."""
        if self.pid is not None:
            self.pid.reset()
        self.due = self.world.clock.steps + 1

    def before_step(self) -> None:
        """Move the joint, unless it is close enough."""
        self.due = self.world.clock.steps + 1
        position, velocity = self._leader.state()
        wanted = position * self.multiplier + self.offset
        error = wanted - self._joint.position
        if abs(error) < self.sensitiveness or not math.isfinite(error):
            return
        if not self.gains_path:
            self._joint.set_position(wanted, velocity * self.multiplier)
            return
        if self.pid is None:
            self.configure({})
            assert self.pid is not None
        effort = self.pid.update(error, self.world.physics.step_size)
        self._joint.apply_effort(min(max(effort, -self.max_effort), self.max_effort))
