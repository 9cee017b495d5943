"""The topics of the server itself: time and states, published from the step they belong to.

Publishes:
    /clock (rosgraph_msgs/Clock): simulated time, every step or at ~pub_clock_frequency [Hz].
    ~link_states (gazebo_msgs/LinkStates): every step while subscribed.
    ~model_states (gazebo_msgs/ModelStates): every step while subscribed.
"""

import contextlib
import logging
from collections.abc import Iterable, Iterator

import numpy as np
import rospy
from gazebo_msgs.msg import LinkStates, ModelStates
from genpy import Message
from geometry_msgs.msg import Pose, Twist
from rosgraph_msgs.msg import Clock

from ...sim.core import NANOSECONDS
from ...sim.runtime import NEVER, Hook, Link, Model, PreRunPublisher
from ..messages import fill_pose, fill_twist
from ..server import Server
from ..transport import publish_serialized

logger = logging.getLogger(__name__)

# /clock on the wire; `size` is that of what follows [bytes].
_CLOCK = np.dtype([('size', '<u4'), ('secs', '<u4'), ('nsecs', '<u4')])
_CLOCK_SIZE = 8
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


class ClockTopic(Topic, PreRunPublisher):
    """/clock, at every step or, with a frequency, at the first step a period after the last one."""

    def __init__(self, server: Server, frequency: int) -> None:
        super().__init__(server, '/clock', Clock)
        self._period_ns = NANOSECONDS // frequency if frequency > 0 else 0
        self._last_ns = 0

    def publish_ahead(self, last: int) -> None:
        """Publish the times of all steps that want it, up to `last`."""
        clock, due = self._world.clock, np.arange(self.due, last + 1)
        if self._period_ns:
            due = np.fromiter(self._due_until(last), np.int64)
        # of all at once: one by one takes 1 us each
        times = clock.ns_at(0) + due * clock.step_ns
        messages = np.empty(len(times), _CLOCK)
        messages['size'] = _CLOCK_SIZE
        messages['secs'], messages['nsecs'] = np.divmod(times, NANOSECONDS)
        publish_serialized(self._publisher, messages.tobytes())
        self._last_ns = int(times[-1])
        self.due = self._first_after(int(due[-1]))

    def _due_until(self, last: int) -> Iterator[int]:
        """Yield the steps that are a period apart."""
        step = self.due
        while step <= last:
            yield step
            self._last_ns = self._world.clock.ns_at(step)
            step = self._first_after(step)

    def schedule(self) -> None:
        """Publish when the period has passed, if there is anyone to read it."""
        super().schedule()
        clock = self._world.clock
        # Time that jumped back counts as never published: upstream would stay silent for long.
        self._last_ns = self._last_ns if self._last_ns <= clock.now_ns else 0
        if self.due != NEVER:
            self.due = self._first_after(clock.steps)

    def _first_after(self, step: int) -> int:
        """Return the first step after `step` that is a period after the last one told of."""
        clock = self._world.clock
        if not self._period_ns:
            return step + 1
        return max(step + 1, clock.first_step_after(self._last_ns + self._period_ns - 1))


class StatesTopic(Topic, Hook):
    """Names, world poses and world velocities of models or links, in the step they belong to."""

    def __init__(self, server: Server, name: str, message: Message) -> None:
        super().__init__(server, name, type(message))
        self._message = message

    def before_step(self) -> None:
        """Publish, and come again at the next step."""
        self.fill()
        self._publisher.publish(self._message)
        self.schedule()

    def entities(self) -> Iterable[Model | Link]:
        """Return what is to be listed, in order."""
        raise NotImplementedError

    def fill(self) -> None:
        """Write the present states; message parts are made once and used again."""
        message = self._message
        entities = list(self.entities())
        message.name = [entity.scoped_name for entity in entities]
        while len(message.pose) < len(entities):
            message.pose.append(Pose())
            message.twist.append(Twist())
        del message.pose[len(entities):], message.twist[len(entities):]
        for entity, pose_message, twist_message in zip(
            entities, message.pose, message.twist, strict=True
        ):
            pose, twist = entity.state()
            fill_pose(pose_message, pose)
            fill_twist(twist_message, twist)


class LinkStatesTopic(StatesTopic):
    """Every link of every model, by scoped name; as in Gazebo not those of models within."""

    def __init__(self, server: Server) -> None:
        super().__init__(server, '~link_states', LinkStates())

    def entities(self) -> Iterable[Link]:
        """Return all links, model by model in world order."""
        return (
            link
            for model in self._world.models.values()
            for link in model.links.values()
            if '::' not in link.name
        )


class ModelStatesTopic(StatesTopic):
    """Every model, by its name."""

    def __init__(self, server: Server) -> None:
        super().__init__(server, '~model_states', ModelStates())

    def entities(self) -> Iterable[Model]:
        """Return all models in world order."""
        return self._world.models.values()


def advertise_clock(server: Server) -> None:
    """Publish /clock, before anything that happens at the time it tells."""
    topic = ClockTopic(server, clock_frequency(rospy.get_param('~pub_clock_frequency', 0)))
    server.world.schedule.add_pre_run_publisher(topic)
    server.world.listeners.append(topic)
    topic.schedule()


def clock_frequency(value: object) -> int:
    """Return the parameter's value [Hz]; 0, every step, if it is no whole number, with an error."""
    with contextlib.suppress(ValueError, OverflowError):
        if isinstance(value, int | float | str) and int(value) == float(value):
            return int(value)
    logger.error('~pub_clock_frequency is %r; it must be a whole number [Hz]. 0 is used', value)
    return 0


def advertise_states(server: Server) -> None:
    """Publish link and model states, after the clock and before any plugin."""
    for topic in (LinkStatesTopic(server), ModelStatesTopic(server)):
        server.world.schedule.add(topic)
        server.world.listeners.append(topic)
        topic.schedule()
