"""The scene for windows that draw it themselves, such as gzweb; no cost without subscribers.

Publishes:
    ~view/scene (std_msgs/String): models, lights and settings as JSON; all of them for a new
        subscriber, then those that changed, within `PERIOD`.
    ~view/motion (std_msgs/Float64MultiArray): the clock [s], and the poses of the links that moved,
        every `PERIOD`.
"""

import time

import rospy
from std_msgs.msg import Float64MultiArray, String

from ...sim.runtime import ShownWorld
from ..messages import motion_message, scene_message
from ..server import Server
from .visuals import Viewers

PERIOD = 1.0 / 30.0  # between two updates [s, wall]


def advertise_scene(server: Server) -> None:
    """Advertise the scene and update it in wall time, also while paused."""
    shown = ShownWorld(server.world)
    scene = rospy.Publisher('~view/scene', String, Viewers(server, shown.reset), queue_size=100)
    motion = rospy.Publisher('~view/motion', Float64MultiArray, queue_size=1)
    started = time.monotonic()

    def show() -> None:
        if scene.get_num_connections() == 0:
            return
        change = shown.change()
        if change is not None:
            scene.publish(scene_message(change))
        if motion.get_num_connections() > 0:
            motion.publish(motion_message(shown.motion(time.monotonic() - started)))

    server.loop.every(PERIOD, show)
