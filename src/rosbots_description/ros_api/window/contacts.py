"""Contacts, while a browser shows them.

Subscribes:
    gazebo/view/contacts: between `open` and `close`.
"""

from collections.abc import Callable, Sequence

import rospy
from std_msgs.msg import Float64MultiArray

from ...sim.description import ShownContact
from ..messages import read_contacts


class RosContacts:
    """The contacts in the simulator `gazebo` of this node's namespace."""

    def __init__(self) -> None:
        self._subscriber: rospy.Subscriber | None = None

    def open(self, show: Callable[[Sequence[ShownContact]], None]) -> None:
        """Subscribe; the callback is called from a thread of its own."""
        self.close()
        self._subscriber = rospy.Subscriber(
            'gazebo/view/contacts',
            Float64MultiArray,
            lambda m: show(read_contacts(m)),
            queue_size=1,
            tcp_nodelay=True,
        )

    def close(self) -> None:
        """Unsubscribe: the simulator computes no contacts for this window any more."""
        if self._subscriber is not None:
            self._subscriber.unregister()
            self._subscriber = None
