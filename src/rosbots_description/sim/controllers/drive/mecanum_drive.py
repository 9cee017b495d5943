"""Four mecanum wheels, whose rollers let a robot move in any direction.

Parameters are those of mecanum_drive_controller for ROS 1: the speed of a wheel is
(x -+ y -+ k yaw rate) / radius, with k = half of the wheelbase and of the track together.
"""

from ..errors import ControllerError
from ..hardware import VELOCITY, JointHandle
from ..registry import register_controller
from .base import DriveController, set_commands

# Signs of the velocity to the left and of the yaw rate in the speed of each wheel.
_WHEELS = (
    ('front_left', -1.0, -1.0),
    ('back_left', 1.0, -1.0),
    ('back_right', -1.0, 1.0),
    ('front_right', 1.0, 1.0),
)


@register_controller('mecanum_drive_controller/MecanumDriveController', VELOCITY)
class MecanumDriveController(DriveController):
    """Drive four wheels, forward, to the left and around."""

    def load_geometry(self) -> None:
        """Read names and sizes of the wheels; what is not given is that of the URDF."""
        self._names = []
        for place, _, _ in _WHEELS:
            name = self.params.string(f'{place}_wheel_joint')
            if name is None:
                raise ControllerError(f"Couldn't retrieve {place}_wheel_joint from param server.")
            self._names.append(name)
        self.radius = self.length('wheels_radius', lambda: self.wheel_radius(self._names[0]))
        self.arm = self.length('wheels_k', self._find_arm)

    def _find_arm(self) -> float:
        """Return half of the wheelbase and of the track together [m]."""
        front_left, back_left, _, front_right = self._names
        return (
            self.joint_distance(front_left, back_left)
            + self.joint_distance(front_left, front_right)
        ) / 2.0

    def load_joints(self) -> None:
        """Find the wheels."""
        self.wheels: tuple[JointHandle, ...] = tuple(map(self.joint, self._names))
        self.begin_measuring()

    def begin_measuring(self) -> None:
        """Measure the rotation of the wheels from here on."""
        self._ways = [wheel.position * self.radius for wheel in self.wheels]

    def advance_odometry(self, now_ns: int) -> None:
        """Add the rotation of the wheels."""
        before, self._ways = self._ways, [one.position * self.radius for one in self.wheels]
        ways = [now - then for now, then in zip(self._ways, before, strict=True)]
        left, turn = (
            sum(way * signs[which] for way, (_, *signs) in zip(ways, _WHEELS, strict=True)) / 4.0
            for which in (0, 1)
        )
        self.planar.advance(sum(ways) / 4.0, turn / self.arm, now_ns, left)

    def drive(self, linear_x: float, angular_z: float, linear_y: float) -> None:
        """Set the wheels' speeds."""
        for wheel, (_, sideways, around) in zip(self.wheels, _WHEELS, strict=True):
            wheel.command = (
                linear_x + sideways * linear_y + around * self.arm * angular_z
            ) / self.radius

    def stand(self) -> None:
        """Stop the wheels."""
        set_commands(self.wheels, 0.0)
