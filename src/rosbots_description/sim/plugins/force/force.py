"""A constant wrench on a link, until the next command.

Tags and behaviour are those of libgazebo_ros_force.so in gazebo_ros_pkgs 2.9.2.
"""

import logging
import math
from collections.abc import Mapping

from ...core import ZERO, Vector
from ...plugin_registry import register
from ...runtime import NEVER
from ..base import ModelPlugin


@register('libgazebo_ros_force.so')
class Force(ModelPlugin):
    """Apply a wrench to <bodyName> in each step, in world axes at its centre of mass."""

    topic_names: Mapping[str, str] = {'command': '<topicName>'}
    prefix = 'force plugin: '
    missing_level = logging.DEBUG

    def load(self) -> None:
        """Read the tags and find the link."""
        self._link, _ = self.link('bodyName')
        self.params.required('topicName')
        self.wrench = (ZERO, ZERO)

    def command(self, force: Vector, torque: Vector) -> None:
        """Apply `force` [N] and `torque` [N m] until the next command.

        Raises:
            ValueError: a number is not finite.
        """
        if not all(map(math.isfinite, (*force, *torque))):
            raise ValueError(
                f'a wrench takes finite numbers; it got force {force}, torque {torque}'
            )
        self.wrench = (force, torque)
        self.reset()

    def before_step(self) -> None:
        """Apply the wrench."""
        self._link.apply_wrench(*self.wrench)
        self.due = self.world.clock.steps + 1

    def reset(self) -> None:
        """Keep the wrench, as Gazebo's plugin does after a reset."""
        self.due = NEVER if self.wrench == (ZERO, ZERO) else self.world.clock.steps + 1
