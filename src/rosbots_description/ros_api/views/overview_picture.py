"""Overview pictures of the world by the simulator's own camera, for machines without a screen.

Publishes:
    ~view/image_raw (sensor_msgs/Image, rgb8): while someone subscribes, `RATE` times a second of
        wall time, also while paused. Each picture takes about 0.1 s, so it is for looking, not for
        sensing.
Parameters:
    ~view/eye, ~view/target (lists of three numbers) [m]: from where to where the camera looks;
        what is set before someone looks counts for the first picture; they are read again with
        each picture, and what is read then counts from the next one on.
"""

import logging
import math

import rospy
from sensor_msgs.msg import Image

from ...sim.core import Vector
from ...sim.rendering import EYE, TARGET, View
from ..messages import RequestError, stamp
from ..server import Server
from ..transport import Registrar

logger = logging.getLogger(__name__)

RATE = 2.0  # pictures per second [Hz, wall]


def advertise_view(server: Server) -> None:
    """Offer pictures; nothing is drawn while nobody looks."""
    publisher = rospy.Publisher('~view/image_raw', Image, queue_size=1)
    view = View(server.world)
    viewpoint = Viewpoint()
    viewpoint.read()

    def show() -> None:
        if publisher.get_num_connections() == 0:
            view.close()
            viewpoint.rest()
            return
        viewpoint.read_soon(server.registrar)
        if not viewpoint.ready:
            return
        pixels = view.picture(*viewpoint.sight)
        height, width, _ = pixels.shape
        image = Image(height=height, width=width, encoding='rgb8', step=3 * width)
        image.header.frame_id = 'world'
        image.header.stamp = stamp(server.world.clock.now_ns)
        image.data = pixels.tobytes()
        publisher.publish(image)

    server.loop.every(1.0 / RATE, show)


class Viewpoint:
    """Keeps what the parameters said last, so that no picture waits for the ROS master.

    `ready` tells whether they have been asked since someone began to look.
    """

    def __init__(self) -> None:
        self.ready = False
        self.sight: tuple[Vector, Vector] = (EYE, TARGET)  # eye and target [m, world]
        self._asked = False
        self._complaint = ''  # said once, not with every picture

    def rest(self) -> None:
        """Take note that nobody looks."""
        self.ready = False

    def read_soon(self, registrar: Registrar) -> None:
        """Let the registrar's thread read the parameters, unless it is about to."""
        if not self._asked:
            self._asked = True
            registrar.post(self.read)

    def read(self) -> None:
        """Ask the ROS master, on a thread that may wait; bad values are told and not used."""
        try:
            values = [rospy.get_param('~view/eye', EYE), rospy.get_param('~view/target', TARGET)]
            self.sight = line_of_sight(*values)
        except OSError:
            pass  # there is no master now, which `watch_master` tells
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
    """Return eye and target [m] as parameters give them.

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
