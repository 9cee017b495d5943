"""Read names, numbers, poses and plain element trees from parsed XML."""

import logging
import math
import re
from collections.abc import Callable, Collection

from lxml import etree

from ...core import (
    IDENTITY,
    MAX_INERTIA,
    MAX_LENGTH,
    MAX_MASS,
    MIN_MASS,
    ZERO,
    Fault,
    ModelError,
    Pose,
    ShapeError,
    Vector,
    as_vector,
    fault,
    from_rpy,
    parse_numbers,
    report,
)
from ...description import Element

XACRO_CURE = 'run it through xacro first, e.g. command="xacro FILE" in the launch file'

MAX_NAME = 1000  # characters; the engine's own buffers end at 1024
ENDLESS_FRICTION = 1e6  # the value of a negative or infinite mu, as in Gazebo
MAX_DAMPING = 1000.0  # [1/s] with steps of 1 ms it stops a link in one step

_CONTROL = re.compile(r'[\x00-\x1f\x7f-\x9f\u2028\u2029]')
_INFINITE = ('inf', 'infinity')
_TRUE = {'true', 'yes', '1'}
_COUNTS = {
    1: 'one finite number',
    2: 'two finite numbers',
    3: 'three finite numbers',
    4: 'four finite numbers',
    6: 'six finite numbers',
    7: 'seven finite numbers',
}


def tag_of(element: etree._Element) -> str:
    """Return the element's name as written, including its prefix."""
    name = etree.QName(element).localname if element.tag.startswith('{') else element.tag
    return f'{element.prefix}:{name}' if element.prefix else name


def check_name(name: str) -> None:
    """Reject a model name that cannot be displayed or stored.

    Raises:
        ModelError: it is too long, or contains a line break or another control character.
    """
    reason = _unfit(name)
    if reason:
        raise ModelError(f"the model's name {reason}")


def _unfit(name: str) -> str:
    if len(name) > MAX_NAME:
        return f'has {len(name)} characters; at most {MAX_NAME} are accepted'
    if _CONTROL.search(name):
        return (
            f'{name[:100]!r} contains a line break or another control character; '
            'use letters, digits and _'
        )
    return ''


def required_name(element: etree._Element) -> str:
    """Return the `name` attribute.

    Raises:
        ModelError: it is missing, empty, too long for the engine, or not printable.
    """
    name = element.get('name', '').strip()
    if not name:
        raise fault(element, f'a <{tag_of(element)}> without name; add name="..."')
    reason = _unfit(name)
    if reason:
        raise fault(element, f'its name {reason}')
    return name


def numbers(
    element: etree._Element,
    attribute: str,
    default: tuple[float, ...] | None = None,
    count: int = 3,
) -> tuple[float, ...]:
    """Return `count` finite numbers from an attribute; `default` if it is missing.

    Raises:
        ModelError: not a number, not finite, another count; or missing without a default.
    """
    text = element.get(attribute)
    if text is None:
        if default is None:
            raise fault(
                element, f'<{tag_of(element)}> has no {attribute}; it takes {_COUNTS[count]}'
            )
        return default
    values = parse_numbers(text, count)
    if values is None:
        raise fault(
            element,
            f'{attribute}="{text}" of <{tag_of(element)}> {_no_number(text, "is wrong", count)}',
        )
    return values


def vector(element: etree._Element, attribute: str, default: Vector) -> Vector:
    """Return three finite numbers from an attribute, as `numbers` does."""
    return as_vector(numbers(element, attribute, default))


def _no_number(text: str, fault: str, count: int) -> str:
    if is_expression(text):
        return f'is unexpanded xacro; {XACRO_CURE}'
    return f'{fault}; it takes {_COUNTS[count]}'


def number(element: etree._Element, attribute: str, default: float | None = None) -> float:
    """Return one finite number from an attribute, as `numbers` does."""
    return numbers(element, attribute, None if default is None else (default,), 1)[0]


def limit_number(element: etree._Element, attribute: str, default: float | None = None) -> float:
    """Return one number from an attribute, as `number` does, or infinity for inf."""
    text = element.get(attribute, '').strip().lower()
    if text.lstrip('+-') in _INFINITE:
        return -math.inf if text.startswith('-') else math.inf
    return number(element, attribute, default)


def positive(element: etree._Element, attribute: str, count: int = 1) -> tuple[float, ...]:
    """Return sizes: finite numbers greater than zero [m].

    Raises:
        ShapeError: one is zero, so there is no shape.
        ModelError: one is negative, or as `numbers`.
    """
    values = numbers(element, attribute, count=count)
    written = f'{attribute}="{element.get(attribute)}" of <{tag_of(element)}>'
    require_size(element, written, values)
    require_near(element, attribute, values)
    return values


def require_size(element: etree._Element, written: str, values: Collection[float]) -> None:
    """Reject sizes that are not greater than zero, with the errors of `positive`."""
    if min(values) < 0.0:
        raise fault(element, f'{written} is not valid; a size must be greater than zero')
    if min(values) == 0.0:
        raise ShapeError(f'{written} reduces it to nothing')


def require_near(element: etree._Element, what: str, values: Collection[float]) -> None:
    """Reject lengths [m] beyond MAX_LENGTH, of an attribute or an element's text.

    Raises:
        ModelError: the absolute value of one is greater than MAX_LENGTH.
    """
    if max(map(abs, values)) > MAX_LENGTH:
        raise fault(
            element,
            f'{what} of <{tag_of(element)}> has a length of {max(values, key=abs):g} m; '
            f'at most {MAX_LENGTH:g} m are accepted',
        )


def require_mass(element: etree._Element, mass: float, moments: Collection[float] = ()) -> None:
    """Reject a mass [kg] or moments of inertia [kg m^2] out of range; the mass is positive.

    Raises:
        ModelError: the engine could not distinguish them from zero or infinity.
    """
    if mass > 0.0 and not MIN_MASS <= mass <= MAX_MASS:
        raise fault(element, f'mass {mass:g} kg is not valid; use {MIN_MASS:g} to {MAX_MASS:g} kg')
    if max(map(abs, moments), default=0.0) > MAX_INERTIA:
        raise fault(
            element,
            f'an inertia of {max(moments, key=abs):g} kg m^2 is not valid; '
            f'at most {MAX_INERTIA:g} are accepted',
        )


def require_damping(element: etree._Element, value: float) -> None:
    """Reject a velocity damping of a link that would add energy.

    Raises:
        ModelError: it is negative, or would reverse the velocity within a step.
    """
    if not 0.0 <= value <= MAX_DAMPING:
        raise fault(
            element,
            f'<{tag_of(element)}> is {value:g}; damping must be 0 to {MAX_DAMPING:g}',
        )


def scalar(element: etree._Element) -> str:
    """Return the value of <tag value="x"/> or <tag>x</tag>, without surrounding blanks."""
    return (element.get('value') or element.text or '').strip()


def is_endless(element: etree._Element) -> bool:
    """Tell whether the text is inf or Infinity, with either sign."""
    return scalar(element).lower().lstrip('+-') in _INFINITE


def scalar_number(element: etree._Element) -> float:
    """Return the finite number of <tag value="1"/> or <tag>1</tag>."""
    return scalar_numbers(element, 1)[0]


def scalar_numbers(element: etree._Element, count: int) -> tuple[float, ...]:
    """Return the finite numbers of <tag value="1 2 3"/> or <tag>1 2 3</tag>."""
    values = parse_numbers(scalar(element), count)
    if values is None:
        shown = f"is '{scalar(element)}'"
        raise fault(
            element,
            f'<{tag_of(element)}> {_no_number(scalar(element), shown, count)}',
        )
    return values


def bitmask(element: etree._Element) -> int:
    """Return a bitmask of 16 bits, written as a decimal number or as 0x….

    Raises:
        ModelError: it is neither.
    """
    try:
        return int(scalar(element), 0) & 0xFFFF
    except ValueError:
        raise fault(
            element,
            f"<{tag_of(element)}> is '{scalar(element)[:60]}'; a bitmask is a "
            'number such as 3 or 0x03',
        ) from None


def boolean(element: etree._Element) -> bool:
    """Tell whether the text is true, yes or 1; everything else is false, as in Gazebo."""
    return scalar(element).lower() in _TRUE


def origin(element: etree._Element) -> Pose:
    """Return the pose of the child <origin xyz rpy/> [m, rad]; the identity if there is none."""
    child = element.find('origin')
    if child is None:
        return IDENTITY
    position = vector(child, 'xyz', ZERO)
    require_near(child, 'xyz', position)
    return Pose(position, from_rpy(*vector(child, 'rpy', ZERO)))


def initial_pose(read: Callable[[], Pose], model: str) -> Pose:
    """Return the pose of a model that `read` returns; a malformed one is ignored, as upstream."""
    try:
        return read()
    except ModelError as error:
        what = f'{error}; the pose is ignored, and the model is at its initial pose'
        report(Fault(what, logging.ERROR, **(error.place | {'model': model})))
        return IDENTITY


def to_element(element: etree._Element) -> Element:
    """Return an XML element and its descendants as plain values."""
    return Element(
        tag=tag_of(element),
        text=(element.text or '').strip(),
        attributes=attributes_of(element),
        children=tuple(to_element(child) for child in element),
        line=element.sourceline or 0,  # type: ignore[arg-type]  # untyped in the stubs
    )


def attributes_of(element: etree._Element) -> dict[str, str]:
    """Return all attributes by their names."""
    return {str(key): str(value) for key, value in element.attrib.items()}


def is_expression(value: str) -> bool:
    """Tell whether a text contains xacro's ${...} or $(...), in linear time."""
    return any(
        opened >= 0 and value.find(close, opened) >= 0
        for opened, close in ((value.find('${'), '}'), (value.find('$('), ')'))
    )
