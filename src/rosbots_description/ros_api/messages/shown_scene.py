"""What a window shows, to ROS messages and back: JSON for the scene, numbers for the motion.

A window is of the same version as its simulator, so nothing is checked.
"""

import json
from collections.abc import Iterable
from dataclasses import fields
from functools import cache
from typing import TYPE_CHECKING, Any, get_args, get_type_hints

from std_msgs.msg import Float64MultiArray, String

from ...sim import description
from ...sim.core import Pose
from ...sim.description import SceneChange, ShownContact, ShownMotion

if TYPE_CHECKING:
    from _typeshed import DataclassInstance

_CLOCK, _LINK = 4, 8  # numbers of the clock, and of each link
_CLASS = 'class'  # of an object in JSON


def scene_message(change: SceneChange) -> String:
    """Return a change of the scene as JSON."""
    return String(json.dumps(change, default=_write))


def scene_change(message: String) -> SceneChange:
    """Return the change that `scene_message` was made of."""
    change: SceneChange = json.loads(message.data, object_hook=_read)
    return change


def motion_message(motion: ShownMotion) -> Float64MultiArray:
    """Return a motion as numbers: the clock, then number, position, quaternion of each link."""
    data = [motion.time, motion.real_time, float(motion.iterations), float(motion.paused)]
    for number, pose in motion.poses.items():
        data += (number, *pose.position, *pose.orientation)
    return Float64MultiArray(data=data)


def read_motion(message: Float64MultiArray) -> ShownMotion:
    """Return the motion that `motion_message` was made of."""
    time, real_time, iterations, paused = message.data[:_CLOCK]
    poses = {}
    for start in range(_CLOCK, len(message.data), _LINK):
        number, x, y, z, qx, qy, qz, qw = message.data[start : start + _LINK]
        poses[int(number)] = Pose((x, y, z), (qx, qy, qz, qw))
    return ShownMotion(time, real_time, int(iterations), bool(paused), poses)


def contacts_message(contacts: Iterable[ShownContact]) -> Float64MultiArray:
    """Return contacts as numbers: position, normal and force of each."""
    return Float64MultiArray(
        data=[number for one in contacts for number in (*one.position, *one.normal, *one.force)]
    )


def read_contacts(message: Float64MultiArray) -> list[ShownContact]:
    """Return the contacts that `contacts_message` was made of."""
    vectors = zip(*[iter(message.data)] * 3, strict=True)
    return [ShownContact(*one) for one in zip(*[vectors] * 3, strict=True)]


def _write(value: 'DataclassInstance') -> dict[str, Any]:
    """Return the fields of a description, and its class."""
    return {_CLASS: type(value).__name__} | {
        field.name: getattr(value, field.name) for field in fields(value)
    }


def _read(values: dict[str, Any]) -> object:
    """Return what `_write` was given; a mapping names no class."""
    name = values.get(_CLASS)
    if not isinstance(name, str):
        return values
    kind = getattr(description, name)
    poses = _poses(kind)
    return kind(
        **{
            field: Pose(*map(tuple, value))
            if field in poses and value is not None
            else _tuples(value)
            for field, value in values.items()
            if field != _CLASS
        }
    )


@cache
def _poses(kind: type) -> set[str]:
    """Return which fields of a class are poses, as JSON knows no named tuples."""
    return {
        field for field, hint in get_type_hints(kind).items() if Pose in (hint, *get_args(hint))
    }


def _tuples(value: object) -> object:
    """Return a value as it is, but lists as tuples."""
    return tuple(map(_tuples, value)) if isinstance(value, list) else value
