"""Collisions and visuals of SDF: geometry, surface and material."""

from dataclasses import replace

from lxml import etree

from ...core import AbsentError, ModelError, Pose, ShapeError, as_vector, fault, location, owner
from ...description import (
    Box,
    Collision,
    Cylinder,
    Geometry,
    Material,
    Mesh,
    Plane,
    Sphere,
    Surface,
    Visual,
    gazebo_material,
    material_of_colours,
)
from ...meshes import check_mesh, submesh_file
from ..xml import ENDLESS_FRICTION, bitmask, is_endless, scalar, tag_of
from .document import SdfDocument
from .values import (
    boolean_of,
    colour_of,
    limit_of,
    not_negative_of,
    number_of,
    numbers_of,
    sizes_of,
    text_of,
    unit_vector_of,
    vector_of,
)

_NOT_SIMULATED = ('heightmap', 'polyline', 'image', 'capsule', 'ellipsoid', 'cone')
_COLOURS = ('ambient', 'diffuse', 'specular', 'emissive')
_BITMASKS = ('collide_bitmask', 'category_bitmask')
_UP = (0.0, 0.0, 1.0)


def read_collision(
    document: SdfDocument, element: etree._Element, name: str, pose: Pose
) -> Collision | None:
    """Return a <collision>, or None if its shape was left out, which is noted.

    Args:
        pose: in the link's frame.
    Raises:
        ModelError: a number or geometry is missing or wrong.
    """
    document.notes.check(
        element, ('pose', 'geometry', 'surface', 'max_contacts', 'laser_retro'), ('meta',)
    )
    geometry = _shape(document, element)
    if geometry is None:
        return None
    return Collision(name, geometry, pose, _surface(document, element))


def read_visual(
    document: SdfDocument, element: etree._Element, name: str, pose: Pose
) -> Visual | None:
    """Return a <visual>, or None if it is invisible or its shape was left out, which is noted.

    Args:
        pose: in the link's frame.
    Raises:
        ModelError: a number or geometry is missing or wrong.
    """
    document.notes.check(
        element,
        ('pose', 'geometry', 'material', 'transparency', 'visible'),
        ('cast_shadows', 'laser_retro', 'meta', 'visibility_flags'),
    )
    geometry = _shape(document, element)
    if geometry is None or not boolean_of(element, 'visible', True):
        return None
    material = _material(document, element)
    if material is None and not isinstance(geometry, Mesh):
        material = Material()
    return Visual(name, geometry, pose, material)


def _shape(document: SdfDocument, element: etree._Element) -> Geometry | None:
    """Return the geometry, or None if it cannot be created and is left out."""
    try:
        return _geometry(document, element)
    except ShapeError as error:
        document.notes.left_out.shape(element, error)
        return None


def _geometry(document: SdfDocument, element: etree._Element) -> Geometry | None:
    shapes = list(element.iterfind('geometry/*'))
    if not shapes:
        raise fault(
            element,
            f"<{element.tag} name='{element.get('name', '')}'> has no shape; "
            'add a <geometry> with a box, sphere, cylinder, plane or mesh',
        )
    shape = shapes[0]
    match shape.tag:
        case 'box':
            return Box(as_vector(sizes_of(shape, 'size', 3)))
        case 'sphere':
            return Sphere(sizes_of(shape, 'radius')[0])
        case 'cylinder':
            return Cylinder(sizes_of(shape, 'radius')[0], sizes_of(shape, 'length')[0])
        case 'plane':
            length, width = numbers_of(shape, 'size', (1.0, 1.0))
            return Plane(unit_vector_of(shape, 'normal', _UP), (length, width))
        case 'mesh':
            return _mesh(document, shape)
        case 'empty':
            return None
        case tag if tag in _NOT_SIMULATED:
            document.notes.unread(shape)
            document.notes.left_out.parts.append(f'{tag} of {owner(element)}')
            return None
    raise fault(
        shape,
        f"geometry '{tag_of(shape)}' is unknown; there are box, sphere, cylinder, plane and mesh",
    )


def _mesh(document: SdfDocument, element: etree._Element) -> Mesh:
    document.notes.check(element, ('uri', 'filename', 'scale', 'submesh'))
    uri_element = element.find('uri')
    if uri_element is None:
        uri_element = element.find('filename')  # its name until SDF 1.2
    if uri_element is None or not (uri := scalar(uri_element)):
        raise ShapeError('a <mesh> without <uri>; add <uri>model://MODEL/meshes/FILE</uri>')
    scale = vector_of(element, 'scale', (1.0, 1.0, 1.0))
    if 0.0 in scale:
        written = text_of(element, 'scale')
        raise ShapeError(f"<scale> '{written}' of <mesh> reduces it to nothing")
    try:
        path = document.file(uri_element, uri)
    except AbsentError as error:
        raise ShapeError(str(error).removeprefix(f'{location(uri_element)}: '), uri) from error
    submesh = text_of(element, 'submesh/name')
    centred = bool(submesh) and boolean_of(element, 'submesh/center')
    address = uri
    if submesh and '://' not in uri.removeprefix('file://'):
        address = f'file://{path}'  # which `Mesh.path` does not tell: it has the part only
    try:
        if submesh:
            path = submesh_file(path, submesh, centred)
        check_mesh(path, scale)
    except ModelError as error:
        raise ShapeError(str(error), uri) from error
    return Mesh(path, scale, address, submesh, centred)


def _surface(document: SdfDocument, collision: etree._Element) -> Surface:
    plain = Surface()
    default = Surface(
        laser_retro=number_of(collision, 'laser_retro', plain.laser_retro),
        max_contacts=int(number_of(collision, 'max_contacts', plain.max_contacts)),
    )
    surface = collision.find('surface')
    if surface is None:
        return default
    for path, read in (
        ('.', ('friction', 'contact', 'bounce')),
        ('friction', ('ode',)),
        ('friction/ode', ('mu', 'mu2', 'fdir1', 'slip1', 'slip2')),
        ('contact', ('ode', *_BITMASKS)),
        ('bounce', ('restitution_coefficient', 'threshold')),
        ('contact/ode', ('kp', 'kd', 'max_vel', 'min_depth')),
    ):
        part = surface.find(path)
        if part is not None:
            # Settings of engines that Gazebo does not use by default either.
            document.notes.check(
                part, read, ('bullet', 'soft_contact', 'poissons_ratio', 'elastic_modulus')
            )
    contact = 'contact/ode'
    stiffness = limit_of(surface, f'{contact}/kp')
    return replace(
        default,
        mu=_friction(surface, 'friction/ode/mu', default.mu),
        mu2=_friction(surface, 'friction/ode/mu2', default.mu2),
        fdir1=vector_of(surface, 'friction/ode/fdir1', default.fdir1),
        slip1=not_negative_of(surface, 'friction/ode/slip1', default.slip1),
        slip2=not_negative_of(surface, 'friction/ode/slip2', default.slip2),
        kp=default.kp
        if stiffness is None
        else not_negative_of(surface, f'{contact}/kp', default.kp),
        kd=not_negative_of(surface, f'{contact}/kd', default.kd),
        # SDF 1.0 files of Gazebo have -1 for these
        max_vel=max(0.0, number_of(surface, f'{contact}/max_vel', default.max_vel)),
        min_depth=max(0.0, number_of(surface, f'{contact}/min_depth', default.min_depth)),
        restitution=not_negative_of(surface, 'bounce/restitution_coefficient', 0.0),
        threshold=not_negative_of(surface, 'bounce/threshold', default.threshold),
        **_bitmasks(surface),
    )


def _bitmasks(surface: etree._Element) -> dict[str, int]:
    """Return the bitmasks; the category is that which the collision collides with if not given."""
    written = {
        tag: element for tag in _BITMASKS if (element := surface.find(f'contact/{tag}')) is not None
    }
    masks = {tag: bitmask(element) for tag, element in written.items()}
    return (
        {'category_bitmask': masks['collide_bitmask'], **masks}
        if 'collide_bitmask' in masks
        else masks
    )


def _friction(surface: etree._Element, path: str, default: float) -> float:
    """Return a friction coefficient; negative ones and inf mean infinite, as in Gazebo."""
    element = surface.find(path)
    if element is not None and is_endless(element):
        return ENDLESS_FRICTION
    value = number_of(surface, path, default)
    return value if value >= 0.0 else ENDLESS_FRICTION


def _material(document: SdfDocument, visual: etree._Element) -> Material | None:
    """Return the looks: its colours before those of the script, as in Gazebo."""
    element = visual.find('material')
    if element is None:
        return None
    document.notes.check(
        element,
        ('script', *_COLOURS),
        ('shader', 'lighting', 'pbr', 'double_sided', 'shininess'),
    )
    script = text_of(element, 'script/name') or text_of(element, 'script')
    colours = {tag: colour_of(element, tag) for tag in _COLOURS}
    if not script and not any(colours.values()):
        return None
    base = gazebo_material(script) or document.script_material(element, script)
    if base is None and not (colours['diffuse'] or colours['ambient']):
        document.notes.warn(
            element,
            f"material '{script}' is neither one of Gazebo's nor in a script that <uri> names; "
            'grey is shown; add <diffuse>',
        )
    material = material_of_colours(base or Material(script=script), **colours)
    opacity = min(1.0, max(0.0, 1.0 - number_of(visual, 'transparency', 0.0)))
    return replace(material, rgba=(*material.rgba[:3], material.rgba[3] * opacity))
