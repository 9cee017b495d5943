"""Watch the simulator from its window, and show a notice when it is gone.

Publishes:
    gazebo/view/markers (visualization_msgs/MarkerArray, latched): the notice, once the simulator
        is gone; a new simulator clears the scene and shows its own markers.
"""

import socket
from collections.abc import Callable
from typing import TYPE_CHECKING
from urllib.parse import urlsplit

from rosgraph.names import make_caller_id, resolve_name

from ..transport import node_address

if TYPE_CHECKING:
    import rospy

TIMEOUT = 2.0  # for the simulator to take a connection [s, wall]
NOTICE = 'the simulator has gone'
NODE = 'gazebo'
MARKERS_TOPIC = 'gazebo/view/markers'


class ServerWatch:
    """Looks after the simulator; asks nothing of it but to take a connection."""

    def __init__(self, tell: Callable[[bool], None], node: str = NODE) -> None:
        """Begin to watch.

        Args:
            tell: called with False when a simulator that was there has gone, and with True when
                one is there again.
            node: the simulator's name, as in this program's namespace.
        """
        self._tell = tell
        self._node = resolve_name(node, make_caller_id('gzclient'))
        self._address: str | None = None  # where it was seen last
        self._there: bool | None = None  # None: it has not been seen yet

    def look(self) -> None:
        """Look once, and tell if it has changed."""
        there, before = self._is_there(), self._there
        if there == before or not (there or before):
            return
        self._there = there
        if before is not None:
            self._tell(there)

    def _is_there(self) -> bool:
        if self._address is not None and _takes_connections(self._address):
            return True
        # One that was killed is still in the master's table.
        self._address = node_address(self._node, '/gzclient')
        return self._address is not None and _takes_connections(self._address)


def _takes_connections(address: str) -> bool:
    place = urlsplit(address)
    try:
        socket.create_connection((place.hostname, place.port), TIMEOUT).close()
    except OSError:
        return False
    return True


class Notice:
    """A text in the scene, shown by a node that lives from the first time it is needed."""

    def __init__(self) -> None:
        self._publisher: rospy.Publisher | None = None

    def show(self) -> None:
        """Write that the simulator has gone where its models were."""
        import rospy  # a window seldom needs it
        from visualization_msgs.msg import MarkerArray

        from ..transport import init_node, is_node
        from ..views.markers import notice

        if not is_node():
            init_node('gzclient_notice', [], anonymous=True, disable_signals=True,
                      disable_rostime=True, disable_rosout=True)
        self._publisher = rospy.Publisher(MARKERS_TOPIC, MarkerArray, latch=True, queue_size=1)
        self._publisher.publish(MarkerArray([notice(NOTICE)]))

    def withdraw(self) -> None:
        """Leave the scene to the simulator that is there again."""
        if self._publisher is not None:
            self._publisher.unregister()
            self._publisher = None
