"""Overview pictures of the world, for machines without a screen.

Publishes:
    ~view/image_raw (sensor_msgs/Image, rgb8): while subscribed, at `RATE` in wall time, also while
        paused. It is drawn as those of camera sensors, which are for perception.
Parameters:
    ~view/eye, ~view/target (lists of three numbers) [m, world]: position and target of the camera;
        read before the first picture, then with each picture, for the next one.
"""

import contextlib
import logging
import math

import rospy
from sensor_msgs.msg import Image

from ...sim.core import Vector
from ...sim.rendering import (
    EYE,
    OVERVIEW,
    TARGET,
    ImageCapture,
    NoRendererError,
    RenderError,
    Wants,
    look_at,
)
from ..messages import RequestError, stamp
from ..server import Server
from ..transport import Registrar

logger = logging.getLogger(__name__)

RATE = 2.0  # of pictures [Hz, wall]
POLL = 0.05  # between two looks for a finished one [s, wall]


def advertise_view(server: Server) -> None:
    """Advertise pictures; they are drawn only while there are subscribers."""
    publisher = rospy.Publisher('~view/image_raw', Image, queue_size=1)
    capture = ImageCapture(server.world)
    viewpoint = Viewpoint()
    viewpoint.read()  # names invalid values at the start
    viewpoint.rest()  # they are read again for the first subscriber

    def request() -> None:
        if publisher.get_num_connections() == 0:
            viewpoint.rest()
            return
        viewpoint.read_soon(server.registrar)
        if viewpoint.ready and not capture.pending:
            with contextlib.suppress(NoRendererError):  # the log says why
                capture.request([(OVERVIEW, look_at(*viewpoint.sight))], 0, Wants())

    def publish() -> None:
        try:
            taken = capture.receive_image(wait=False)
        except RenderError as error:
            logger.error('~view: %s', error)
            return
        if taken is not None and taken[0].pixels is not None:
            height, width, _ = taken[0].pixels.shape
            image = Image(height=height, width=width, encoding='rgb8', step=3 * width)
            image.header.frame_id = 'world'
            image.header.stamp = stamp(taken[0].stamp_ns)
            image.data = taken[0].pixels.tobytes()
            publisher.publish(image)

    server.loop.every(1.0 / RATE, request)
    server.loop.every(POLL, publish)


class Viewpoint:
    """Caches the parameters, so that no picture waits for the ROS master.

    `ready` tells whether they were read since the first subscriber connected.
    """

    def __init__(self) -> None:
        self.ready = False
        self.sight: tuple[Vector, Vector] = (EYE, TARGET)  # eye and target [m, world]
        self._asked = False
        self._complaint = ''  # logged once, not with every picture

    def rest(self) -> None:
        """Note that there are no subscribers."""
        self.ready = False

    def read_soon(self, registrar: Registrar) -> None:
        """Let the registrar's thread read the parameters, unless already queued."""
        if not self._asked:
            self._asked = True
            registrar.post(self.read)

    def read(self) -> None:
        """Read the parameters, on a thread that may block; log and ignore invalid values."""
        try:
            values = [rospy.get_param('~view/eye', EYE), rospy.get_param('~view/target', TARGET)]
            self.sight = line_of_sight(*values)
        except OSError:
            pass  # there is no master now, which `watch_master` logs
        except RequestError as error:
            if str(error) != self._complaint:
                self._complaint = str(error)
                logger.warning('parameters of ~view: %s', error)
        else:
            self._complaint = ''
        finally:
            self._asked = False
            self.ready = True


def line_of_sight(eye: object, target: object) -> tuple[Vector, Vector]:
    """Return eye and target [m] from the values of the parameters.

    Raises:
        RequestError: one is not a list of three finite numbers, or both are the same point.

    """
    sight = _point('eye', eye), _point('target', target)
    if sight[0] == sight[1]:
        raise RequestError(f'eye and target are both {list(sight[0])}; they must differ')
    return sight


def _point(name: str, value: object) -> Vector:
    numbers = value if isinstance(value, list | tuple) else ()
    if len(numbers) != 3 or not all(
        isinstance(number, int | float) and math.isfinite(number) for number in numbers
    ):
        raise RequestError(f'{name} is {value!r}; it must be a list of three finite numbers [m]')
    x, y, z = map(float, numbers)
    return (x, y, z)
