"""Messages of sensors, and others, to what a window shows of them."""

import math
from collections.abc import Callable
from typing import Any

import numpy as np
from gazebo_msgs.msg import ContactsState
from genpy import Message
from geometry_msgs.msg import WrenchStamped
from nav_msgs.msg import Odometry
from sensor_msgs.msg import (
    CompressedImage,
    Image,
    Imu,
    LaserScan,
    MagneticField,
    NavSatFix,
    PointCloud,
    PointCloud2,
    Range,
)

from ...sim.core import Vector
from ...sim.description import ShownReading
from ...sim.sensors import ray_lines, shown_contacts, shown_rays
from . import shown_maps
from .clouds import cloud_points, old_cloud_points
from .conversions import read_vector
from .pictures import decompressed, pixels


def _scan(message: LaserScan) -> ShownReading:
    ranges = np.asarray(message.ranges)
    hit = (ranges >= message.range_min) & (ranges <= message.range_max)  # never for NaN
    angles = (message.angle_min + message.angle_increment * np.arange(len(ranges)))[hit]
    met = ranges[hit]
    points = np.stack([met * np.cos(angles), met * np.sin(angles), np.zeros(len(met))], axis=1)
    return shown_rays(points, len(ranges), message.header.frame_id)


def _range(message: Range) -> ShownReading:
    end = np.array([[message.range, 0.0, 0.0]], np.float32)
    ends = end[np.isfinite(end).all(axis=1)]
    return ShownReading(
        message.header.frame_id, points=ends, lines=ray_lines(ends), words=f'{message.range:.3f} m'
    )


def _cloud(message: PointCloud2) -> ShownReading:
    points, colours = cloud_points(message)
    return ShownReading(
        message.header.frame_id,
        points=points,
        colours=colours,
        words=f'{message.width * message.height} points',
    )


def _old_cloud(message: PointCloud) -> ShownReading:
    return ShownReading(
        message.header.frame_id,
        points=old_cloud_points(message),
        words=f'{len(message.points)} points',
    )


def _contacts(message: ContactsState) -> ShownReading:
    points: list[Vector] = []
    normals: list[Vector] = []
    forces = []
    for state in message.states:
        points += map(read_vector, state.contact_positions)
        normals += map(read_vector, state.contact_normals)
        force = math.hypot(*read_vector(state.total_wrench.force))
        forces.append((state.collision1_name, state.collision2_name, force))
    return shown_contacts(points, normals, forces, message.header.frame_id)


def _numbers(message: Message) -> ShownReading:
    return ShownReading(
        rows=tuple(
            (name, ' '.join(f'{value:.4g}' for value in values))
            for name, values in _leaves(message, '')
        )
    )


def _leaves(message: Message, name: str) -> list[tuple[str, list[float]]]:
    """Return the numbers of a message, those of a vector together; no arrays, no header."""
    found, own = [], []
    for slot in message.__slots__:
        value = getattr(message, slot)
        if isinstance(value, bool | int | float):
            own.append((slot, float(value)))
        elif hasattr(value, '__slots__') and slot != 'header':
            found += _leaves(value, f'{name} {slot}'.strip())
    if {'x', 'y', 'z'} <= {slot for slot, _ in own}:
        return [(name, [value for _, value in own])]
    return [(f'{name} {slot}'.strip(), [value]) for slot, value in own] + found


_SHOWN: dict[type[Any], Callable[[Any], ShownReading]] = {
    Image: lambda message: ShownReading(picture=pixels(message)),
    CompressedImage: lambda message: ShownReading(picture=decompressed(message)),
    LaserScan: _scan,
    Range: _range,
    PointCloud2: _cloud,
    PointCloud: _old_cloud,
    ContactsState: _contacts,
    Imu: _numbers,
    WrenchStamped: _numbers,
    Odometry: _numbers,
    MagneticField: _numbers,
    NavSatFix: _numbers,
}
SENSOR_TYPES = {kind._type: kind for kind in _SHOWN}
MAP_TYPES = {kind._type: kind for kind in shown_maps.SHOWN}


def shown_reading(message: Message) -> ShownReading:
    """Return what a window shows of a message of one of `SENSOR_TYPES` or `MAP_TYPES`.

    Raises:
        SimError: a sentence about what is wrong with it, without its beginning.
    """
    return (_SHOWN | shown_maps.SHOWN)[type(message)](message)
