"""Read <transmission>, <mimic> and the limits of joints, for controllers.

Transmissions are read as transmission_interface 0.20 does: one that is not complete is skipped.
"""

import math

from lxml import etree

from ...core import ZERO, ModelError, Vector, as_vector, parse_number, parse_numbers
from ...description import ControlledJoint, Mimic, RobotControl, SoftLimits, Transmission
from ...resources import parse_xml


def load_robot_control(text: str | bytes, source: str = 'robot_description') -> RobotControl:
    """Return what controllers need of a URDF.

    Args:
        source: origin of the text, for messages.
    Raises:
        ModelError: the text is not XML.
    """
    return read_robot_control(parse_xml(text, source))


def read_robot_control(robot: etree._Element) -> RobotControl:
    """Return what controllers need of a parsed URDF; numbers that cannot be read are defaults."""
    faults: list[str] = []
    transmissions = []
    for element in robot.iterfind('transmission'):
        try:
            transmissions.append(_transmission(element, faults))
        except ModelError as error:
            faults.append(str(error))
    joints = {
        name: _joint(element)
        for element in robot.iterfind('joint')
        if (name := element.get('name'))
    }
    return RobotControl(tuple(transmissions), joints, tuple(faults))


def _transmission(element: etree._Element, faults: list[str]) -> Transmission:
    name = element.get('name')
    if name is None:
        raise ModelError('No name attribute specified for transmission.')
    if not name:
        raise ModelError('Empty name attribute specified for transmission.')
    kind = element.find('type')
    if kind is None:
        raise ModelError(f"No type element found in transmission '{name}'.")
    if not (kind.text or '').strip():
        raise ModelError(f"Skipping empty type element in transmission '{name}'.")
    joints: dict[str, tuple[str, ...]] = {}
    for joint in _named(element, 'joint', name, faults):
        interfaces = tuple(
            filter(None, ((one.text or '').strip() for one in joint.iterfind('hardwareInterface')))
        )
        if interfaces:
            joints[joint.get('name', '')] = interfaces
        else:
            faults.append(
                f"No valid hardware interface element found in joint '{joint.get('name')}'."
            )
    if not joints:
        raise ModelError(f"Failed to load joints for transmission '{name}'.")
    if not _named(element, 'actuator', name, faults):
        raise ModelError(f"Failed to load actuators for transmission '{name}'.")
    return Transmission(name, (kind.text or '').strip(), joints)


def _named(
    element: etree._Element, tag: str, transmission: str, faults: list[str]
) -> list[etree._Element]:
    """Return the children of that tag; one without a name invalidates the transmission."""
    named = []
    for child in element.iterfind(tag):
        name = child.get('name')
        if name is None:
            faults.append(f'No name attribute specified for {tag}.')
            raise ModelError(f"Failed to load {tag}s for transmission '{transmission}'.")
        if name:
            named.append(child)
        else:
            faults.append(f'Empty name attribute specified for {tag}.')
    return named


def _joint(element: etree._Element) -> ControlledJoint:
    kind = element.get('type', '')
    limit, safety, mimic = (element.find(tag) for tag in ('limit', 'safety_controller', 'mimic'))
    soft = None
    if safety is not None:
        soft = SoftLimits(
            *(
                _number(safety, key)
                for key in ('soft_lower_limit', 'soft_upper_limit', 'k_position', 'k_velocity')
            )
        )
    copied = None
    if mimic is not None and mimic.get('joint'):
        copied = Mimic(
            mimic.get('joint', ''), _number(mimic, 'multiplier', 1.0), _number(mimic, 'offset')
        )
    place = _origin(element.find('origin'))
    if limit is None:
        return ControlledJoint(kind, soft=soft, mimic=copied, origin=place)
    lower, upper = -math.inf, math.inf
    if kind in ('revolute', 'prismatic'):
        lower, upper = sorted((_number(limit, 'lower'), _number(limit, 'upper')))
    return ControlledJoint(
        kind,
        lower,
        upper,
        abs(_number(limit, 'velocity')),
        abs(_number(limit, 'effort')),
        soft,
        copied,
        place,
    )


def _origin(element: etree._Element | None) -> Vector:
    numbers = None if element is None else parse_numbers(element.get('xyz', ''), 3)
    return ZERO if numbers is None else as_vector(numbers)


def _number(element: etree._Element, key: str, default: float = 0.0) -> float:
    value = parse_number(element.get(key, ''))
    return default if value is None else value
