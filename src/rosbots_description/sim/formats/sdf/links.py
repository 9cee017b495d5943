"""Links of SDF: masses, shapes and flags."""

from collections import Counter
from collections.abc import Callable
from typing import TypeVar

from lxml import etree

from ...core import IDENTITY, Pose, fault, relative
from ...description import WORLD, Collision, Inertial, LinkSpec, SensorSpec, Visual
from ..xml import read_sensor, require_mass, required_name, to_element
from .document import SdfDocument
from .frames import Frames, is_posed_elsewhere
from .shapes import read_collision, read_visual
from .values import boolean_of, damping_of, number_of, pose_in

_READ = (
    'pose',
    'inertial',
    'collision',
    'visual',
    'gravity',
    'self_collide',
    'kinematic',
    'velocity_decay',
    'sensor',
    'light',
    'projector',
)
_PARTS = ('light', 'projector')
_MOMENTS, _PRODUCTS = ('ixx', 'iyy', 'izz'), ('ixy', 'ixz', 'iyz')

# The mass properties of a link that gives none.
UNIT_INERTIAL = Inertial(1.0, IDENTITY, 1.0, 1.0, 1.0)

Shape = TypeVar('Shape', Collision, Visual)


def read_link(
    document: SdfDocument,
    element: etree._Element,
    frames: Frames,
    static: bool,
    self_collide: bool,
) -> LinkSpec:
    """Return the link of a <link>, posed in its model.

    Args:
        frames: those of the model.
        static: whether the model is static, so that masses do not matter.
        self_collide: the model's setting, for links without one.
    Raises:
        ModelError: a name, number, frame, geometry or mesh file is missing or wrong.
    """
    name = required_name(element)
    if name == WORLD:
        raise fault(element, f"a link cannot be called '{WORLD}'; that names the world itself")
    document.notes.check(element, _READ, ('must_be_base_link',))
    pose = frames.place(element)
    return LinkSpec(
        name,
        pose,
        _inertial(document, element, static),
        _shapes(document, element, frames, pose, 'collision', read_collision),
        _shapes(document, element, frames, pose, 'visual', read_visual),
        gravity=boolean_of(element, 'gravity', True),
        self_collide=boolean_of(element, 'self_collide', self_collide),
        kinematic=boolean_of(element, 'kinematic'),
        linear_damping=damping_of(element, 'velocity_decay/linear'),
        angular_damping=damping_of(element, 'velocity_decay/angular'),
        sensors=_sensors(document, element, frames, pose),
        parts=tuple(to_element(child) for child in element if child.tag in _PARTS),
    )


def _sensors(
    document: SdfDocument, link: etree._Element, frames: Frames, link_pose: Pose
) -> tuple[SensorSpec, ...]:
    return tuple(
        read_sensor(child, document.notes.warn, _pose_in_link(child, frames, link_pose))
        for child in link.iterfind('sensor')
    )


def _shapes(
    document: SdfDocument,
    link: etree._Element,
    frames: Frames,
    link_pose: Pose,
    tag: str,
    read: Callable[[SdfDocument, etree._Element, str, Pose], Shape | None],
) -> tuple[Shape, ...]:
    """Return the shapes of one kind, under unique names, posed in the link's frame."""
    shapes: dict[str, Shape] = {}
    taken: Counter[str] = Counter()
    for element in link.iterfind(tag):
        plain = name = element.get('name', '').strip() or tag
        while name in taken:
            name = f'{plain}_{taken[plain]}'
            taken[plain] += 1
        taken[name] += 1
        shape = read(document, element, name, _pose_in_link(element, frames, link_pose))
        if shape is not None:
            shapes[name] = shape
    return tuple(shapes.values())


def _pose_in_link(element: etree._Element, frames: Frames, link_pose: Pose) -> Pose:
    pose = element.find('pose')
    if is_posed_elsewhere(pose):
        return relative(frames.place(element), link_pose)
    return pose_in(pose)


def _inertial(document: SdfDocument, link: etree._Element, static: bool) -> Inertial | None:
    """Return the mass properties; the defaults are those of SDF, 1 kg and 1 kg m^2."""
    if static:
        return None
    element = link.find('inertial')
    if element is None:
        return UNIT_INERTIAL
    document.notes.check(element, ('mass', 'inertia', 'pose'))
    mass, mass_element = number_of(element, 'mass', 1.0), element.find('mass')
    if mass_element is not None and mass <= 0.0:
        raise fault(
            mass_element,
            f'mass {mass:g} kg is not valid; the mass of a moving link must be greater than zero',
        )
    values = {key: number_of(element, f'inertia/{key}', 1.0) for key in _MOMENTS}
    values |= {key: number_of(element, f'inertia/{key}', 0.0) for key in _PRODUCTS}
    require_mass(element, mass, values.values())
    for key in _MOMENTS:
        moment = element.find(f'inertia/{key}')
        if moment is not None and values[key] < 0.0:
            raise fault(
                moment,
                f'<{key}> is {values[key]:g}; a moment of inertia must be greater than zero',
            )
    return Inertial(mass, pose_in(element.find('pose')), **values)
