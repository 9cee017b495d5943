"""Invariants of every loaded model, and of every error message."""

import math
from collections.abc import Iterator, Mapping
from dataclasses import fields, is_dataclass, replace
from typing import Any

import numpy as np

from rosbots_description.sim.description.model_spec import ModelSpec
from rosbots_description.sim.physics.bullet.generated_urdf import kinematic_trees

LONGEST_SENTENCE = 2000  # characters; a name may have 1000, and the location is given


def numbers_in(value: Any) -> Iterator[float]:
    """Yield every float in nested dataclasses, mappings and sequences."""
    if isinstance(value, float):
        yield value
    elif is_dataclass(value):
        for field in fields(value):
            yield from numbers_in(getattr(value, field.name))
    elif isinstance(value, Mapping):
        for item in value.values():
            yield from numbers_in(item)
    elif isinstance(value, tuple | list):
        for item in value:
            yield from numbers_in(item)


def check_spec(spec: ModelSpec) -> None:
    """Assert that numbers are finite, names unique, and every link is in exactly one tree."""
    assert all(map(math.isfinite, numbers_in(replace(spec, control=None))))
    assert not any(map(math.isnan, numbers_in(spec.control)))  # limits are infinite without one
    names = [link.name for link in spec.links]
    assert names
    assert len(set(names)) == len(names)
    joints = [joint.name for joint in spec.joints]
    assert len(set(joints)) == len(joints)
    for link in spec.links:
        for shapes in (link.collisions, link.visuals):
            assert len({shape.name for shape in shapes}) == len(shapes)
    for joint in spec.joints:
        assert joint.child in names
        assert joint.parent in (*names, 'world')
    reached = [
        link.name
        for tree in kinematic_trees(spec)
        for link in tree.links
        if not link.name.startswith('world of ')
    ]
    assert sorted(reached) == sorted(names)


def check_sentence(error: Exception) -> None:
    """Assert that an error message is one readable line."""
    sentence = str(error)
    assert sentence.strip()
    assert sentence.isprintable(), f'not a printable line: {sentence[:300]!r}'
    assert len(sentence) <= LONGEST_SENTENCE, f'{len(sentence)} characters: {sentence[:300]}'


def total(spec: ModelSpec) -> tuple[float, np.ndarray]:
    """Return mass [kg] and centre of mass [m, model frame] with all joints at zero."""
    mass, moment = 0.0, np.zeros(3)
    for link in spec.links:
        mass += link.inertial.mass
        x, y, z, w = link.pose.orientation
        turn = np.array(
            [
                [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
            ]
        )
        place = turn @ link.inertial.pose.position + link.pose.position
        moment = moment + link.inertial.mass * place
    return mass, moment / mass
