"""Sensors of `<sensor>` elements and the plugins in them; importing registers them."""

from .base import Sensor, SensorPlugin
from .block_laser import BlockLaserPlugin, Points
from .camera import MAX_BURST, CameraSensor
from .camera_outputs import CameraInfo, Cloud, CompressedImage, Image, StampedInfo
from .camera_plugins import (
    CameraPlugin,
    MultiCameraPlugin,
    TriggeredCameraPlugin,
    TriggeredMultiCameraPlugin,
)
from .contact import BumperPlugin, ContactPair, ContactPoint
from .depth_camera_plugins import DepthCameraPlugin, OpenniKinectPlugin
from .hector_gps import Fix, HectorGps
from .hector_imu import HectorImu
from .imu import ImuReading, ImuSensorPlugin
from .joint_wrench import JointWrench, JointWrenchPlugin
from .laser import LaserPlugin
from .link_imu import LinkImu
from .range import Distance, RangePlugin
from .ray import RaySensor, Scan
from .shown_readings import (
    ENCODINGS,
    picture_stride,
    ray_lines,
    shown_contacts,
    shown_picture,
    shown_rays,
    shown_reading,
)
from .velodyne import RingCloud, VelodynePlugin

__all__ = [
    'ENCODINGS',
    'MAX_BURST',
    'BlockLaserPlugin',
    'BumperPlugin',
    'CameraInfo',
    'CameraPlugin',
    'CameraSensor',
    'Cloud',
    'CompressedImage',
    'ContactPair',
    'ContactPoint',
    'DepthCameraPlugin',
    'Distance',
    'Fix',
    'HectorGps',
    'HectorImu',
    'Image',
    'ImuReading',
    'ImuSensorPlugin',
    'JointWrench',
    'JointWrenchPlugin',
    'LaserPlugin',
    'LinkImu',
    'MultiCameraPlugin',
    'OpenniKinectPlugin',
    'Points',
    'RangePlugin',
    'RaySensor',
    'RingCloud',
    'Scan',
    'Sensor',
    'SensorPlugin',
    'StampedInfo',
    'TriggeredCameraPlugin',
    'TriggeredMultiCameraPlugin',
    'VelodynePlugin',
    'picture_stride',
    'ray_lines',
    'shown_contacts',
    'shown_picture',
    'shown_rays',
    'shown_reading',
]
