"""What a robot senses at the end of a control step, as arrays of fixed shape."""

import math
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from typing import Any, NamedTuple

import numpy as np
from gymnasium import spaces
from numpy.typing import NDArray

from ..sim import Model, NotFoundError, Odometry, SimError, yaw_of
from ..sim.plugins import Drive
from ..sim.sensors import CameraSensor, ImuReading, RaySensor, Scan, Sensor

Array = NDArray[Any]
# Bounds of what has none of its own; the simulator takes nothing beyond them for a position [m] or
# a velocity [m/s, rad/s].
_MOST = 1e9


class Observed(NamedTuple):
    """A part of an observation: its space, and how it is read from the world as it is now."""

    name: str
    space: spaces.Box
    read: Callable[[], Array]


def box(size: int, most: float | Sequence[float] = _MOST) -> spaces.Box:
    """Return the space of `size` numbers from -most to most."""
    high = np.broadcast_to(np.asarray(most, np.float32), (size,))
    return spaces.Box(-high, high, (size,), np.float32)


def observed(robot: Model, names: Sequence[str] | None) -> list[Observed]:
    """Return the parts of an observation.

    Args:
        robot: whose sensors and drives are read.
        names: of sensors, or 'odometry'; None for all that can be observed.
    Raises:
        NotFoundError: there is no such sensor; the message lists those that exist.
        SimError: sensors of its type cannot be observed.
    """
    known = {one.name: one for one in _all(robot)}
    if names is None:
        return [*known.values()]
    found = []
    for name in names:
        if name in known:
            found.append(known[name])
        elif name in robot.sensors:
            raise SimError(
                f"sensor '{name}' of model '{robot.name}' cannot be observed; what can "
                f'be: {", ".join(known) or "nothing"}'
            )
        else:
            raise NotFoundError(
                f"model '{robot.name}' has no sensor '{name}'; what can be "
                f'observed: {", ".join(known) or "nothing"}'
            )
    return found


def forget(robot: Model) -> None:
    """Forget the readings that sensors have sent; until the next one they are read as they are."""
    for sensor in robot.sensors.values():
        if isinstance(sensor, Sensor):
            sensor.readings.latched = None


def _all(robot: Model) -> Iterator[Observed]:
    for plugin in robot.plugins.values():
        if isinstance(plugin, Drive):
            yield Observed('odometry', _ODOMETRY, partial(_odometry, plugin))
            break
    for name, sensor in robot.sensors.items():
        if isinstance(sensor, Sensor):
            for kind, make in _SENSORS.items():
                if sensor.spec.type == kind:
                    yield make(sensor)._replace(name=name)


_ODOMETRY = box(6, (_MOST, _MOST, math.pi, _MOST, _MOST, _MOST))


def _odometry(drive: Drive) -> Array:
    """Return x, y [m], yaw [rad], forward and sideways velocity [m/s], yaw rate [rad/s]."""
    reading: Odometry = drive.read_odometry()
    (x, y, _), orientation = reading.pose
    (vx, vy, _), (_, _, turn) = reading.twist
    return np.array((x, y, yaw_of(orientation), vx, vy, turn), np.float32)


def _scan(sensor: RaySensor) -> Observed:
    shape = (sensor.horizontal.count * sensor.vertical.count,)
    least, most = sensor.range_min, sensor.range_max

    def read() -> Array:
        scan: Scan = sensor.read()
        return np.minimum(scan.ranges, most).astype(np.float32)

    return Observed(
        sensor.name, spaces.Box(np.float32(least), np.float32(most), shape, np.float32), read
    )


def _picture(sensor: CameraSensor) -> Observed:
    lens = sensor.cameras[0].lens
    pixels = np.asarray(sensor.read().pixels)
    most = np.iinfo(pixels.dtype).max
    return Observed(
        sensor.name,
        spaces.Box(0, most, (lens.height, lens.width, *pixels.shape[2:]), pixels.dtype.type),
        lambda: np.asarray(sensor.read().pixels),
    )


def _depths(sensor: CameraSensor) -> Observed:
    lens = sensor.cameras[0].lens

    def read() -> Array:
        near: Array = np.minimum(sensor.read().depths, np.float32(lens.far))
        return near

    return Observed(
        sensor.name, spaces.Box(0.0, lens.far, (lens.height, lens.width), np.float32), read
    )


def _touch(sensor: Sensor) -> Observed:
    return Observed(
        sensor.name,
        spaces.Box(0.0, 1.0, (1,), np.float32),
        lambda: np.array([bool(sensor.read())], np.float32),
    )


def _imu(sensor: Sensor) -> Observed:
    sensor.readings.latch()

    def read() -> Array:
        reading: ImuReading = sensor.readings.latched or sensor.read()
        return np.array(
            (*reading.orientation, *reading.angular_velocity, *reading.linear_acceleration),
            np.float32,
        )

    return Observed(sensor.name, box(10), read)


_SENSORS: dict[str, Callable[[Any], Observed]] = {
    'ray': _scan,
    'gpu_ray': _scan,
    'camera': _picture,
    'depth': _depths,
    'contact': _touch,
    'imu': _imu,
}
