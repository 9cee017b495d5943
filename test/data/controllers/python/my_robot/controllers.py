"""A controller of a user's robot."""

import math

from rosbots_description.sim.controllers import (
    POSITION,
    JointCommandController,
    register_controller,
)


@register_controller('my_robot/Swing', POSITION)
class Swing(JointCommandController):
    """Swing a joint about the commanded position. Parameters: joint, amplitude [rad]."""

    def load(self):
        """Read the parameters."""
        super().load()
        self.amplitude = self.params.read('amplitude', 0.1)

    def update(self, now_ns, period):
        """Set the position; a swing takes 0.2 s."""
        (joint,), (centre,) = self.joints, self.commands
        joint.command = centre + self.amplitude * math.sin(now_ns * 1e-8 * math.pi)
