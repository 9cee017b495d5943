"""What the topics with a place in simulated time share: they are due while somebody reads them."""

import rospy
from genpy import Message

from ...sim.runtime import NEVER, Model
from ..server import Server

QUEUE = 10  # messages that may wait for a slow subscriber, as upstream


class _Subscribers(rospy.SubscribeListener):
    """Tells a topic, on the world's thread, when subscribers come and go."""

    def __init__(self, server: Server, topic: 'Topic') -> None:
        self._server = server
        self._topic = topic

    def peer_subscribe(self, _topic: str, _publish: object, _peer_publish: object) -> None:
        """Take note of a new subscriber."""
        self._server.loop.post(self._topic.schedule)

    def peer_unsubscribe(self, _topic: str, _count: int) -> None:
        """Take note of one less."""
        self._server.loop.post(self._topic.schedule)


class Topic:
    """A topic with a place in time; it costs nothing while nobody subscribes."""

    def __init__(self, server: Server, name: str, message_class: type[Message]) -> None:
        self._world = server.world
        self._publisher = rospy.Publisher(
            name, message_class, _Subscribers(server, self), queue_size=QUEUE
        )

    def schedule(self) -> None:
        """Publish from the next step on, if there is anyone to read it."""
        wanted = self._publisher.get_num_connections() > 0
        self.due = self._world.clock.steps + 1 if wanted else NEVER

    # What the world tells its listeners.

    def world_reset(self) -> None:
        """Publish again at once, also when time jumped back."""
        self.schedule()

    def model_spawned(self, model: Model) -> None:
        """Nothing changes for a topic as such."""

    def model_deleted(self, model: Model) -> None:
        """Nothing changes for a topic as such."""
