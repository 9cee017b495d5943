"""Read values from child elements of SDF; a missing or empty one has SDF's default."""

import math

from lxml import etree

from ...core import IDENTITY, Pose, Vector, as_vector, fault
from ...core import normalise as normalise_quaternion
from ...description import Colour
from ..xml import (
    boolean,
    is_endless,
    require_damping,
    require_near,
    require_size,
    scalar,
    scalar_numbers,
    tag_of,
)
from .exact import QUATERNION, is_unit, orientation

# SDF writes "no limit" as 1e16; simulated values stay far below this [rad, m, N, N m].
_ENDLESS = 1e15


def text_of(parent: etree._Element, path: str, default: str = '') -> str:
    """Return the text of the element at `path` below `parent`, without surrounding blanks."""
    element = parent.find(path)
    return default if element is None else scalar(element) or default


def numbers_of(parent: etree._Element, path: str, default: tuple[float, ...]) -> tuple[float, ...]:
    """Return as many finite numbers as `default` has.

    Raises:
        ModelError: the text is anything else.
    """
    element = parent.find(path)
    if element is None or not scalar(element):
        return default
    return scalar_numbers(element, len(default))


def vector_of(parent: etree._Element, path: str, default: Vector) -> Vector:
    """Return three finite numbers, as `numbers_of` does."""
    return as_vector(numbers_of(parent, path, default))


def number_of(parent: etree._Element, path: str, default: float) -> float:
    """Return one finite number, as `numbers_of` does."""
    return numbers_of(parent, path, (default,))[0]


def not_negative_of(parent: etree._Element, path: str, default: float) -> float:
    """Return one finite number that is zero or more."""
    value = number_of(parent, path, default)
    element = parent.find(path)
    if element is not None and value < 0.0:
        raise fault(element, f'<{tag_of(element)}> is {value:g}; it must not be negative')
    return value


def sizes_of(parent: etree._Element, path: str, count: int = 1) -> tuple[float, ...]:
    """Return lengths greater than zero [m]; the element must be there.

    Raises:
        ShapeError: one is zero, so there is no shape.
        ModelError: one is missing, negative or not a number.
    """
    element = parent.find(path)
    if element is None:
        raise fault(parent, f'<{tag_of(parent)}> has no <{path}> [m]')
    values = scalar_numbers(element, count)
    require_size(element, f"<{path}> '{scalar(element)}' of <{tag_of(parent)}>", values)
    require_near(element, 'the size', values)
    return values


def limit_of(parent: etree._Element, path: str) -> float | None:
    """Return a limit, or None if the number means no limit (1e16, inf, ...)."""
    element = parent.find(path)
    if element is None or not scalar(element):
        return None
    if is_endless(element):
        return None
    value = scalar_numbers(element, 1)[0]
    return value if abs(value) < _ENDLESS else None


def boolean_of(parent: etree._Element, path: str, default: bool = False) -> bool:
    """Tell whether the text is true, yes or 1; `default` if it is empty."""
    element = parent.find(path)
    return default if element is None or not scalar(element) else boolean(element)


def colour_of(parent: etree._Element, path: str) -> Colour | None:
    """Return red, green, blue, alpha, each clamped to 0..1; None if there is no colour."""
    element = parent.find(path)
    if element is None or not scalar(element):
        return None
    count = 3 if len(scalar(element).split()) == 3 else 4
    rgba = (*scalar_numbers(element, count), 1.0)[:4]
    red, green, blue, alpha = (min(1.0, max(0.0, value)) for value in rgba)
    return (red, green, blue, alpha)


def damping_of(parent: etree._Element, path: str) -> float:
    """Return the velocity damping of a link, 0 by default."""
    value = number_of(parent, path, 0.0)
    element = parent.find(path)
    if element is not None:
        require_damping(element, value)
    return value


def unit_vector_of(parent: etree._Element, path: str, default: Vector) -> Vector:
    """Return a direction of length 1.

    Raises:
        ModelError: all three numbers are zero.
    """
    vector = numbers_of(parent, path, default)
    largest = max(abs(x) for x in vector)
    element = parent.find(path)
    if element is not None and largest == 0.0:
        raise fault(element, f'<{path}> has no direction; its numbers must not all be zero')
    if is_unit(vector):
        return as_vector(vector)  # as it was written, to the last bit
    # Scale first, so that no square underflows or overflows.
    x, y, z = (x / largest for x in vector)
    length = math.sqrt(x * x + y * y + z * z)
    return (x / length, y / length, z / length)


def pose_in(element: etree._Element | None) -> Pose:
    """Return the pose of a <pose>, "x y z roll pitch yaw" [m, rad]; the identity if there is none.

    Degrees and quaternions (x, y, z, w) of SDF 1.9 are read, too.
    """
    if element is None or not scalar(element):
        return IDENTITY
    if element.get('rotation_format') == 'quat_xyzw':
        *position, x, y, z, w = scalar_numbers(element, 7)
        require_near(element, 'the position', position)
        return Pose(as_vector(position), normalise_quaternion((x, y, z, w)))
    x, y, z, *angles = scalar_numbers(element, 6)
    require_near(element, 'the position', (x, y, z))
    if element.get('degrees', '').lower() in ('true', '1'):
        angles = [math.radians(angle) for angle in angles]
    return Pose((x, y, z), orientation(as_vector(angles), element.get(QUATERNION)))
