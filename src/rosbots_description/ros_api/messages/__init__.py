"""Conversion between plain values and messages."""

from .conversions import (
    fill_pose,
    fill_transform,
    fill_twist,
    read_pose,
    read_quaternion,
    read_twist,
    read_vector,
    stamp,
)
from .fields import number_getter, number_paths
from .frames import Parents, frames_above, read_transforms
from .layouts import (
    ImuLayout,
    JointStatesLayout,
    LaserScanLayout,
    OdometryLayout,
    PointCloudLayout,
    TransformLayout,
    floats,
)
from .readings import read_reading
from .shown_maps import map_cells
from .shown_readings import MAP_TYPES, SENSOR_TYPES, shown_reading
from .shown_scene import (
    contacts_message,
    motion_message,
    read_contacts,
    read_motion,
    scene_change,
    scene_message,
)
from .validity import RequestError, require_finite

__all__ = [
    'MAP_TYPES',
    'SENSOR_TYPES',
    'ImuLayout',
    'JointStatesLayout',
    'LaserScanLayout',
    'OdometryLayout',
    'Parents',
    'PointCloudLayout',
    'RequestError',
    'TransformLayout',
    'contacts_message',
    'fill_pose',
    'fill_transform',
    'fill_twist',
    'floats',
    'frames_above',
    'map_cells',
    'motion_message',
    'number_getter',
    'number_paths',
    'read_contacts',
    'read_motion',
    'read_pose',
    'read_quaternion',
    'read_reading',
    'read_transforms',
    'read_twist',
    'read_vector',
    'require_finite',
    'scene_change',
    'scene_message',
    'shown_reading',
    'stamp',
]
