"""Depth images and point clouds: libgazebo_ros_depth_camera.so, openni_kinect.

Tags, defaults and namespaces are those of gazebo_ros_pkgs 2.9.2.
"""

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..plugin_registry import register_in_sensor
from ..rendering import BYTES, Wants
from .camera import DepthSensor
from .camera_outputs import Cloud, Image, StampedInfo
from .camera_plugins import CameraPlugin, Pictures, first_picture

_MILLIMETRES = 1000.0  # per metre


@register_in_sensor('libgazebo_ros_depth_camera.so')
class DepthCameraPlugin(CameraPlugin):
    """Publishes pictures and depths.

    Outputs: `image`, `compressed`, `camera_info`, `depth`, `depth_camera_info`, `points`.
    """

    sensor_class = DepthSensor
    is_organised = False
    sensor: DepthSensor

    def load_channels(self) -> None:
        """Make the outputs."""
        super().load_channels()
        self._topic('depthImageTopicName', 'depth/image_raw')
        self._topic('depthImageCameraInfoTopicName', 'depth/camera_info')
        self._topic('pointCloudTopicName', 'points')
        self.params.ignore('reflectanceTopicName', 'normalsTopicName', 'reduceNormals')
        self._cutoff = self._value('pointCloudCutoff', 0.4)
        self._most = self.farthest()
        self._is_short = self._value('useDepth16UC1Format', False)
        self.depth = self.output('depth')
        self.depth_camera_info = self.output('depth_camera_info')
        self.points = self.output('points')
        lens = self.channels[0].camera.lens
        across, down = (
            (np.arange(size) - 0.5 * (size - 1)) / lens.focal_length
            for size in (lens.width, lens.height)
        )
        self._rays = across.astype('f4')[None, :], down.astype('f4')[:, None]

    def farthest(self) -> float:
        """Return the distance beyond which depths are NaN [m]."""
        return math.inf

    def wants(self) -> Wants:
        """Return what is read."""
        own = super().wants()
        return own._replace(
            pixels=own.pixels or self.points.wanted, depths=self.depth.wanted or self.points.wanted
        )

    def process(self, reading: Pictures) -> None:
        """Send a picture, its depth image and its point cloud."""
        channel, picture = self.channels[0], first_picture(reading)
        channel.send(picture)
        if self.depth_camera_info.wanted:
            self.depth_camera_info.send(StampedInfo(picture.stamp_ns, channel.info))
        if picture.depths is None:
            return
        depths = np.minimum(picture.depths, np.float32(channel.camera.lens.far))
        depths[(depths <= self._cutoff) | (depths >= self._most)] = np.nan
        if self.depth.wanted:
            self.depth.send(self._depth_image(picture.stamp_ns, depths))
        if self.points.wanted and picture.pixels is not None:
            self.points.send(self._cloud(picture.stamp_ns, picture.pixels, depths))

    def _depth_image(self, stamp_ns: int, depths: NDArray[Any]) -> Image:
        height, width = depths.shape
        if not self._is_short:
            return Image(stamp_ns, self.frame, width, height, '32FC1', depths.tobytes())
        short = np.minimum(np.nan_to_num(depths) * np.float32(_MILLIMETRES), 65535.0)
        return Image(stamp_ns, self.frame, width, height, '16UC1', short.astype('<u2').tobytes())

    def _cloud(self, stamp_ns: int, pixels: NDArray[Any], depths: NDArray[Any]) -> Cloud:
        across, down = self._rays
        points = np.zeros((*depths.shape, 8), '<f4')
        points[:, :, 0] = depths * across
        points[:, :, 1] = depths * down
        points[:, :, 2] = depths
        if BYTES[self.channels[0].camera.lens.encoding] == 3:
            points.view('u1')[:, :, 16:19] = pixels  # in the order of the image
        elif pixels.dtype == np.uint8:
            points.view('u1')[:, :, 16:19] = pixels[:, :, :1]
        if not self.is_organised:
            points = points.reshape(1, -1, 8)
        return Cloud(stamp_ns, self.frame, points, not bool(np.isnan(depths).any()))


@register_in_sensor('libgazebo_ros_openni_kinect.so')
class OpenniKinectPlugin(DepthCameraPlugin):
    """A depth camera with organised clouds and a maximum depth."""

    is_organised = True

    def farthest(self) -> float:
        """Return the distance beyond which depths are NaN [m]."""
        return self._value('pointCloudCutoffMax', 5.0)
