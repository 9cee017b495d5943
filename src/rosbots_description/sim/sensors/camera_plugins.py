"""Pictures: libgazebo_ros_camera.so, multicamera, and those that are triggered.

Tags, defaults and namespaces are those of gazebo_ros_pkgs 2.9.2.
"""

from typing import TypeVar

from ..core import Fault, report
from ..plugin_registry import register_in_sensor
from ..rendering import BYTES, Lens, Picture, Wants
from ..runtime import Output
from .base import SensorPlugin
from .camera import CameraSensor, MultiCameraSensor, SensedCamera
from .camera_outputs import CameraInfo, CompressedImage, Image, StampedInfo

Pictures = Picture | tuple[Picture, ...]
Value = TypeVar('Value', str, float, bool)
CALIBRATION_TAGS = (
    'Cx',
    'Cy',
    'focalLength',
    'hackBaseline',
    'distortionK1',
    'distortionK2',
    'distortionK3',
    'distortionT1',
    'distortionT2',
)


class Channel:
    """Outputs and calibration of one camera of a plugin: `image`, `compressed`, `camera_info`."""

    def __init__(
        self, plugin: 'CameraPlugin', camera: SensedCamera, side: str, baseline: float
    ) -> None:
        """Make the outputs; `side` prefixes their names, `baseline` is in metres."""
        self.camera = camera
        self.frame = plugin.frame
        self.image: Output[Image] = plugin.output(f'{side}image')
        self.compressed: Output[CompressedImage] = plugin.output(f'{side}compressed')
        self.camera_info: Output[StampedInfo] = plugin.output(f'{side}camera_info')
        self.info = plugin.info(camera.lens, baseline)
        colours = 'bgr8' if BYTES[camera.lens.encoding] % 3 == 0 else ''
        self._format = f'{camera.encoding}; jpeg compressed {colours}'

    def send(self, picture: Picture) -> None:
        """Send a picture."""
        if self.image.wanted and picture.pixels is not None:
            lens = self.camera.lens
            self.image.send(
                Image(
                    picture.stamp_ns,
                    self.frame,
                    lens.width,
                    lens.height,
                    self.camera.encoding,
                    picture.pixels.tobytes(),
                )
            )
        if self.compressed.wanted and picture.jpeg is not None:
            self.compressed.send(
                CompressedImage(picture.stamp_ns, self.frame, self._format, picture.jpeg)
            )
        if self.camera_info.wanted:
            self.camera_info.send(StampedInfo(picture.stamp_ns, self.info))


@register_in_sensor('libgazebo_ros_camera.so')
class CameraPlugin(SensorPlugin[Pictures]):
    """Publishes pictures. Outputs: `image`, `compressed`, `camera_info`."""

    sensor_class: type[CameraSensor] = CameraSensor
    prefix = 'Camera Plugin (ns = {}) '
    empty_namespace = '{}'
    sensor: CameraSensor

    def load(self) -> None:
        """Read the tags."""
        self.rate = self._value('updateRate', 0.0)
        self.camera_name = self._value('cameraName', '')
        if not self.camera_name:
            what = '<cameraName> is missing or empty: there is no dynamic_reconfigure'
            report(Fault(self.log_prefix + what))
        self.frame = self._value('frameName', '')
        self._topic('imageTopicName', 'image_raw')
        self._topic('cameraInfoTopicName', 'camera_info')
        self._values = {tag: self._value(tag, 0.0) for tag in CALIBRATION_TAGS}
        self._takes_distortion = self._value('autoDistortion', False)
        self.params.ignore('CxPrime')
        self.load_trigger()
        self.sensor.crop(self._value('borderCrop', True))
        self.load_channels()

    def load_trigger(self) -> None:
        """Ignore what triggered cameras read."""
        self.params.ignore('triggerTopicName')

    def load_channels(self) -> None:
        """Make the outputs."""
        self.channels: tuple[Channel, ...] = (
            Channel(self, self.sensor.cameras[0], '', self._values['hackBaseline']),
        )

    def restart(self) -> None:
        """Restart the schedule of pictures at the current time."""
        super().restart()
        self.readers_changed()

    def info(self, lens: Lens, baseline: float) -> CameraInfo:
        """Return the calibration of a lens according to the tags."""
        values = self._values
        seen = lens.focal_length
        focal = values['focalLength'] or seen
        if abs(focal - seen) > 1e-6 * seen:
            what = (
                f'{self.log_prefix}<focalLength> is {focal:g} and does not fit <horizontal_fov> '
                f'and width, which make {seen:.6g}: messages say the former, pictures are taken '
                'with the latter'
            )
            report(Fault(what))
        x = values['Cx'] or (lens.width + 1.0) / 2.0
        y = values['Cy'] or (lens.height + 1.0) / 2.0
        k1, k2, k3, t1, t2 = (
            lens.distortion
            if self._takes_distortion
            else (values[f'distortion{name}'] for name in ('K1', 'K2', 'K3', 'T1', 'T2'))
        )
        return CameraInfo(
            lens.width,
            lens.height,
            'plumb_bob',
            (k1, k2, t1, t2, k3),
            (focal, 0.0, x, 0.0, focal, y, 0.0, 0.0, 1.0),
            (1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0),
            (focal, 0.0, x, -focal * baseline, 0.0, focal, y, 0.0, 0.0, 0.0, 1.0, 0.0),
            frame=self.frame,
        )

    def set_info(self, info: CameraInfo, channel: int = 0) -> None:
        """Set the calibration sent with pictures, as by set_camera_info."""
        self.channels[channel].info = info

    def set_rate(self, rate: float) -> None:
        """Set the rate of pictures [Hz], as by dynamic_reconfigure."""
        self.sensor.set_rate(rate)

    def readers_changed(self) -> None:
        """Request what is read."""
        self.sensor.want(self, self.wants() if self.is_read else None)
        super().readers_changed()

    def wants(self) -> Wants:
        """Return what is read."""
        return Wants(
            any(channel.image.wanted for channel in self.channels),
            False,
            any(channel.compressed.wanted for channel in self.channels),
        )

    def stamp_of(self, reading: Pictures) -> int:
        """Return the stamp of a picture [ns]."""
        return first_picture(reading).stamp_ns

    def process(self, reading: Pictures) -> None:
        """Send a picture."""
        self.channels[0].send(first_picture(reading))

    def unload(self) -> None:
        """Withdraw the request for pictures."""
        self.sensor.want(self, None)

    def _topic(self, tag: str, default: str) -> None:
        """Read a topic name, relative to the camera's name, and store it as the tag's value."""
        name = self._value(tag, default)
        if not name.startswith('/') and self.camera_name:
            name = f'{self.camera_name}/{name}'
        self.params.values[tag] = name

    def _value(self, tag: str, default: Value) -> Value:
        """Return a tag's value, or the default without a log message, as upstream."""
        if self.params.text(tag) is None:
            self.params.values[tag] = default
            return default
        return self.params.read(tag, default)


@register_in_sensor('libgazebo_ros_multicamera.so')
class MultiCameraPlugin(CameraPlugin):
    """Publishes the pictures of the cameras named left and right, with equal stamps.

    Outputs: `left_image`, `left_compressed`, `left_camera_info`, and the same of `right`.
    """

    sensor_class = MultiCameraSensor

    def load_channels(self) -> None:
        """Make the outputs."""
        found = {}
        for number, camera in enumerate(self.sensor.cameras):
            side = next((side for side in ('left', 'right') if side in camera.name), '')
            if not side or side in found:
                what = f"{self.log_prefix}camera '{camera.name}' has no topics"
                why = "upstream looks for one 'left' and one 'right' in the names"
                report(Fault(f'{what}: {why}'))
            else:
                found[side] = number
        self._numbers = tuple(found.values())
        self.sides = tuple(found)
        # Only the right camera is offset by the baseline.
        self.channels = tuple(
            Channel(
                self,
                self.sensor.cameras[number],
                f'{side}_',
                self._values['hackBaseline'] if side == 'right' else 0.0,
            )
            for side, number in found.items()
        )

    def _topic(self, tag: str, default: str) -> None:
        super()._topic(tag, default)
        name = self._value(tag, default).lstrip('/')
        for side in ('left', 'right'):
            self.params.values[f'{side} {tag}'] = f'{self.camera_name}/{side}/{name}'.lstrip('/')

    def process(self, reading: Pictures) -> None:
        """Send the pictures."""
        pictures = (reading,) if isinstance(reading, Picture) else reading
        for channel, number in zip(self.channels, self._numbers, strict=True):
            channel.send(pictures[number])


class Triggered(CameraPlugin):
    """Publishes one picture for each `trigger()`; triggers in the same step count as one."""

    def load_trigger(self) -> None:
        """Stop the sensor's own rate."""
        self.rate = 0.0
        self._topic('triggerTopicName', 'image_trigger')
        self.sensor.triggered = False

    def trigger(self) -> None:
        """Take a picture in the next step, as by a message on the trigger topic."""
        self.sensor.trigger()


@register_in_sensor('libgazebo_ros_triggered_camera.so')
class TriggeredCameraPlugin(Triggered):
    """A camera that is triggered."""


@register_in_sensor('libgazebo_ros_triggered_multicamera.so')
class TriggeredMultiCameraPlugin(Triggered, MultiCameraPlugin):
    """A multicamera that is triggered."""


def first_picture(reading: Pictures) -> Picture:
    """Return the picture of the first camera."""
    return reading if isinstance(reading, Picture) else reading[0]
