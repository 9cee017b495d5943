"""Camera sensors: `<sensor>` elements of type camera, multicamera and depth."""

import logging
import math
from typing import NamedTuple

from ..core import PluginError, Pose, compose, from_rpy, parse_numbers
from ..description import Element
from ..plugin_registry import register_sensor
from ..rendering import (
    MAX_PENDING,
    ImageCapture,
    Lens,
    NoRendererError,
    Picture,
    RenderError,
    Wants,
)
from ..runtime import NEVER
from .base import DueTimes, Sensor
from .noise import read_noise
from .numbers import child_at, count, number

MAX_BURST = MAX_PENDING  # pictures of one camera that are sent in one step
MAX_IMAGE_SIZE = 8192  # [pixels] along an edge
POLL = 4  # steps between two polls for a pending picture
WINDOW = 5_000_000_000  # [ns] of simulated time over which the rate of pictures is judged
FEWEST = 10  # pictures due in that time, else it is extended
TOLERATED = 0.05  # share of the pictures due that may be left out without a warning
_ENCODINGS = {
    'L8': 'mono8',
    'L_INT8': 'mono8',
    'L16': 'mono16',
    'L_INT16': 'mono16',
    'R8G8B8': 'rgb8',
    'RGB_INT8': 'rgb8',
    'B8G8R8': 'bgr8',
    'BGR_INT8': 'bgr8',
    'R16G16B16': 'rgb16',
    'RGB_INT16': 'rgb16',
    'BAYER_RGGB8': 'bayer_rggb8',
    'BAYER_BGGR8': 'bayer_bggr8',
    'BAYER_GBRG8': 'bayer_gbrg8',
    'BAYER_GRBG8': 'bayer_grbg8',
}
_DISTORTION = ('k1', 'k2', 'k3', 'p1', 'p2')


class SensedCamera(NamedTuple):
    """One <camera>: name, pose in the sensor's frame, lens, and published encoding."""

    name: str
    pose: Pose
    lens: Lens
    encoding: str


class PictureRate:
    """Judges once whether pictures are taken at the rate at which they are due."""

    def __init__(self) -> None:
        self._told = False
        self._begin(0)

    def _begin(self, now_ns: int) -> None:
        self._start, self._due, self._taken = now_ns, 0, 0

    def count(self, now_ns: int, taken: bool) -> tuple[float, float] | None:
        """Count a picture that is due at `now_ns` [ns].

        Returns:
            The rates at which pictures are taken and due [Hz], once, when too many are left out.
        """
        if not self._due or now_ns < self._start:  # the first one, or time has been reset
            self._begin(now_ns)
        self._due += 1
        self._taken += taken
        seconds = (now_ns - self._start) / 1e9
        if now_ns - self._start < WINDOW or self._due < FEWEST:
            return None
        due, taken_of_due = self._due, self._taken
        self._begin(now_ns)
        if self._told or taken_of_due >= (1.0 - TOLERATED) * due:
            return None
        self._told = True
        return taken_of_due / seconds, (due - 1) / seconds


@register_sensor('camera')
class CameraSensor(Sensor):
    """Measures `Picture`s.

    While the world keeps pace with the wall clock, steps do not wait for pictures: each is sent
    when it has been drawn, stamped with the time of its scene. Otherwise steps wait, and no picture
    is skipped.
    """

    has_depth = False

    def load(self) -> None:
        """Read the cameras."""
        elements = [one for one in self.spec.element.children if one.tag == 'camera']
        elements = elements or [Element('camera')]  # with all defaults
        self.cameras = tuple(self._camera(one) for one in self._chosen(elements))
        self.is_noisy = any(one.lens.noise_stddev for one in self.cameras)
        self._wanted: dict[object, Wants] = {}  # by plugin
        self._capture = ImageCapture(self.world)
        self._picture_step = NEVER
        # Whether one picture is to be taken in the next step, None: pictures come at the rate.
        self.triggered: bool | None = None
        self._complaint = ''
        self._rate = PictureRate()

    def _chosen(self, elements: list[Element]) -> list[Element]:
        return elements[:1]

    def reading(self, pictures: tuple[Picture, ...]) -> object:
        """Return the reading for the pictures of all cameras."""
        return pictures[0]

    def shared(self) -> tuple[object, ...]:
        """Return what is not part of the state."""
        return (*super().shared(), self.cameras, self._capture)

    def want(self, plugin: object, what: Wants | None) -> None:
        """Set what a plugin wants, None: nothing; other readers get pixels and depths."""
        if what is None:
            self._wanted.pop(plugin, None)
        else:
            self._wanted[plugin] = what

    def crop(self, crops: bool) -> None:
        """Set whether empty borders of distorted pictures are cropped."""
        self.cameras = tuple(
            one._replace(lens=one.lens._replace(crop=crops and one.lens.crop))
            for one in self.cameras
        )

    def set_rate(self, rate: float) -> None:
        """Take pictures at this rate [Hz] from now on."""
        self._times = DueTimes(rate, 'imager_rate', self.world.clock.now_ns)
        self.count_readers()

    def trigger(self) -> None:
        """Take one picture in the next step, if it has readers."""
        self.triggered = self.readings.wanted
        self.count_readers()

    def unload(self) -> None:
        """Close the shutter."""
        self._capture.close()

    def measure(self) -> object:
        """Return a reading of the current scene.

        Raises:
            PluginError: the picture cannot be drawn.
        """
        try:
            self._request(Wants(depths=self.has_depth))
            taken: tuple[Picture, ...] = ()
            while self._capture.pending:  # earlier requests are answered first
                taken = self._capture.receive_image(wait=True) or taken
        except RenderError as error:
            raise PluginError(f'{self.called}: {error}') from None
        return self.reading(taken)

    def before_step(self) -> None:
        """Note whether a picture is due after physics; otherwise pending ones are polled."""
        self._takes = self.world.clock.steps >= self._picture_step
        super().before_step()

    def after_step(self) -> None:
        """Request a picture if due, and send the finished ones."""
        waits = not self.world.is_paced
        try:
            self._send_finished(waits)
            if self._takes:
                self._count_due()
            if self._takes and self._capture.is_free:
                self.triggered = None if self.triggered is None else False
                self._request(self._wants())
                self._send_finished(waits)
        except NoRendererError:
            pass
        except RenderError as error:
            if str(error) != self._complaint:
                self._complaint = str(error)
                self._report(str(error), logging.ERROR)
        self.count_readers()

    def count_readers(self) -> None:
        """Set the next due step: the next picture, or an earlier poll for a pending one."""
        super().count_readers()
        if self.triggered is not None and self.due != NEVER:
            self.due = self.world.clock.steps + 1 if self.triggered else NEVER
        self._picture_step = self.due
        if self.readings.wanted and self._capture.pending:
            self.due = min(self.due, self.world.clock.steps + POLL)

    def _report(self, what: str, severity: int = logging.WARNING, cure: str = '') -> None:
        what = f"model '{self.model.name}', {self.called}: {what}"
        self.world.faults.report(what, severity, cure=cure, **self.place)

    def _count_due(self) -> None:
        """Count a picture that is due; report once that drawing does not keep up."""
        reached = self._rate.count(self.world.clock.now_ns, self._capture.is_free)
        if reached is not None:
            what = 'pictures come at {:.3g} of {:.3g} Hz, as drawing them takes longer'
            cure = 'fewer pixels, a lower <update_rate> or a graphics card would help '
            self._report(what.format(*reached), cure=f'{cure}(doc/rendering.md)')

    def _wants(self) -> Wants:
        wanted = list(self._wanted.values())
        if self.readings.readers > len(wanted):
            wanted.append(Wants(depths=self.has_depth))
        return Wants(*map(any, zip(*wanted, strict=True)))

    def _request(self, wants: Wants) -> None:
        while not self._capture.is_free:
            self._capture.receive_image(wait=True)
        here = self.pose
        seed = int(self.random.at(self.world.clock.steps).integers(1 << 63))
        self._capture.request(
            [(self._noisy(one.lens), compose(here, one.pose)) for one in self.cameras], seed, wants
        )

    def _noisy(self, lens: Lens) -> Lens:
        return lens._replace(noise_stddev=self.noise_scale * lens.noise_stddev)

    def _send_finished(self, waits: bool) -> None:
        """Send finished pictures, except stale ones with future stamps from before a reset."""
        while (taken := self._capture.receive_image(waits)) is not None:
            if taken[0].stamp_ns <= self.world.clock.now_ns:
                self.send(self.reading(taken))

    def _camera(self, element: Element) -> SensedCamera:
        width = count(element, 'image/width', 320, MAX_IMAGE_SIZE)
        height = count(element, 'image/height', 240, MAX_IMAGE_SIZE)
        field = number(element, 'horizontal_fov', 1.047)
        near, far = number(element, 'clip/near', 0.1), number(element, 'clip/far', 100.0)
        if not 0.001 <= field <= math.pi - 0.001:
            raise PluginError(
                f'line {element.line}: <horizontal_fov> is {field:g} rad; a pinhole '
                'sees more than 0 and less than pi'
            )
        if not 0.0 < near < far:
            raise PluginError(
                f'line {element.line}: <near> is {near:g} m and <far> is {far:g} m; '
                'near must be above 0 and below far'
            )
        child = child_at(element, 'image/format')
        written = child.text.strip() if child is not None else 'R8G8B8'
        encoding = _ENCODINGS.get(written)
        if encoding is None:
            what = f"<format> '{written}' is unknown; pictures are in bgr8, as in Gazebo"
            self._report(what, logging.ERROR, cure='B8G8R8 and R8G8B8 are known')
            encoding = 'bgr8'
        k1, k2, k3, p1, p2 = (number(element, f'distortion/{name}', 0.0) for name in _DISTORTION)
        noise = read_noise(element.child('noise'))
        lens = Lens(
            width,
            height,
            field,
            near,
            far,
            encoding,
            (k1, k2, k3, p1, p2),
            _pair(child_at(element, 'distortion/center'), (0.5, 0.5)),
            k1 < 0.0,
            noise.mean,
            noise.deviation,
        )
        pose = element.child('pose')
        return SensedCamera(
            element.attributes.get('name', ''),
            Pose() if pose is None else _pose(pose),
            lens,
            encoding,
        )


@register_sensor('multicamera')
class MultiCameraSensor(CameraSensor):
    """Measures tuples of `Picture`s, one of each camera, all at the same time."""

    def _chosen(self, elements: list[Element]) -> list[Element]:
        return elements

    def reading(self, pictures: tuple[Picture, ...]) -> object:
        """Return the pictures of all cameras."""
        return pictures


@register_sensor('depth')
class DepthSensor(CameraSensor):
    """Measures `Picture`s with depths."""

    has_depth = True


def _numbers(element: Element, size: int) -> tuple[float, ...]:
    values = parse_numbers(element.text, size)
    if values is None:
        raise PluginError(
            f"line {element.line}: <{element.tag}> is '{element.text}'; it takes "
            f'{size} finite numbers'
        )
    return values


def _pair(element: Element | None, default: tuple[float, float]) -> tuple[float, float]:
    if element is None:
        return default
    x, y = _numbers(element, 2)
    return x, y


def _pose(element: Element) -> Pose:
    x, y, z, roll, pitch, yaw = _numbers(element, 6)
    return Pose((x, y, z), from_rpy(roll, pitch, yaw))
