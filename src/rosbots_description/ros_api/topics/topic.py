"""Base class of topics published at simulation steps while they have subscribers."""

import rospy
from genpy import Message

from ...sim.runtime import NEVER, Listener
from ..server import Server

QUEUE = 10  # messages that may wait for a slow subscriber, as upstream


class _Subscribers(rospy.SubscribeListener):  # type: ignore[misc]  # rospy has no types
    """Reschedules a topic, on the world's thread, when its subscribers change."""

    def __init__(self, server: Server, topic: 'Topic') -> None:
        self._server = server
        self._topic = topic

    def peer_subscribe(self, _topic: str, _publish: object, _peer_publish: object) -> None:
        """Handle a new subscriber."""
        self._server.loop.post(self._topic.schedule)

    def peer_unsubscribe(self, _topic: str, _count: int) -> None:
        """Handle the loss of a subscriber."""
        self._server.loop.post(self._topic.schedule)


class Topic(Listener):
    """A topic published at simulation steps; it costs nothing without subscribers."""

    def __init__(self, server: Server, name: str, message_class: type[Message]) -> None:
        self._world = server.world
        self._publisher = rospy.Publisher(
            name, message_class, _Subscribers(server, self), queue_size=QUEUE
        )

    def schedule(self) -> None:
        """Publish from the next step on, if there are subscribers."""
        wanted = self._publisher.get_num_connections() > 0
        self.due = self._world.clock.steps + 1 if wanted else NEVER

    def world_reset(self) -> None:
        """Publish again at once, even if time jumped back."""
        self.schedule()
