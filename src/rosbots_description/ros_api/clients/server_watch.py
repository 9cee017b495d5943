"""Monitors the simulator for gzclient, and shows a notice when it is gone.

Publishes:
    gazebo/view/markers (visualization_msgs/MarkerArray, latched): the notice, once the simulator
        is gone; a new simulator clears the scene and shows its own markers.
"""

from collections.abc import Callable

import rospy
from rosgraph.names import make_caller_id, resolve_name

from ..transport import accepts_connections, node_address

NOTICE = 'the simulator has ended'
NODE = 'gazebo'
MARKERS_TOPIC = 'gazebo/view/markers'


class ServerWatch:
    """Monitors the simulator by opening connections to it."""

    def __init__(self, report: Callable[[bool], None], node: str = NODE) -> None:
        """Start in the state unknown.

        Args:
            report: called with False when the simulator has ended, with True when it runs again.
            node: the simulator's name, relative to this program's namespace.
        """
        self._report = report
        self._node = resolve_name(node, make_caller_id('gzclient'))
        self._address: str | None = None  # last known XML-RPC address
        self._is_up: bool | None = None  # None: not seen yet

    def poll(self) -> None:
        """Poll once, and report a change."""
        is_up, before = self._is_reachable(), self._is_up
        if is_up == before or not (is_up or before):
            return
        self._is_up = is_up
        if before is not None:
            self._report(is_up)

    def _is_reachable(self) -> bool:
        if self._address is not None and accepts_connections(self._address):
            return True
        # A killed simulator is still registered with the master.
        self._address = node_address(self._node, '/gzclient')
        return self._address is not None and accepts_connections(self._address)


class Notice:
    """A text in the scene, published by a node that is started on demand."""

    def __init__(self) -> None:
        self._publisher: rospy.Publisher | None = None

    def show(self) -> None:
        """Show in the scene that the simulator has ended."""
        from visualization_msgs.msg import MarkerArray  # seldom needed, slow to import

        from ..transport import init_anonymous_node, is_node
        from ..views.markers import notice

        if not is_node():
            init_anonymous_node('gzclient_notice', [])
        self._publisher = rospy.Publisher(MARKERS_TOPIC, MarkerArray, latch=True, queue_size=1)
        self._publisher.publish(MarkerArray([notice(NOTICE)]))

    def withdraw(self) -> None:
        """Stop publishing; the simulator that is back clears the scene."""
        if self._publisher is not None:
            self._publisher.unregister()
            self._publisher = None
