"""What a window shows of readings: pictures, and rays and contacts in the scene."""

from collections.abc import Callable, Collection, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..core import SimError, Vector
from ..description import ShownReading
from ..rendering import Picture
from .base import Sensor
from .camera import CameraSensor
from .contact import ContactPair, ContactSensor
from .imu import ImuReading, ImuSensor
from .ray import RaySensor, Scan
from .rays import directions

MAX_RAYS = 1000  # that are shown; of more, every second, third … is
NORMAL = 0.1  # [m] of a shown normal of a contact
MAX_CONTACTS = 8  # that are listed in words
GREATEST = 640  # pixels of a shown picture's longer side; others are left out evenly
# Bytes or numbers of a pixel, and which of them are red, green and blue.
_RGB, _BGR, _GREY = (0, 1, 2), (2, 1, 0), (0, 0, 0)
ENCODINGS: Mapping[str, tuple[str, int, tuple[int, int, int]]] = {
    'rgb8': ('u1', 3, _RGB),
    'rgba8': ('u1', 4, _RGB),
    '8UC3': ('u1', 3, _BGR),
    'bgr8': ('u1', 3, _BGR),
    'bgra8': ('u1', 4, _BGR),
    '8UC4': ('u1', 4, _BGR),
    'mono8': ('u1', 1, _GREY),
    '8UC1': ('u1', 1, _GREY),
    'rgb16': ('u2', 3, _RGB),
    'mono16': ('u2', 1, _GREY),
    '16UC1': ('u2', 1, _GREY),
    '32FC1': ('f4', 1, _GREY),
    **{f'bayer_{order}8': ('u1', 1, _GREY) for order in ('rggb', 'bggr', 'gbrg', 'grbg')},
}


def shown_picture(values: NDArray[Any], encoding: str) -> NDArray[np.uint8]:
    """Return a picture (height, width, 3), RGB; numbers other than bytes from black to white.

    Args:
        values: (height, width) or (height, width, channels).
        encoding: one of `ENCODINGS`, those of sensor_msgs/Image.
    Raises:
        SimError: the encoding is another one.
    """
    if encoding not in ENCODINGS:
        raise SimError(
            f"its encoding '{encoding}' is not shown; those that are: {', '.join(ENCODINGS)}"
        )
    order = ENCODINGS[encoding][2]
    stride = picture_stride(*values.shape[:2])
    values = values[::stride, ::stride].reshape(*values[::stride, ::stride].shape[:2], -1)[
        :, :, list(order)
    ]
    return values if values.dtype == np.uint8 else _bytes(values)


def picture_stride(height: int, width: int) -> int:
    """Return that every how-many-th pixel of a picture is shown."""
    return -(-max(height, width) // GREATEST)


def shown_rays(ends: NDArray[Any], count: int, frame: str = '') -> ShownReading:
    """Return the rays of a scan that meet something.

    Args:
        ends: (n, 3) where they do, in `frame` [m].
        count: of all rays.
    """
    ends = ends.astype(np.float32)
    words = f'{len(ends)} of {count} rays meet something'
    if len(ends):
        words += f', the nearest at {np.linalg.norm(ends, axis=1).min():.3f} m'
    sampled = ends[:: max(1, -(-len(ends) // MAX_RAYS))]
    return ShownReading(frame, points=ends, lines=ray_lines(sampled), words=words)


def ray_lines(ends: NDArray[np.float32]) -> NDArray[np.float32]:
    """Return lines (n, 2, 3) from the origin to points (n, 3)."""
    return np.stack([np.zeros_like(ends), ends], axis=1)


def shown_contacts(
    points: Collection[Vector],
    normals: Collection[Vector],
    forces: Collection[tuple[str, str, float]],
    frame: str = '',
) -> ShownReading:
    """Return contacts with their normals, and in words which collisions touch.

    Args:
        points: of the contacts, in `frame` [m]; normals: theirs.
        forces: names of two collisions, and the force between them [N].
    """
    here = np.array(list(points), np.float32).reshape(-1, 3)
    there = here + NORMAL * np.array(list(normals), np.float32).reshape(-1, 3)
    lines = sorted({f'{one} and {other}: {force:.2f} N' for one, other, force in forces})
    if len(lines) > MAX_CONTACTS:
        lines[MAX_CONTACTS:] = [f'and {len(lines) - MAX_CONTACTS} more']
    return ShownReading(
        frame,
        points=here,
        lines=np.stack([here, there], axis=1),
        words='\n'.join(lines) or 'no contact',
    )


def shown_reading(sensor: Sensor, reading: object, frame: str) -> ShownReading:
    """Return what a window shows of a reading of a sensor.

    Args:
        frame: the name of the sensor's frame; contacts are in the world's, ''.
    Raises:
        SimError: it has an encoding that cannot be shown.
    """
    for kind, show in _SHOWN.items():
        if isinstance(sensor, kind):
            return show(sensor, reading, frame)
    raise SimError(f'readings of {sensor.called} are not shown')


def _picture(
    sensor: CameraSensor, reading: Picture | Sequence[Picture], _frame: str
) -> ShownReading:
    picture = reading if isinstance(reading, Picture) else reading[0]
    if picture.pixels is None:
        return ShownReading(words='The picture is empty.')
    return ShownReading(picture=shown_picture(picture.pixels, sensor.cameras[0].encoding))


def _scan(sensor: RaySensor, scan: Scan, frame: str) -> ShownReading:
    rows, columns = sensor.vertical, sensor.horizontal
    yaw = np.linspace(scan.angle_min, scan.angle_max, columns.count)
    pitch = np.linspace(rows.least, rows.greatest, rows.count)[:, None]
    ways = np.stack(directions(pitch, yaw), axis=-1)
    hit = np.isfinite(scan.ranges)
    return shown_rays(scan.ranges[hit, None] * ways.reshape(-1, 3)[hit], len(hit), frame)


def _imu(_sensor: ImuSensor, reading: ImuReading, _frame: str) -> ShownReading:
    return ShownReading(
        rows=tuple(
            (name, ' '.join(f'{value:.4g}' for value in values))
            for name, values in (
                ('orientation', reading.orientation),
                ('angular velocity [rad/s]', reading.angular_velocity),
                ('linear acceleration [m/s^2]', reading.linear_acceleration),
            )
        )
    )


def _contacts(_sensor: ContactSensor, pairs: tuple[ContactPair, ...], _frame: str) -> ShownReading:
    newest = max((pair.time_ns for pair in pairs), default=0)
    now = [pair for pair in pairs if pair.time_ns == newest]
    points = [point for pair in now for point in pair.points]
    forces = [
        (
            pair.first,
            pair.second,
            float(np.linalg.norm(np.sum([point.force for point in pair.points], axis=0))),
        )
        for pair in now
    ]
    return shown_contacts(
        [point.position for point in points], [point.normal for point in points], forces
    )


_SHOWN: dict[type[Sensor], Callable[[Any, Any, str], ShownReading]] = {
    CameraSensor: _picture,
    RaySensor: _scan,
    ImuSensor: _imu,
    ContactSensor: _contacts,
}


def _bytes(values: NDArray[Any]) -> NDArray[np.uint8]:
    """Return numbers from 0, black, to the greatest, white; those that are not finite black."""
    numbers = np.nan_to_num(values.astype(np.float32), nan=0.0, posinf=0.0, neginf=0.0)
    return (255.0 * numbers.clip(0.0) / max(float(numbers.max()), 1e-6)).astype(np.uint8)
