"""The IMU as a model plugin: libgazebo_ros_imu.so of gazebo_ros_pkgs 2.9.2.

Its acceleration is that of the link, without gravity. Upstream rotates velocity and acceleration by
the orientation instead of its inverse, and the attitude of a body that fixed joint reduction merged
is wrong; so it is here in a strict world only.
"""

from collections.abc import Mapping, Sequence

from ..core import IDENTITY, Pose, Twist, Vector, conjugate, from_rpy, multiply, rotate
from ..plugin_registry import register
from ..plugins import PeriodicPlugin, offsets_in_gazebo
from .base import LogsDefaults
from .imu import ImuReading, mean_acceleration
from .noise import RandomSteps, gaussian, noisy


@register('libgazebo_ros_imu.so')
class LinkImu(LogsDefaults, PeriodicPlugin):
    """Publishes orientation, angular velocity and acceleration of <bodyName>. Output: `imu`."""

    topic_names: Mapping[str, str] = {'imu': '<topicName>'}
    prefix = 'imu plugin '
    strictly_after = False
    _before: tuple[int, Vector] | None = None  # time [ns] and velocity at the previous report

    def load(self) -> None:
        """Read the tags; find the link."""
        read, params = self.params.read, self.params
        self._link, self._mount = self.link('bodyName')
        read('topicName', '/default_imu')
        read('serviceName', '/default_imu')
        if read('frameName', self._link.name) in self.model.spec.reduced:
            params.values['frameName'] = self._link.name
        params.ignore('xyzOffset')
        rpy = params.vector('rpyOffset')
        self._turn = from_rpy(*rpy)
        if self.world.strict and self._mount != IDENTITY:
            self._turn = offsets_in_gazebo(self._mount, (0.0, 0.0, 0.0), rpy)[1]
            self._mount = IDENTITY
        self._noise = gaussian(read('gaussianNoise', 0.0), '<gaussianNoise>')
        self.set_rate(params.rate('updateRate', 0.0))
        self._random = RandomSteps(self.world, f'{self.model.name}::{self.spec.name}')
        self.imu = self.output('imu')

    def reset(self) -> None:
        """Start the mean acceleration at the next step."""
        self._before = None

    wake = reset

    def calibrate(self) -> None:
        """Do nothing, as upstream."""

    def before_step(self) -> None:
        """Sample the velocity before physics if there is no previous one."""
        if self._before is None and self.is_read:
            clock = self.world.clock
            self._before = clock.now_ns - clock.step_ns, self._state()[1].linear
        super().before_step()

    def report(self) -> None:
        """Send orientation, angular velocity and the mean acceleration since the last report."""
        now_ns, (pose, (linear, angular)) = self.world.clock.now_ns, self._state()
        acceleration = mean_acceleration(self._before, now_ns, linear)
        self._before = now_ns, linear
        turn = pose.orientation if self.world.strict else conjugate(pose.orientation)
        numbers: Sequence[float] = (*rotate(turn, angular), *rotate(turn, acceleration))
        if self._noise:
            numbers = noisy(numbers, [self._noise] * 6, self._random, self.world.clock.steps)
        wx, wy, wz, ax, ay, az = numbers
        self.imu.send(
            ImuReading(
                pose.orientation, (wx, wy, wz), (ax, ay, az), (self._noise.deviation**2,) * 9
            )
        )

    def _state(self) -> tuple[Pose, Twist]:
        """Return pose and twist of the IMU's frame in the world."""
        (position, orientation), twist = self._link.state_at(self._mount)
        return Pose(position, multiply(self._turn, orientation)), twist
