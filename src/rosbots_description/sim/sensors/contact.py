"""Contact sensors, which report the contacts of a link's collisions, and libgazebo_ros_bumper.so.

As in Gazebo, a reading has a state for each pair of collisions and each physics step since the
previous reading. Forces and torques are in the axes of the first collision's link, positions and
normals in world axes.

Which collision of a pair comes first follows from ODE's hash space, in which Gazebo has a space for
each model (`dxHashSpace::collide`). Its level is that of the cells of 2^n metres that hold its
bounding box. A smaller model searches the cells of larger ones, so it comes first. What exceeds 2^8
m, as a plane does, comes last. Models of one level come in the order of ODE's list: static ones in
the order in which they were spawned, then moving ones from the newest on.
"""

import math
from collections.abc import Mapping
from functools import cache
from typing import NamedTuple

from ..core import Fault, Vector, add, conjugate, cross, report, rotate, subtract
from ..plugin_registry import register_in_sensor, register_sensor
from ..runtime import NEVER, CollisionFrame, Model
from .base import LogsDefaults, Sensor, SensorPlugin

_SMALLEST, _LARGEST = -2, 8  # levels of Gazebo's hash space


class ContactPoint(NamedTuple):
    """A contact point of two collisions."""

    force: Vector  # on the first collision's link, in its axes [N]
    torque: Vector  # about its centre of mass, in the same axes [N m]
    position: Vector  # in the world [m]
    normal: Vector  # from the second to the first, in the world
    depth: float  # of the penetration [m]


class ContactPair(NamedTuple):
    """The contact points of two collisions, given by scoped names, in one step."""

    first: str
    second: str
    time_ns: int  # at the end of the step
    points: tuple[ContactPoint, ...]


@register_sensor('contact')
class ContactSensor(Sensor):
    """Measures all contacts since the previous reading, in chronological order."""

    def load(self) -> None:
        """Read the collision names; warn of those that the link does not have."""
        contact = self.spec.element.child('contact')
        children = contact.children if contact is not None else ()
        names = [child.text for child in children if child.tag == 'collision']
        known = self.link.collisions
        self._names = {name.rpartition('::')[2] for name in names} & set(known)
        missing = [name for name in names if name.rpartition('::')[2] not in known]
        if missing or not names:
            said = (
                f'names {", ".join(missing)} as <collision>' if missing else 'names no <collision>'
            )
            what = f"model '{self.model.name}', {self.called}: it {said}; the collisions of "
            report(Fault(f"{what}'{self.link.name}' are: {', '.join(known) or 'none'}"))
        self._contacts: list[ContactPair] = []
        self._next_ns = 0

    def reset(self) -> None:
        """Discard recorded contacts."""
        self._contacts.clear()
        self._next_ns = self._times.after(self.world.clock.now_ns)

    def count_readers(self) -> None:
        """Be due at each step while there are readers."""
        slept = self.due == NEVER
        super().count_readers()
        if self.readings.wanted:
            self.due = self.world.clock.steps + 1
            if slept:
                self.reset()

    def after_step(self) -> None:
        """Record contacts, and send a reading when one is due."""
        self._contacts += self.measure()
        now_ns = self.world.clock.now_ns
        if now_ns >= self._next_ns:
            reading = tuple(self._contacts)
            self.reset()
            self.send(reading)

    def measure(self) -> tuple[ContactPair, ...]:
        """Return the contacts of the last step."""
        pairs: dict[tuple[CollisionFrame, CollisionFrame], list[ContactPoint]] = {}
        engine = self.world.engine
        contacts = [
            contact
            for contact in engine.contacts(self.model.body, self.link.name)
            if contact.one.collision in self._names
        ]
        if not contacts:
            return ()
        models = {model.body: model for model in self.world.models.values()}
        places = {model: place for place, model in enumerate(models.values())}

        @cache
        def rank(model: Model) -> tuple[float, bool, int]:
            place = places[model]
            return (
                _level(engine.extent(model.body)),
                not model.static,
                place if model.static else -place,
            )

        for contact in contacts:
            first, second = (
                models[body].links[link].collisions[collision]
                for body, link, collision in (contact.one, contact.other)
            )
            normal, force = contact.normal, contact.force
            if rank(second.link.model) < rank(first.link.model):
                first, second = second, first
                normal, force = (subtract((0.0, 0.0, 0.0), v) for v in (normal, force))
            pairs.setdefault((first, second), []).append(
                _point(first, contact.position, normal, force, contact.depth)
            )
        now_ns = self.world.clock.now_ns
        return tuple(
            ContactPair(first.scoped_name, second.scoped_name, now_ns, tuple(points))
            for (first, second), points in pairs.items()
        )


def _level(extent: float) -> float:
    """Return the level of a model of that size [m] in Gazebo's hash space."""
    if extent >= 2.0**_LARGEST:
        return math.inf
    return max(_SMALLEST, math.frexp(extent)[1])


def _point(
    body: CollisionFrame, position: Vector, normal: Vector, force: Vector, depth: float
) -> ContactPoint:
    """Return a contact point, with force and torque on the link of `body`."""
    pose, inertial = body.link.pose, body.link.spec.inertial
    centre = pose.position
    if inertial is not None:
        centre = add(centre, rotate(pose.orientation, inertial.pose.position))
    back = conjugate(pose.orientation)
    torque = cross(subtract(position, centre), force)
    return ContactPoint(rotate(back, force), rotate(back, torque), position, normal, depth)


@register_in_sensor('libgazebo_ros_bumper.so')
class BumperPlugin(LogsDefaults, SensorPlugin[tuple[ContactPair, ...]]):
    """Publishes contacts, empty readings included. Output: `contacts`."""

    sensor_class = ContactSensor
    topic_names: Mapping[str, str] = {'contacts': '<bumperTopicName>'}
    prefix = 'bumper plugin '

    def load(self) -> None:
        """Read the tags; <updateRate> is ignored, as upstream."""
        self.params.ignore('updateRate')
        self.params.read('bumperTopicName', 'bumper_states')
        self.params.read('frameName', 'world')
        self.contacts = self.output('contacts')

    def process(self, reading: tuple[ContactPair, ...]) -> None:
        """Send the contacts."""
        self.contacts.send(reading)
