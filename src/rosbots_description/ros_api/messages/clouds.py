"""Messages with clouds of points to numbers."""

import math

import numpy as np
from numpy.typing import NDArray
from sensor_msgs.msg import PointCloud, PointCloud2, PointField

from ...sim.core import SimError
from .conversions import read_vector

MAX_POINTS = 20_000  # that are shown; of more, every second, third … is
_KINDS = {
    PointField.INT8: 'i1',
    PointField.UINT8: 'u1',
    PointField.INT16: 'i2',
    PointField.UINT16: 'u2',
    PointField.INT32: 'i4',
    PointField.UINT32: 'u4',
    PointField.FLOAT32: 'f4',
    PointField.FLOAT64: 'f8',
}
Points = NDArray[np.float32]  # (n, 3) [m]
Colours = NDArray[np.uint8]  # (n, 3), RGB


def cloud_points(message: PointCloud2) -> tuple[Points, Colours | None]:
    """Return the points that are finite, with their colours if they have some.

    Raises:
        SimError: it has no coordinates, or fewer bytes than its size says.
    """
    fields = {field.name: field for field in message.fields}
    if not {'x', 'y', 'z'} <= fields.keys():
        raise SimError('it has no fields x, y and z')
    layout = _layout(message, fields)
    points = _sampled(message, layout)
    positions = np.stack([points[name] for name in 'xyz'], axis=1).astype(np.float32)
    finite = np.isfinite(positions).all(axis=1)
    if 'rgb' not in (layout.names or ()):
        return positions[finite], None
    packed = points['rgb'][finite]
    return positions[finite], np.stack([packed >> 16, packed >> 8, packed], axis=1).astype(np.uint8)


def old_cloud_points(message: PointCloud) -> Points:
    """Return the points that are finite."""
    sampled = message.points[:: max(1, -(-len(message.points) // MAX_POINTS))]
    points = np.array([read_vector(point) for point in sampled], np.float32).reshape(-1, 3)
    finite: Points = points[np.isfinite(points).all(axis=1)]
    return finite


def _layout(message: PointCloud2, fields: dict[str, PointField]) -> np.dtype[np.void]:
    """Return where the coordinates of a point are, and its colour as `rgb`."""
    used = {name: fields[name] for name in 'xyz'}
    colour = fields.get('rgb') or fields.get('rgba')
    if colour:
        used['rgb'] = colour
    order = '>' if message.is_bigendian else '<'
    try:
        return np.dtype(
            {
                'names': list(used),
                'offsets': [field.offset for field in used.values()],
                'formats': [
                    order + ('u4' if name == 'rgb' else _KINDS[field.datatype])
                    for name, field in used.items()
                ],
                'itemsize': message.point_step,
            }
        )
    except (KeyError, ValueError) as error:
        raise SimError(f'its fields are no points of {message.point_step} bytes') from error


def _sampled(message: PointCloud2, layout: np.dtype[np.void]) -> NDArray[np.void]:
    """Return no more than about `MAX_POINTS` of its points, evenly."""
    height, width, length = message.height, message.width, message.row_step * message.height
    if len(message.data) < length or message.row_step < width * message.point_step:
        raise SimError(
            f'its {len(message.data)} bytes are no {width} x {height} points of '
            f'{message.point_step} bytes'
        )
    rows = np.frombuffer(message.data, np.uint8, length).reshape(height, message.row_step)
    rows = rows[:, : width * message.point_step]
    stride = max(1, math.ceil(math.sqrt(width * height / MAX_POINTS)))
    if height == 1:
        return np.ascontiguousarray(rows).view(layout)[0, :: stride * stride]
    return np.ascontiguousarray(rows[::stride]).view(layout)[:, ::stride].reshape(-1)
