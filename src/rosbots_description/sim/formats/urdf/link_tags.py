"""What the <gazebo> blocks of a link say of its surface and its flags."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import Literal, TypedDict

from lxml import etree

from ...core import Vector, as_vector, fault
from ...description import Element, LinkSpec, Material, SensorSpec
from ..kinematics import LinkFlags, TreeLink
from ..xml import (
    ENDLESS_FRICTION,
    bitmask,
    boolean,
    is_endless,
    require_damping,
    scalar,
    scalar_number,
    scalar_numbers,
    tag_of,
)

SurfaceNumber = Literal['mu', 'mu2', 'kp', 'kd', 'max_vel', 'min_depth', 'laser_retro']
SURFACE_NUMBERS: dict[str, SurfaceNumber] = {
    'mu1': 'mu',
    'mu2': 'mu2',
    'kp': 'kp',
    'kd': 'kd',
    'maxVel': 'max_vel',
    'minDepth': 'min_depth',
    'laserRetro': 'laser_retro',
}
# The same inside <collision>, in SDF's own structure.
SURFACE_PATHS: dict[str, SurfaceNumber] = {
    'surface/friction/ode/mu': 'mu',
    'surface/friction/ode/mu2': 'mu2',
    'surface/contact/ode/kp': 'kp',
    'surface/contact/ode/kd': 'kd',
    'surface/contact/ode/max_vel': 'max_vel',
    'surface/contact/ode/min_depth': 'min_depth',
    'laser_retro': 'laser_retro',
}


class SurfaceTags(TypedDict, total=False):
    """Fields of Surface that the blocks of one link set."""

    mu: float
    mu2: float
    fdir1: Vector
    kp: float
    kd: float
    max_vel: float
    min_depth: float
    max_contacts: int
    collide_bitmask: int
    category_bitmask: int
    laser_retro: float


@dataclass
class LinkTags:
    """The contents of the blocks of one link; the mappings hold only what is written."""

    surface: SurfaceTags = field(default_factory=SurfaceTags)
    flags: LinkFlags = field(default_factory=LinkFlags)
    material: Material | None = None
    sensors: list[SensorSpec] = field(default_factory=list)
    parts: list[Element] = field(default_factory=list)  # lights and projectors


def apply_tags(link: TreeLink, tags: LinkTags | None) -> TreeLink:
    """Return the link with the shapes, flags and sensors that its blocks specify."""
    if tags is None:
        return link
    spec: LinkSpec = replace(
        link.spec,
        collisions=tuple(
            replace(shape, surface=replace(shape.surface, **tags.surface))
            for shape in link.spec.collisions
        ),
        visuals=tuple(
            replace(shape, material=tags.material or shape.material) for shape in link.spec.visuals
        ),
        sensors=tuple(tags.sensors),
        parts=tuple(tags.parts),
        **tags.flags,
    )
    return replace(link, spec=spec, flags=tags.flags)


def set_surface(link: LinkTags, key: SurfaceNumber, element: etree._Element) -> None:
    """Set a number of a link's surface, by Gazebo's rules for negative and endless ones.

    Raises:
        ModelError: it is not finite, or negative where that means nothing.
    """
    rubs = key in ('mu', 'mu2')
    value = ENDLESS_FRICTION if rubs and is_endless(element) else scalar_number(element)
    if rubs and value < 0.0:
        value = ENDLESS_FRICTION
    elif value < 0.0 and key in ('max_vel', 'min_depth'):
        value = 0.0
    elif value < 0.0 and key != 'laser_retro':
        raise fault(element, f'<{tag_of(element)}> is {value:g}; it must not be negative')
    link.surface[key] = value


def _read_direction(element: etree._Element, link: LinkTags) -> None:
    link.surface['fdir1'] = as_vector(scalar_numbers(element, 3))


def _read_max_contacts(element: etree._Element, link: LinkTags) -> None:
    link.surface['max_contacts'] = int(scalar_number(element))


def _read_collide_bitmask(element: etree._Element, link: LinkTags) -> None:
    link.surface['collide_bitmask'] = link.surface['category_bitmask'] = bitmask(element)


def _read_category_bitmask(element: etree._Element, link: LinkTags) -> None:
    link.surface['category_bitmask'] = bitmask(element)


def _read_damping(element: etree._Element, link: LinkTags) -> None:
    value = scalar_number(element)
    require_damping(element, value)
    link.flags |= {'linear_damping': value, 'angular_damping': value}


def _read_self_collide(element: etree._Element, link: LinkTags) -> None:
    link.flags['self_collide'] = boolean(element)


def _read_gravity_off(element: etree._Element, link: LinkTags) -> None:
    # As in Gazebo any text that does not mean false turns gravity off.
    link.flags['gravity'] = scalar(element).lower() in ('false', 'no', '0')


def _read_gravity(element: etree._Element, link: LinkTags) -> None:
    link.flags['gravity'] = boolean(element)


def _read_collision(element: etree._Element, link: LinkTags) -> None:
    for path, key in SURFACE_PATHS.items():
        child = element.find(path)
        if child is not None:
            set_surface(link, key, child)
    for path, reader in (
        ('surface/friction/ode/fdir1', _read_direction),
        ('max_contacts', _read_max_contacts),
        ('surface/contact/collide_bitmask', _read_collide_bitmask),
        ('surface/contact/category_bitmask', _read_category_bitmask),
    ):
        child = element.find(path)
        if child is not None:
            reader(child, link)


LINK_READERS: Mapping[str, Callable[[etree._Element, LinkTags], None]] = {
    'fdir1': _read_direction,
    'maxContacts': _read_max_contacts,
    'dampingFactor': _read_damping,
    'selfCollide': _read_self_collide,
    'self_collide': _read_self_collide,
    'turnGravityOff': _read_gravity_off,
    'gravity': _read_gravity,
    'collision': _read_collision,
}
