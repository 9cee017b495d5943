"""Pictures of the world by the simulator's own camera, for machines without a screen.

Publishes:
    ~view/image_raw (sensor_msgs/Image, rgb8): while someone subscribes, `RATE` times a second of
        wall time, also while paused. Each picture takes about 0.1 s, so it is for looking, not for
        sensing.
Parameters:
    ~view/eye, ~view/target (lists of three numbers) [m]: from where to where the camera looks.
"""

import rospy
from sensor_msgs.msg import Image

from ..sim.pose import Vector
from ..sim.view import EYE, TARGET, View
from .conversions import stamp
from .server import Server

RATE = 2.0  # pictures per second [Hz, wall]


def advertise_view(server: Server) -> None:
    """Offer pictures; nothing is drawn while nobody looks."""
    publisher = rospy.Publisher('~view/image_raw', Image, queue_size=1)
    view = View(server.world)

    def show() -> None:
        if publisher.get_num_connections() == 0:
            view.close()
            return
        pixels = view.picture(_point('~view/eye', EYE), _point('~view/target', TARGET))
        height, width, _ = pixels.shape
        image = Image(height=height, width=width, encoding='rgb8', step=3 * width)
        image.header.frame_id = 'world'
        image.header.stamp = stamp(server.world.clock.now_ns)
        image.data = pixels.tobytes()
        publisher.publish(image)

    server.loop.every(1.0 / RATE, show)


def _point(parameter: str, default: Vector) -> Vector:
    """Return a parameter's three numbers [m]; the default, with a warning, if it has others."""
    value = rospy.get_param(parameter, default)
    try:
        x, y, z = (float(number) for number in value)
    except (TypeError, ValueError):
        rospy.logwarn_throttle(
            10.0, '%s is %r; it takes three numbers in metres', rospy.resolve_name(parameter), value
        )
        return default
    return (x, y, z)
