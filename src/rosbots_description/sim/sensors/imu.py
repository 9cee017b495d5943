"""Inertial measurement units: the sensor, and the plugin libgazebo_ros_imu_sensor.so.

Tags, defaults and namespaces of the plugin are those of gazebo_ros_pkgs 2.9.2, and so are its
quirks: 1 Hz without <updateRateHZ>, and noise on the quaternion, which is not normalised again.
"""

from collections.abc import Mapping, Sequence
from typing import NamedTuple

from ..core import (
    NANOSECONDS,
    Fault,
    Quaternion,
    Twist,
    Vector,
    conjugate,
    from_rpy,
    multiply,
    report,
    rotate,
    subtract,
)
from ..plugin_registry import register_in_sensor, register_sensor
from .base import Sensor, SensorPlugin
from .noise import gaussian, noisy, read_noise
from .numbers import child_at

_AXES = 'x', 'y', 'z'


class ImuReading(NamedTuple):
    """An IMU reading in the sensor's axes, with its nominal variances."""

    orientation: Quaternion  # relative to the world, or to the initial orientation
    angular_velocity: Vector  # [rad/s]
    linear_acceleration: Vector  # [m/s^2]
    variances: tuple[float, ...] = (0.0,) * 9  # in the same order and units, about x, y and z


@register_sensor('imu')
class ImuSensor(Sensor):
    """Measures orientation, angular velocity and proper acceleration at its pose on the link.

    The acceleration is the mean since the previous reading, so that it integrates to the velocity.
    Without other readers, `read` assumes zero acceleration of the sensor's origin.
    """

    def load(self) -> None:
        """Read the noise."""
        imu = self.spec.element.child('imu')
        self._noises = [
            *(read_noise(child_at(imu, f'angular_velocity/{axis}/noise')) for axis in _AXES),
            *(read_noise(child_at(imu, f'linear_acceleration/{axis}/noise')) for axis in _AXES),
        ]
        self.is_noisy = any(noise.deviation for noise in self._noises)
        self._before: tuple[int, Vector] | None = None  # time [ns], velocity

    def reset(self) -> None:
        """Start the mean acceleration at the next step."""
        self._before = None

    def count_readers(self) -> None:
        """Discard the previous velocity while there are no readers."""
        super().count_readers()
        if not self.readings.wanted:
            self._before = None

    def before_step(self) -> None:
        """Sample the velocity before physics if there is no previous one."""
        super().before_step()
        if self._before is None:
            clock = self.world.clock
            self._before = clock.now_ns - clock.step_ns, self._state()[1].linear

    def after_step(self) -> None:
        """Send a reading, and keep its velocity for the next one."""
        super().after_step()
        self._before = self.world.clock.now_ns, self._state()[1].linear

    def measure(self) -> ImuReading:
        """Return a reading."""
        orientation, (linear, angular) = self._state()
        acceleration = mean_acceleration(self._before, self.world.clock.now_ns, linear)
        proper = subtract(acceleration, self.world.physics.gravity)
        back = conjugate(orientation)
        measured: Sequence[float] = (*rotate(back, angular), *rotate(back, proper))
        if any(self._noises):
            measured = noisy(
                measured, self._noises, self.random, self.world.clock.steps, self.noise_scale
            )
        wx, wy, wz, ax, ay, az = measured
        return ImuReading(orientation, (wx, wy, wz), (ax, ay, az))

    def _state(self) -> tuple[Quaternion, Twist]:
        """Return orientation and twist of the sensor's frame in the world."""
        pose, twist = self.link.state_at(self.spec.pose)
        return pose.orientation, twist


def mean_acceleration(before: tuple[int, Vector] | None, now_ns: int, velocity: Vector) -> Vector:
    """Return the mean acceleration [m/s^2] since `before`, a time [ns] and a velocity [m/s]."""
    if before is None or now_ns <= before[0]:
        return (0.0, 0.0, 0.0)
    seconds = (now_ns - before[0]) / NANOSECONDS
    x, y, z = subtract(velocity, before[1])
    return (x / seconds, y / seconds, z / seconds)


def _says_set_to(tag: str, default: str | float | bool) -> str:
    """Word a warning as upstream."""
    where = '/namespace/default' if tag == 'topicName' else 'default'
    shown = f'{default:g}' if isinstance(default, float) else default
    return f'missing <{tag}>, set to {where}: {shown}'


@register_in_sensor('libgazebo_ros_imu_sensor.so')
class ImuSensorPlugin(SensorPlugin[ImuReading]):
    """Publishes readings at its own rate. Output: `imu`."""

    topic_names: Mapping[str, str] = {'imu': '<topicName>'}
    sensor_class = ImuSensor
    absent_namespace = '/{}'
    rate_tag = 'updateRateHZ'
    missing = staticmethod(_says_set_to)

    def load(self) -> None:
        """Read the tags; <bodyName> and <xyzOffset> are ignored, as upstream."""
        read = self.params.read
        self.params.ignore('bodyName')
        if self.params.text('robotNamespace') is None:
            report(Fault(f'missing <robotNamespace>, set to default: {self.namespace}/'))
        read('topicName', 'imu_data')
        self.params.required('frameName')
        self.rate = self.params.rate('updateRateHZ', 1.0)
        self._noise = gaussian(read('gaussianNoise', 0.0), '<gaussianNoise>')
        read('xyzOffset', '0 0 0')
        self._turn = from_rpy(*self.params.vector('rpyOffset'))
        self._reference = None
        if self.params.text('initialOrientationAsReference') is not None and read(
            'initialOrientationAsReference', False
        ):
            self._reference = conjugate(self.sensor.pose.orientation)
            what = (
                '<initialOrientationAsReference> set to true, this behavior is '
                'deprecated as it does not comply with REP 145.'
            )
            report(Fault(self.log_prefix + what))
        self.imu = self.output('imu')

    def process(self, reading: ImuReading) -> None:
        """Send a reading."""
        orientation = reading.orientation
        if self._reference is not None:
            orientation = multiply(self._reference, orientation)
        numbers: Sequence[float] = (
            *multiply(self._turn, orientation),
            *reading.angular_velocity,
            *reading.linear_acceleration,
        )
        if self._noise:
            numbers = noisy(numbers, [self._noise] * 10, self.random, self.world.clock.steps)
        x, y, z, w, wx, wy, wz, ax, ay, az = numbers
        self.imu.send(
            ImuReading((x, y, z, w), (wx, wy, wz), (ax, ay, az), (self._noise.deviation**2,) * 9)
        )
