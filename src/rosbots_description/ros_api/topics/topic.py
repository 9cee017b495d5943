"""Base class of topics published at simulation steps while they have subscribers."""

import rospy
from genpy import Message

from ...sim.runtime import NEVER, Listener
from ..server import Server
from ..transport import SubscriberWatch

QUEUE = 10  # messages that may wait for a slow subscriber, as upstream


class Topic(Listener):
    """A topic published at simulation steps; it costs nothing without subscribers."""

    def __init__(self, server: Server, name: str, message_class: type[Message]) -> None:
        self._world = server.world
        watch = SubscriberWatch(lambda: server.loop.post(self.schedule))
        self._publisher = rospy.Publisher(name, message_class, watch, queue_size=QUEUE)

    def schedule(self) -> None:
        """Publish from the next step on, if there are subscribers."""
        wanted = self._publisher.get_num_connections() > 0
        self.due = self._world.clock.steps + 1 if wanted else NEVER

    def world_reset(self) -> None:
        """Publish again at once, even if time jumped back."""
        self.schedule()
