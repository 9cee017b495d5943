"""The topics of link and model states, published within the step they belong to.

Publishes:
    ~link_states (gazebo_msgs/LinkStates): every step while subscribed.
    ~model_states (gazebo_msgs/ModelStates): every step while subscribed.
"""

from collections.abc import Callable, Iterable

from gazebo_msgs.msg import LinkStates, ModelStates
from genpy import Message
from geometry_msgs.msg import Pose, Twist

from ...sim.runtime import Hook, Link, Model
from ..messages import fill_pose, fill_twist
from ..server import Server
from .topic import Topic


class StatesTopic(Topic, Hook):
    """Names, poses and twists of models or links in the world frame, in each step."""

    def __init__(
        self,
        server: Server,
        name: str,
        message: Message,
        entities: Callable[[], Iterable[Model | Link]],
    ) -> None:
        """Advertise the topic; `entities` returns the models or links to list, in order."""
        super().__init__(server, name, type(message))
        self._message, self._entities = message, entities

    def before_step(self) -> None:
        """Publish, and schedule the next step."""
        self.fill()
        self._publisher.publish(self._message)
        self.schedule()

    def fill(self) -> None:
        """Fill in the current states; message objects are reused."""
        message = self._message
        entities = list(self._entities())
        message.name = [entity.scoped_name for entity in entities]
        while len(message.pose) < len(entities):
            message.pose.append(Pose())
            message.twist.append(Twist())
        del message.pose[len(entities) :], message.twist[len(entities) :]
        for entity, pose_message, twist_message in zip(
            entities, message.pose, message.twist, strict=True
        ):
            pose, twist = entity.state()
            fill_pose(pose_message, pose)
            fill_twist(twist_message, twist)


def advertise_states(server: Server) -> None:
    """Publish link and model states, after the clock and before any plugin."""
    models = server.world.models

    def links() -> Iterable[Link]:
        """Return all links, model by model; as in Gazebo without those of nested models."""
        return (
            link
            for model in models.values()
            for link in model.links.values()
            if '::' not in link.name
        )

    for topic in (
        StatesTopic(server, '~link_states', LinkStates(), links),
        StatesTopic(server, '~model_states', ModelStates(), models.values),
    ):
        server.world.schedule.add(topic)
        server.world.listeners.append(topic)
        topic.schedule()
