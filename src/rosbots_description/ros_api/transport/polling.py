"""Closes the descriptor by which a topic watches its connections when the topic is closed.

Each topic of rospy has an epoll instance, which rospy never closes. It is in a cycle of references,
and so in use until Python's garbage collector runs: a node that spawns and deletes robots has
hundreds of them.
"""

import select
import threading
from collections.abc import Callable
from functools import wraps

import rospy.topics

_LOST = select.EPOLLHUP | select.EPOLLERR | select.EPOLLRDHUP


class ConnectionPoller:
    """Finds lost connections, in place of rospy's Poller; thread-safe."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._epoll = select.epoll()

    def add_fd(self, descriptor: int) -> None:
        """Watch a connection."""
        with self._lock:
            if not self._epoll.closed:
                self._epoll.register(descriptor, _LOST)

    def remove_fd(self, descriptor: int) -> None:
        """Watch a connection no more."""
        with self._lock:
            if not self._epoll.closed:
                self._epoll.unregister(descriptor)

    def error_iter(self) -> list[int]:
        """Return the descriptors of lost connections."""
        with self._lock:
            found = [] if self._epoll.closed else self._epoll.poll(0)
        return [descriptor for descriptor, event in found if event & _LOST]

    def close(self) -> None:
        """Close its own descriptor; from now on no connection is lost."""
        with self._lock:
            self._epoll.close()


def close_pollers() -> None:
    """Close the poller of each topic with it; call once before `init_node`.

    rospy has no public API for this.
    """
    rospy.topics.Poller = ConnectionPoller
    rospy.topics._TopicImpl.close = _and_its_poller(rospy.topics._TopicImpl.close)


def _and_its_poller(
    close: Callable[[rospy.topics._TopicImpl], None],
) -> Callable[[rospy.topics._TopicImpl], None]:
    @wraps(close)
    def close_both(topic: rospy.topics._TopicImpl) -> None:
        close(topic)
        topic.connection_poll.close()

    return close_both
