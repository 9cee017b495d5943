"""The topics of cameras.

Publishes:
    <ns>/<cameraName>/<imageTopicName> (sensor_msgs/Image, latched)
    <ns>/<cameraName>/<imageTopicName>/compressed (sensor_msgs/CompressedImage, latched): JPEG
    <ns>/<cameraName>/<cameraInfoTopicName> (sensor_msgs/CameraInfo)
    multicamera: the same, for each side, in <cameraName>/left and <cameraName>/right
    depth_camera, openni_kinect: <depthImageTopicName> (sensor_msgs/Image),
        <depthImageCameraInfoTopicName> (sensor_msgs/CameraInfo), <pointCloudTopicName>
        (sensor_msgs/PointCloud2), below <cameraName>, too
    <cameraName>/parameter_descriptions and parameter_updates, of dynamic_reconfigure
Subscribes:
    <ns>/<cameraName>/<triggerTopicName> (std_msgs/Empty): triggered_camera; triggered_multicamera
        has one for each side, and either takes the pictures of both
Services:
    <cameraName>/set_camera_info (sensor_msgs/SetCameraInfo)
    <cameraName>/set_parameters (dynamic_reconfigure/Reconfigure): imager_rate
"""

from collections.abc import Callable
from typing import cast

import rospy
from sensor_msgs.msg import CameraInfo as CameraInfoMessage
from sensor_msgs.msg import CompressedImage as CompressedMessage
from sensor_msgs.msg import Image as ImageMessage
from sensor_msgs.msg import PointCloud2, PointField, RegionOfInterest
from sensor_msgs.srv import SetCameraInfo, SetCameraInfoRequest, SetCameraInfoResponse
from std_msgs.msg import Empty, Header

from ...sim.sensors import (
    MAX_BURST,
    CameraInfo,
    CameraPlugin,
    Cloud,
    CompressedImage,
    DepthCameraPlugin,
    Image,
    MultiCameraPlugin,
    StampedInfo,
    TriggeredCameraPlugin,
    TriggeredMultiCameraPlugin,
)
from ..messages import stamp
from .adapter import Adapter
from .declarations import Offers, Publishes, Subscribes
from .registry import declare_topics

QUEUE = MAX_BURST + 1  # a burst, and the picture before; Gazebo's is 2
_FIELDS = [
    PointField(name, offset, PointField.FLOAT32, 1)
    for name, offset in (('x', 0), ('y', 4), ('z', 8), ('rgb', 16))
]


def header(stamp_ns: int, frame: str) -> Header:
    """Return a header with the time of a picture, which may come some steps later."""
    return Header(stamp=stamp(stamp_ns), frame_id=frame)


def image_message(image: Image) -> ImageMessage:
    """Return an image as a message."""
    return ImageMessage(
        header(image.stamp_ns, image.frame),
        image.height,
        image.width,
        image.encoding,
        0,
        len(image.pixels) // image.height,
        image.pixels,
    )


def compressed_message(image: CompressedImage) -> CompressedMessage:
    """Return a compressed image as a message."""
    return CompressedMessage(header(image.stamp_ns, image.frame), image.format, image.data)


def cloud_message(cloud: Cloud) -> PointCloud2:
    """Return a point cloud as a message."""
    height, width, floats = cloud.points.shape
    step = 4 * floats
    return PointCloud2(
        header(cloud.stamp_ns, cloud.frame),
        height,
        width,
        _FIELDS,
        False,
        step,
        step * width,
        cloud.points.tobytes(),
        cloud.is_dense,
    )


def info_message(reading: StampedInfo) -> CameraInfoMessage:
    """Return a camera's info as a message."""
    info = reading.info
    return CameraInfoMessage(
        header=header(reading.stamp_ns, info.frame),
        height=info.height,
        width=info.width,
        distortion_model=info.model,
        D=list(info.distortion),
        K=list(info.intrinsics),
        R=list(info.rectification),
        P=list(info.projection),
        binning_x=info.binning[0],
        binning_y=info.binning[1],
        roi=RegionOfInterest(*info.region),
    )


def read_info(message: CameraInfoMessage) -> CameraInfo:
    """Return the info of a message."""
    roi = message.roi
    return CameraInfo(
        message.width,
        message.height,
        message.distortion_model,
        tuple(message.D),
        tuple(message.K),
        tuple(message.R),
        tuple(message.P),
        (message.binning_x, message.binning_y),
        (roi.x_offset, roi.y_offset, roi.height, roi.width, roi.do_rectify),
        message.header.frame_id,
    )


def set_camera_info(channel: int) -> Callable[[Adapter, str], Callable[[], None]]:
    """Return what offers the service of one camera of a plugin."""

    def offer(adapter: Adapter, name: str) -> Callable[[], None]:
        def answer(request: SetCameraInfoRequest) -> SetCameraInfoResponse:
            info = read_info(request.camera_info)
            plugin = cast(CameraPlugin, adapter.plugin)
            if channel < len(plugin.channels):
                adapter.call(lambda: plugin.set_info(info, channel))
            return SetCameraInfoResponse(success=True)

        shutdown: Callable[[], None] = rospy.Service(name, SetCameraInfo, answer).shutdown
        return shutdown

    return offer


def reconfigure(adapter: Adapter, name: str) -> Callable[[], None]:
    """Offer the rate; loading the library must not keep the world waiting."""
    plugin = cast(CameraPlugin, adapter.plugin)
    if not plugin.camera_name:
        return lambda: None
    from ..reconfigure.camera import serve_rate

    return serve_rate(plugin, name, adapter.server.loop.post).close


def channel_topics(
    side: str, image: str, info: str, folder: str, number: int
) -> tuple[Publishes | Offers, ...]:
    """Return the topics and services of one camera.

    Args:
        side: begins the names of its outputs.
        image: name of the topic; `info` is that of its camera_info.
        folder: in which its services are.
        number: of its channel.
    """
    return (
        Publishes(f'{side}image', ImageMessage, image, image_message, queue=QUEUE, latch=True),
        Publishes(
            f'{side}compressed',
            CompressedMessage,
            f'{image}/compressed',
            compressed_message,
            queue=QUEUE,
            latch=True,
        ),
        Publishes(f'{side}camera_info', CameraInfoMessage, info, info_message, queue=QUEUE),
        Offers(f'{folder}/set_camera_info', set_camera_info(number)),
        Offers(folder, reconfigure),
    )


_ONE = channel_topics('', '<imageTopicName>', '<cameraInfoTopicName>', '<cameraName>', 0)
_DEPTH = (
    *_ONE,
    Publishes('depth', ImageMessage, '<depthImageTopicName>', image_message, queue=QUEUE),
    Publishes(
        'depth_camera_info',
        CameraInfoMessage,
        '<depthImageCameraInfoTopicName>',
        info_message,
        queue=QUEUE,
    ),
    Publishes('points', PointCloud2, '<pointCloudTopicName>', cloud_message, queue=QUEUE),
)
_SIDES = 'left', 'right'
_BOTH = tuple(
    declared
    for number, side in enumerate(_SIDES)
    for declared in channel_topics(
        f'{side}_',
        f'<{side} imageTopicName>',
        f'<{side} cameraInfoTopicName>',
        f'<cameraName>/{side}',
        number,
    )
)
_TRIGGERS = tuple(
    Subscribes('trigger', Empty, lambda _message: (), f'<{side}triggerTopicName>')
    for side in ('', *(f'{side} ' for side in _SIDES))
)
declare_topics(CameraPlugin, *_ONE)
declare_topics(MultiCameraPlugin, *_BOTH)
declare_topics(TriggeredCameraPlugin, *_ONE, *_TRIGGERS[:1])
declare_topics(TriggeredMultiCameraPlugin, *_BOTH, *_TRIGGERS[1:])
declare_topics(DepthCameraPlugin, *_DEPTH)
