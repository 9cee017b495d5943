"""The IMU libhector_gazebo_ros_imu.so of hector_gazebo_plugins 0.5.4, a plugin of a model.

The bias of its proper acceleration tilts its orientation, as in an attitude estimate. <rpyOffset>
is the mount on the body, where upstream rotates the orientation about the axes of the world.
"""

import logging
import math
from collections.abc import Mapping

from ..core import (
    IDENTITY,
    NANOSECONDS,
    Pose,
    Quaternion,
    Vector,
    as_vector,
    conjugate,
    from_rpy,
    multiply,
    normalise,
    rotate,
    subtract,
)
from ..plugin_registry import register
from .hector_errors import ErrorModel, Floats, find_body
from .imu import ImuReading, mean_acceleration
from .link_imu import LinkImu
from .noise import RandomSteps


@register('libhector_gazebo_ros_imu.so')
class HectorImu(LinkImu):
    """Publishes what an IMU on <bodyName> measures, and its bias. Outputs: `imu`, `bias`."""

    missing_level = logging.DEBUG
    hints: Mapping[str, str] = {'headingDrift': ' (the tags of the heading begin with yaw)'}

    def load(self) -> None:
        """Read the tags; find the link."""
        read, params = self.params.read, self.params
        self._link, (position, orientation) = find_body(self)
        topic = read('topicName', 'imu')
        bias_topic = read('biasTopicName', f'{topic}/bias')
        read('serviceName', f'{topic}/calibrate')
        params.values['frameName'] = read('frameId', params.text('bodyName') or self._link.name)
        params.ignore('xyzOffset')
        turn = from_rpy(*params.vector('rpyOffset'))
        self._mount, self._turn = Pose(position, multiply(orientation, turn)), IDENTITY.orientation
        self._accel, self._rate = ErrorModel(self, 'accel'), ErrorModel(self, 'rate')
        self._yaw = ErrorModel(self, 'yaw', 1)
        if noise := abs(read('gaussianNoise', 0.0)):
            self._accel.noise[:] = self._rate.noise[:] = noise
        self.set_rate(params.rate('updateRate', 0.0))
        self._random = RandomSteps(self.world, f'{self.model.name}::{self.spec.name}')
        self.imu, self.bias = self.output('imu', bool(topic)), self.output('bias', bool(bias_topic))

    def reset(self) -> None:
        """Start mean acceleration and drift anew."""
        super().reset()
        self._rate.reset()

    def calibrate(self) -> None:
        """Remove the drift of the angular velocity."""
        self._rate.calibrate(self.world.clock.now_ns / NANOSECONDS)

    def report(self) -> None:
        """Send a reading, and its bias."""
        now_ns, (pose, (linear, angular)) = self.world.clock.now_ns, self._state()
        gravity, back = self.world.physics.gravity, conjugate(pose.orientation)
        proper = subtract(mean_acceleration(self._before, now_ns, linear), gravity)
        self._before = now_ns, linear
        accel_bias, rate_bias, (yaw,) = (
            model.bias(now_ns / NANOSECONDS) for model in (self._accel, self._rate, self._yaw)
        )
        error = _attitude_error(
            rotate(pose.orientation, as_vector(accel_bias.tolist())), yaw, math.hypot(*gravity)
        )
        random = self._random.at(self.world.clock.steps)
        rate, accel = (
            model.measured(rotate(back, values), bias, random)
            for model, values, bias in (
                (self._rate, angular, rate_bias),
                (self._accel, proper, accel_bias),
            )
        )
        self.imu.send(ImuReading(multiply(error, pose.orientation), rate, accel, self._variances()))
        self.bias.send(
            ImuReading(error, as_vector(rate_bias.tolist()), as_vector(accel_bias.tolist()))
        )

    def _variances(self) -> tuple[float, ...]:
        """Return those of orientation (-1 for a tilt without gravity), rate and acceleration."""
        accel: Floats = self._accel.noise**2
        weight = math.hypot(*self.world.physics.gravity) ** 2
        tilt = (accel[:2] / weight).tolist() if weight > 0.0 else [-1.0, -1.0]
        return (
            *tilt,
            float(self._yaw.noise[0]) ** 2,
            *(self._rate.noise**2).tolist(),
            *accel.tolist(),
        )


def _attitude_error(bias: Vector, yaw: float, gravity: float) -> Quaternion:
    """Return the rotation that an acceleration bias [m/s^2] and a yaw error [rad] make."""
    x, y = (0.5 * one / gravity if gravity > 0.0 else 0.0 for one in bias[:2])
    return normalise(multiply(from_rpy(0.0, 0.0, yaw), (y, -x, 0.0, 1.0)))
