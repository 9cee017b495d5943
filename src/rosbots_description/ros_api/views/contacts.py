"""The contacts in the world, for windows that show them; no cost without subscribers.

Publishes:
    ~view/contacts (std_msgs/Float64MultiArray): for each contact of the last step, every `PERIOD`,
        its position [m], its normal, and the force [N], in the world.
"""

import rospy
from std_msgs.msg import Float64MultiArray

from ...sim.description import ShownContact
from ..messages import contacts_message
from ..server import Server

PERIOD = 1.0 / 30.0  # between two updates [s, wall]


def advertise_contacts(server: Server) -> None:
    """Advertise the contacts and update them in wall time, also while paused."""
    topic = rospy.Publisher('~view/contacts', Float64MultiArray, queue_size=1)

    def show() -> None:
        if topic.get_num_connections() > 0:
            topic.publish(
                contacts_message(
                    ShownContact(one.position, one.normal, one.force)
                    for one in server.world.engine.contacts()
                )
            )

    server.loop.every(PERIOD, show)
