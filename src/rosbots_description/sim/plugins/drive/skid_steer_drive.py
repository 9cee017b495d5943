"""The skid steer drive: four wheel joints follow a planar velocity command with lateral slip.

Behaviour, defaults and timing are those of libgazebo_ros_skid_steer_drive.so in gazebo_ros_pkgs
2.9.2. Upstream has no reset of its own, so a reset keeps the command.
"""

from ...plugin_registry import register
from ..parameters import says_defaults_to
from .base import Drive

JOINTS = ('leftFront', 'rightFront', 'leftRear', 'rightRear')
DEFAULTS = ('left_front_joint', 'right_front_joint', 'left_rear_joint', 'right_rear_joint')


@register('libgazebo_ros_skid_steer_drive.so')
class SkidSteerDrive(Drive):
    """Drive the wheels of each side at equal speed; report the true pose.

    Outputs: `odometry` and `odometry_transform`. `wheels` are the joints in the order of `JOINTS`.
    """

    prefix = 'GazeboRosSkidSteerDrive Plugin (ns = {}/) '
    missing = staticmethod(says_defaults_to)
    is_flat = True

    def load(self) -> None:
        """Read all tags with upstream's defaults and in upstream's order; find the wheels."""
        params, read = self.params, self.params.read
        self.add_odometry(transform=read('broadcastTF', False))
        names = [read(f'{what}Joint', name) for what, name in zip(JOINTS, DEFAULTS, strict=True)]
        self.wheel_separation = params.length('wheelSeparation', 0.4)  # [m]
        self.wheel_diameter = params.length('wheelDiameter', 0.15)  # [m]
        self.torque = read('torque', 5.0)  # [N m] per wheel
        self.read_frames('base_footprint')
        self.set_rate(params.rate('updateRate', 100.0))
        x, y = read('covariance_x', 0.0001), read('covariance_y', 0.0001)  # [m^2]
        self.pose_variances = (x, y, 1e12, 1e12, 1e12, read('covariance_yaw', 0.01))  # [rad^2]
        self.twist_variances = self.pose_variances
        self.wheels = [
            self.joint(name, f'{what} hinge') for what, name in zip(JOINTS, names, strict=True)
        ]

    def restart(self) -> None:
        """Reset the command, and let the motors hold the wheels."""
        super().restart()
        self.update(0.0)

    def update(self, _elapsed: float) -> None:
        """Set the wheels' speeds."""
        x, _, yaw_rate = self.target
        half = yaw_rate * self.wheel_separation / 2.0
        radius = self.wheel_diameter / 2.0
        for wheel, rim in zip(self.wheels, (x - half, x + half) * 2, strict=True):
            wheel.set_motor(rim / radius, self.torque)
