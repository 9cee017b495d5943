"""The topic of contact sensors.

Publishes:
    <ns>/<bumperTopicName> (gazebo_msgs/ContactsState): bumper; <frameName> only labels it.
Parameters:
    tf_prefix, searched from the plugin's namespace upward.
"""

from collections.abc import Sequence
from functools import reduce

from gazebo_msgs.msg import ContactsState, ContactState
from geometry_msgs.msg import Vector3, Wrench

from ...sim.core import NANOSECONDS, Vector, add
from ...sim.sensors import BumperPlugin, ContactPair
from .declarations import Publishes
from .registry import declare_topics


def contacts_message(touches: Sequence[ContactPair]) -> ContactsState:
    """Return the message of what was touched since the one before."""
    return ContactsState(
        states=[_state(touch, f'{i}/{len(touches)}') for i, touch in enumerate(touches)]
    )


def _state(touch: ContactPair, place: str) -> ContactState:
    points = touch.points
    info = (
        f'Debug:  i:({place})     my geom:{touch.first}   other geom:{touch.second}'
        f'         time:{touch.time_ns / NANOSECONDS:.9f}\n'
    )
    return ContactState(
        info,
        touch.first,
        touch.second,
        [_wrench(point.force, point.torque) for point in points],
        _wrench(
            reduce(add, (point.force for point in points)),
            reduce(add, (point.torque for point in points)),
        ),
        [Vector3(*point.position) for point in points],
        [Vector3(*point.normal) for point in points],
        [point.depth for point in points],
    )


def _wrench(force: Vector, torque: Vector) -> Wrench:
    return Wrench(Vector3(*force), Vector3(*torque))


declare_topics(
    BumperPlugin,
    Publishes('contacts', ContactsState, convert=contacts_message, frame='<frameName>'),
)
