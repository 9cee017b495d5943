"""Read the elements of a URDF: shapes, materials, masses, links and joints, all checked."""

import math
from collections.abc import Callable, Mapping
from typing import TypedDict

from lxml import etree

from ...core import (
    AbsentError,
    Fault,
    ModelError,
    ShapeError,
    Vector,
    as_vector,
    fault,
    location,
    note,
    shortened,
    suggestion,
    warn,
    warning,
)
from ...description import (
    FIXED,
    PRISMATIC,
    REVOLUTE,
    Box,
    Collision,
    Cylinder,
    Geometry,
    Inertial,
    JointSpec,
    LinkSpec,
    Material,
    Mesh,
    Sphere,
    Visual,
    gazebo_material,
)
from ...resources import Addresses, refuse_parent_folders
from ..kinematics import FREE, TreeJoint, TreeLink
from ..xml import (
    LeftOut,
    limit_number,
    number,
    numbers,
    origin,
    positive,
    require_mass,
    required_name,
    vector,
)

# URDF type -> ours. The last two impose no constraint in Gazebo either: the child is free.
_JOINT_TYPES = {
    'revolute': REVOLUTE,
    'continuous': REVOLUTE,
    'prismatic': PRISMATIC,
    'fixed': FIXED,
    'floating': FREE,
    'planar': FREE,
}

CheckMesh = Callable[[str, Vector], object]  # file, scale; raises ModelError if it is unusable


class Limits(TypedDict, total=False):
    """Fields of JointSpec that a <limit> sets."""

    lower: float
    upper: float
    effort: float
    velocity: float


class LinkReader:
    """Reads <link> elements, with the robot's named materials; checks their meshes.

    Colours: Gazebo ignores those of the URDF and shows grey. Here a <gazebo> material takes
    precedence (`gazebo_tags`), else the URDF's colour applies, so that a robot looks as in RViz;
    without either a primitive is grey and a mesh keeps its own colours.
    """

    def __init__(
        self,
        robot: etree._Element,
        check_mesh: CheckMesh,
        left_out: LeftOut,
        addresses: Addresses,
    ) -> None:
        self._check_mesh = check_mesh
        self._materials: dict[str, Material] = {}
        self.notes: list[Fault] = []  # warnings
        self._left_out, self._addresses = left_out, addresses
        for element in robot.iterfind('material'):
            colour = self._colour(element)
            if colour is not None:
                self._materials[required_name(element)] = colour
        # As in urdfdom a material defined inside one link is known to the others.
        for element in robot.iterfind('link/visual/material'):
            colour = self._colour(element)
            name = element.get('name')
            if colour is not None and name:
                self._materials.setdefault(name, colour)

    def read(self, element: etree._Element) -> TreeLink:
        """Return the link of a <link> element.

        Raises:
            ModelError: a name, number or geometry is missing or wrong.
        """
        spec = LinkSpec(
            required_name(element),
            inertial=_inertial(element),
            collisions=tuple(filter(None, map(self._collision, element.iterfind('collision')))),
            visuals=tuple(filter(None, map(self._visual, element.iterfind('visual')))),
        )
        return TreeLink(spec, element)

    def _collision(self, element: etree._Element) -> Collision | None:
        geometry = self._shape(element)
        if geometry is None:
            return None
        return Collision(element.get('name', ''), geometry, origin(element))

    def _visual(self, element: etree._Element) -> Visual | None:
        geometry = self._shape(element)
        if geometry is None:
            return None
        material = self._material(element.find('material'))
        if material is None and not isinstance(geometry, Mesh):
            material = Material()
        return Visual(element.get('name', ''), geometry, origin(element), material)

    def _material(self, element: etree._Element | None) -> Material | None:
        if element is None:
            return None
        name = element.get('name', '')
        found = self._colour(element) or self._materials.get(name) or gazebo_material(name)
        if found is None and element.find('texture') is None and element.find('color') is None:
            note(
                self.notes,
                lambda: warning(
                    element,
                    f'it has no <color> anywhere; grey is shown{suggestion(name, self._materials)}',
                ),
            )
        return found

    def _colour(self, element: etree._Element) -> Material | None:
        colour = element.find('color')
        if colour is None:
            return None
        try:
            rgba = numbers(colour, 'rgba', count=4)
        except ModelError as error:
            ignored = Fault(f'{error}; the colour is ignored, as in Gazebo', **error.place)
            if ignored not in self.notes:
                note(self.notes, lambda: ignored)
            return None
        red, green, blue, alpha = (min(1.0, max(0.0, value)) for value in rgba)
        return Material.plain((red, green, blue, alpha))

    def _shape(self, element: etree._Element) -> Geometry | None:
        """Return the geometry, or None if it cannot be created and is left out."""
        try:
            return self._geometry(element)
        except ShapeError as error:
            self._left_out.shape(element, error)
            return None

    def _geometry(self, element: etree._Element) -> Geometry:
        geometry = element.find('geometry')
        shape = geometry[0] if geometry is not None and len(geometry) else None
        if shape is None:
            raise fault(
                element,
                f'a <{element.tag}> without shape; add a <geometry> with a box, cylinder, sphere '
                'or mesh',
            )
        match shape.tag:
            case 'box':
                return Box(as_vector(positive(shape, 'size', 3)))
            case 'sphere':
                return Sphere(positive(shape, 'radius')[0])
            case 'cylinder':
                return Cylinder(positive(shape, 'radius')[0], positive(shape, 'length')[0])
            case 'mesh':
                return self._mesh(shape)
        raise fault(
            shape, f"geometry '{shape.tag}' is unknown; there are box, cylinder, sphere and mesh"
        )

    def _mesh(self, element: etree._Element) -> Mesh:
        filename = element.get('filename', '').strip()
        if not filename:
            raise fault(element, 'a <mesh> without filename; add filename="package://…"')
        scale = vector(element, 'scale', (1.0, 1.0, 1.0))
        if 0.0 in scale:
            raise ShapeError(f'scale="{element.get("scale")}" of <mesh> reduces it to nothing')
        uri = element.get('uri', filename)
        refuse_parent_folders(element, uri)
        try:
            path = self._addresses.path(element, filename)
        except AbsentError as error:
            raise ShapeError(str(error).removeprefix(f'{location(element)}: '), uri) from error
        try:
            self._check_mesh(path, scale)
        except ModelError as error:
            raise ShapeError(str(error), uri) from error
        return Mesh(path, scale, uri)


def _inertial(link: etree._Element) -> Inertial | None:
    """Return the mass properties, or None if the link has none or a mass of zero."""
    element = link.find('inertial')
    if element is None:
        return None
    mass_element, inertia = element.find('mass'), element.find('inertia')
    if mass_element is None:
        raise fault(element, 'an <inertial> without <mass value="…"/> [kg]')
    mass = number(mass_element, 'value')
    if mass < 0.0:
        raise fault(mass_element, f'mass {mass:g} kg is negative; a mass must be greater than zero')
    if inertia is None:
        raise fault(element, 'an <inertial> without <inertia ixx iyy izz ixy ixz iyz/> [kg m^2]')
    moments = {key: number(inertia, key) for key in ('ixx', 'iyy', 'izz')}
    products = {key: number(inertia, key, 0.0) for key in ('ixy', 'ixz', 'iyz')}
    require_mass(element, mass, (*moments.values(), *products.values()))
    inertial = Inertial(mass, origin(element), **moments, **products)
    for key, value in moments.items():
        if value < 0.0:
            raise fault(
                inertia,
                f'{key}="{inertia.get(key)}" of <inertia> is not valid; '
                'a moment of inertia must be greater than zero',
            )
    return inertial if mass > 0.0 else None


def read_urdf_joint(
    element: etree._Element, kept: Mapping[str, str], notes: list[Fault]
) -> TreeJoint:
    """Return the joint of a <joint> element.

    Args:
        kept: fixed joints that are not reduced -> their joint type (`GazeboTags.kept_joints`).
        notes: list to which warnings are added.
    Raises:
        ModelError: a name, link, type or number is missing or wrong.
    """
    name = required_name(element)
    written = element.get('type', '')
    kind = _JOINT_TYPES.get(written)
    if kind is None:
        raise fault(
            element,
            f"type '{written}' is unknown; there are {', '.join(_JOINT_TYPES)}"
            if written
            else f'it has no type; there are {", ".join(_JOINT_TYPES)}',
        )
    parent, child = _end(element, 'parent'), _end(element, 'child')
    if kind == FREE:
        warn(
            notes,
            element,
            f'a {written} joint imposes no constraint here; '
            f"'{shortened(child, 60)}' and its descendants move freely",
        )
    if kind in (FIXED, FREE):
        is_reduced = kind == FIXED and name not in kept
        limits = Limits(lower=0.0, upper=0.0) if kept.get(name) == REVOLUTE else Limits()
        spec = JointSpec(
            name, kept.get(name, kind) if kind == FIXED else kind, parent, child, **limits
        )
        return TreeJoint(spec, element, origin(element), is_reduced)
    dynamics = element.find('dynamics')
    return TreeJoint(
        JointSpec(
            name,
            kind,
            parent,
            child,
            axis=_axis(element, notes),
            damping=_not_negative(dynamics, 'damping', notes),
            friction=_not_negative(dynamics, 'friction', notes),
            **_limits(element, written, notes),
        ),
        element,
        origin(element),
    )


def _end(element: etree._Element, role: str) -> str:
    end = element.find(role)
    link = '' if end is None else end.get('link', '').strip()
    if not link:
        raise fault(element, f'it has no {role} link; add <{role} link="…"/>')
    return link


def _axis(element: etree._Element, notes: list[Fault]) -> Vector:
    """Return the unit axis in the joint's frame; x if none is given, or only zeros."""
    axis = element.find('axis')
    if axis is None:
        return (1.0, 0.0, 0.0)
    x, y, z = numbers(axis, 'xyz', (1.0, 0.0, 0.0))
    largest = max(abs(x), abs(y), abs(z))
    if largest == 0.0:
        what = f'xyz="{axis.get("xyz")}" of <axis> has no direction, x is used, as in Gazebo'
        warn(notes, axis, what, 'write e.g. "0 0 1"')
        return (1.0, 0.0, 0.0)
    # Scale first, so that no square underflows or overflows.
    x, y, z = x / largest, y / largest, z / largest
    length = (x * x + y * y + z * z) ** 0.5
    return (x / length, y / length, z / length)


def _not_negative(element: etree._Element | None, attribute: str, notes: list[Fault]) -> float:
    if element is None:
        return 0.0
    value = number(element, attribute, 0.0)
    if value < 0.0:
        what = f'{attribute}="{element.get(attribute)}" of <{element.tag}> is negative'
        warn(notes, element, f'{what}; 0 is used, as it can only dissipate energy')
    return max(0.0, value)


def _limits(element: etree._Element, written: str, notes: list[Fault]) -> Limits:
    """Return the limits; a negative effort or velocity means no limit."""
    limit = element.find('limit')
    if limit is None:
        if written != 'continuous':
            raise fault(
                element,
                f'a {written} joint needs <limit lower upper effort velocity/>'
                + ('; or make it continuous' if written == 'revolute' else ''),
            )
        return Limits()
    limits = Limits()
    effort, velocity = limit_number(limit, 'effort'), limit_number(limit, 'velocity')
    if 0.0 <= effort < math.inf:
        limits['effort'] = effort
    if 0.0 <= velocity < math.inf:
        limits['velocity'] = velocity
    lower, upper = limit_number(limit, 'lower', 0.0), limit_number(limit, 'upper', 0.0)
    if written == 'continuous':
        return limits
    if lower > upper:
        what = f'lower limit {lower:g} is above upper limit {upper:g}; the two are swapped'
        warn(notes, limit, what)
        lower, upper = upper, lower
    if math.isfinite(lower):
        limits['lower'] = lower
    if math.isfinite(upper):
        limits['upper'] = upper
    return limits
