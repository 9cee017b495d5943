"""Contact sensors: what the collisions of a link touch; and the plugin libgazebo_ros_bumper.so.

As in Gazebo there is a state for each pair of collisions and each physics step since the reading
before; forces and torques are in the axes of the first collision's link, positions and normals in
those of the world.
"""

import logging
from typing import NamedTuple

from ..core import Vector, add, conjugate, cross, rotate, subtract
from ..plugin_registry import register_in_sensor, register_sensor
from ..runtime import NEVER, CollisionFrame
from .base import Sensor, SensorPlugin

logger = logging.getLogger(__name__)


class ContactPoint(NamedTuple):
    """Where two collisions touch."""

    force: Vector  # on the body of the first one, in the axes of its link [N]
    torque: Vector  # about its centre of mass, in the same axes [N m]
    position: Vector  # in the world [m]
    normal: Vector  # from the second to the first, in the world
    depth: float  # of the overlap [m]


class ContactPair(NamedTuple):
    """What two collisions, by their scoped names, do to each other in one step."""

    first: str
    second: str
    time_ns: int  # at the end of the step
    points: tuple[ContactPoint, ...]


@register_sensor('contact')
class ContactSensor(Sensor):
    """Its readings are all touches since the reading before, in the order in which they were."""

    def load(self) -> None:
        """Read the names; one that the link does not have is told of, and nothing is touched."""
        contact = self.spec.element.child('contact')
        children = contact.children if contact is not None else ()
        names = [child.text for child in children if child.tag == 'collision']
        known = self.link.collisions
        self._names = {name.rpartition('::')[2] for name in names} & set(known)
        missing = [name for name in names if name.rpartition('::')[2] not in known]
        if missing or not names:
            said = f"names {', '.join(missing)} as <collision>" if missing \
                else 'names no <collision>'
            logger.warning("model '%s', %s: it %s; the collisions of '%s' are: %s", self.model.name,
                           self.called, said, self.link.name, ', '.join(known) or 'none')
        self._touches: list[ContactPair] = []
        self._next_ns = 0

    def reset(self) -> None:
        """Forget what was touched."""
        self._touches.clear()
        self._next_ns = self._times.after(self.world.clock.now_ns)

    def count_readers(self) -> None:
        """Look in each step while somebody reads."""
        slept = self.due == NEVER
        super().count_readers()
        if self.readings.wanted:
            self.due = self.world.clock.steps + 1
            if slept:
                self.reset()

    def after_step(self) -> None:
        """Take note of what is touched, and give a reading when one is due."""
        self._touches += self.measure()
        now_ns = self.world.clock.now_ns
        if now_ns >= self._next_ns:
            reading = tuple(self._touches)
            self.reset()
            self.give(reading)

    def measure(self) -> tuple[ContactPair, ...]:
        """Return what was touched in the last step."""
        pairs: dict[tuple[CollisionFrame, CollisionFrame], list[ContactPoint]] = {}
        for contact in self.world.engine.contacts(self.model.body, self.link.name):
            if contact.one.collision not in self._names:
                continue
            own, other = (self._collision(*name) for name in (contact.one, contact.other))
            normal, force = contact.normal, contact.force
            first, second = own, other
            if self._came_later(other):  # Gazebo's engine has the younger body first
                first, second = other, own
                normal, force = (subtract((0.0, 0.0, 0.0), v) for v in (normal, force))
            pairs.setdefault((first, second), []).append(
                _point(first, contact.position, normal, force, contact.depth))
        now_ns = self.world.clock.now_ns
        return tuple(ContactPair(first.scoped_name, second.scoped_name, now_ns, tuple(points))
                     for (first, second), points in pairs.items())

    def _collision(self, body: object, link: str, collision: str) -> CollisionFrame:
        model = next(one for one in self.world.models.values() if one.body is body)
        return model.links[link].collisions[collision]

    def _came_later(self, other: CollisionFrame) -> bool:
        models = list(self.world.models)
        return models.index(other.link.model.name) > models.index(self.model.name)


def _point(
    body: CollisionFrame, position: Vector, normal: Vector, force: Vector, depth: float
) -> ContactPoint:
    """Return a point with what acts there on the link that carries `body`."""
    pose, inertial = body.link.pose, body.link.spec.inertial
    centre = pose.position
    if inertial is not None:
        centre = add(centre, rotate(pose.orientation, inertial.pose.position))
    back = conjugate(pose.orientation)
    torque = cross(subtract(position, centre), force)
    return ContactPoint(rotate(back, force), rotate(back, torque), position, normal, depth)


@register_in_sensor('libgazebo_ros_bumper.so')
class BumperPlugin(SensorPlugin[tuple[ContactPair, ...]]):
    """Passes touches on, also where there are none. Output: `contacts`."""

    sensor_class = ContactSensor
    prefix = 'Bumper plugin (ns = {}) '

    def load(self) -> None:
        """Read the tags; <updateRate> means nothing, as upstream."""
        self.params.ignore('updateRate')
        self.params.read('bumperTopicName', 'bumper_states')
        self.params.read('frameName', 'world')
        self.contacts = self.output('contacts')

    def take(self, reading: tuple[ContactPair, ...]) -> None:
        """Send what was touched."""
        self.contacts.send(reading)
