"""Planar movement by a force: the model is pushed towards the commanded velocity, without wheels.

Behaviour and defaults are those of libgazebo_ros_force_based_move.so in hector_gazebo_plugins
0.5.4, and of libridgeback_ros_force_based_move.so in ridgeback_gazebo_plugins 0.1.1, whose commands
expire.
"""

from ...core import NANOSECONDS, compose, inverse, rotate
from ...plugin_registry import register
from ...runtime import Odometry
from ..parameters import says_defaults_to
from .base import Drive
from .odometry import world_odometry

MOVING = 100.0  # variance of the yaw [rad^2] and of its rate [rad^2/s^2] of a robot that turns


@register('libgazebo_ros_force_based_move.so')
class ForceBasedMove(Drive):
    """Apply F = k (v - v_now) [N] and T = k_yaw (w - w_now) [N m] to <robotBaseFrame> at each step.

    The force acts along the link's x and y at its centre of mass, the torque about the vertical.
    Outputs: `odometry`, the true motion since the start, and `odometry_transform`.
    """

    prefix = 'PlanarMovePlugin (ns = {}) '
    missing = staticmethod(says_defaults_to)
    pose_variances = (0.001, 0.001, 1e12, 1e12, 1e12, MOVING)
    twist_variances = (0.001, 0.001, 0.001, 1e12, 1e12, MOVING)
    keeps_rate = False
    every_step = True
    command_timeout = float('inf')  # [s]

    def load(self) -> None:
        """Read all tags with upstream's defaults and in upstream's order; find the link."""
        self.read_frames('base_footprint')
        self._pushed, _ = self.link('robotBaseFrame', self.params.string('robotBaseFrame'))
        # [N s/m], [N s/m], [N m s/rad]
        self._gains = tuple(
            self._gain(f'{axis}_velocity_p_gain', default)
            for axis, default in (('x', 10000.0), ('y', 10000.0), ('yaw', 100.0))
        )
        rate = self.params.rate('odometryRate', 20.0)  # 0 for none
        self.set_rate(rate)
        self.add_odometry(rate > 0.0, self.params.read('publishOdometryTf', True) and rate > 0.0)

    def _gain(self, tag: str, default: float) -> float:
        """Return a gain; upstream does not warn where it is missing."""
        return default if self.params.text(tag) is None else self.params.read(tag, default)

    def reset(self) -> None:
        """Begin the odometry at the current pose; keep the command."""
        self._start = self.model.pose

    def before_each_step(self, now_ns: int) -> None:
        """Apply force and torque."""
        if (now_ns - self._commanded_ns) / NANOSECONDS > self.command_timeout:
            self.target = (0.0, 0.0, 0.0)
        pose, twist = self.model.state()
        (x, y, _), (_, _, yaw_rate) = world_odometry(pose, twist).twist
        along, across, about = (
            gain * (wanted - now)
            for gain, wanted, now in zip(self._gains, self.target, (x, y, yaw_rate), strict=True)
        )
        force = rotate(self._pushed.pose.orientation, (along, across, 0.0))
        self._pushed.apply_wrench(force, (0.0, 0.0, about))

    def read_odometry(self) -> Odometry:
        """Return the motion since the start."""
        pose, twist = self.model.state()
        return Odometry(compose(inverse(self._start), pose), world_odometry(pose, twist).twist)


@register('libridgeback_ros_force_based_move.so')
class RidgebackForceBasedMove(ForceBasedMove):
    """The same with commands that expire after <cmdVelTimeOut>."""

    prefix = 'ForceBasedPlugin (ns = {}) '

    def load(self) -> None:
        """Read the timeout as well."""
        super().load()
        self.command_timeout = self.params.read('cmdVelTimeOut', 0.25)
