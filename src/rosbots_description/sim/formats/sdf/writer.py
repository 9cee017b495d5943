"""Write a model as SDF: numbers so that they are read as the same, defaults left out."""

import os
from xml.sax.saxutils import escape

from lxml import etree

from ...core import IDENTITY, Pose
from ...description import (
    FIXED,
    Box,
    Collision,
    Cylinder,
    Geometry,
    Inertial,
    JointSpec,
    LinkSpec,
    Material,
    Mesh,
    ModelSpec,
    Plane,
    SensorSpec,
    Sphere,
    Surface,
    Visual,
    gazebo_material,
)
from .elements import (
    add_element,
    add_plugin,
    new_document,
    put,
    put_pose,
    remove_ours,
    text_of_document,
)
from .exact import REDUCED

_ENDLESS = 1e16  # SDF's number for no limit
_SCRIPTS = 'file://media/materials/scripts/gazebo.material'
# Fields of Surface that differ from SDF's defaults are written here, below <collision>.
_SURFACE = {
    'mu': 'surface/friction/ode/mu',
    'mu2': 'surface/friction/ode/mu2',
    'fdir1': 'surface/friction/ode/fdir1',
    'slip1': 'surface/friction/ode/slip1',
    'slip2': 'surface/friction/ode/slip2',
    'kp': 'surface/contact/ode/kp',
    'kd': 'surface/contact/ode/kd',
    'max_vel': 'surface/contact/ode/max_vel',
    'min_depth': 'surface/contact/ode/min_depth',
    'restitution': 'surface/bounce/restitution_coefficient',
    'threshold': 'surface/bounce/threshold',
    'collide_bitmask': 'surface/contact/collide_bitmask',
    'max_contacts': 'max_contacts',
    'laser_retro': 'laser_retro',
}
# Addresses that mean the same in any file; others are relative to the file that they are in.
_FINDABLE = ('model://', 'package://')
_COLOURS = ('ambient', 'diffuse', 'specular', 'emissive')
_MOMENTS = ('ixx', 'ixy', 'ixz', 'iyy', 'iyz', 'izz')


def sdf_of_model(spec: ModelSpec, pose: Pose = IDENTITY) -> str:
    """Return an SDF document with one model.

    Args:
        pose: of the model in the world.
    """
    root = new_document()
    add_model(root, spec, pose)
    remove_ours(root)
    return text_of_document(root)


def copy_of_model(spec: ModelSpec) -> str:
    """Return an SDF document from which this simulator reads the same model.

    It has the names of reduced links, and numbers that only this simulator reads.
    """
    root = new_document()
    add_model(root, spec, IDENTITY)
    return text_of_document(root)


def sdf_of_include(address: str) -> str:
    """Return SDF that includes a model by its address, such as model://sun."""
    return (
        f'<sdf version="1.7"><world name="w"><include><uri>{escape(address)}</uri></include>'
        '</world></sdf>'
    )


def add_model(parent: etree._Element, spec: ModelSpec, pose: Pose) -> None:
    """Add a <model> to a document or world.

    Fixed joints that were reduced stay so; their links become frames. The links of a nested model
    are called `inner::link`, as in the spec, and the nested <model> only has its pose.
    """
    model = etree.SubElement(parent, 'model', name=spec.name)
    put(model, 'static', spec.static, False)
    put_pose(model, pose)
    for link in spec.links:
        _add_link(model, link)
    for joint in spec.joints:
        _add_joint(model, joint)
    for name, place in spec.nested.items():
        put_pose(etree.SubElement(model, 'model', name=name), place)
    for name, (link_name, place) in spec.reduced.items():
        frame = etree.SubElement(
            model, 'frame', {'name': name, 'attached_to': link_name, REDUCED: 'true'}
        )
        put_pose(frame, place)
    for plugin in spec.plugins:
        add_plugin(model, plugin)


def _add_link(model: etree._Element, spec: LinkSpec) -> None:
    link = etree.SubElement(model, 'link', name=spec.name)
    plain = LinkSpec(spec.name)
    put_pose(link, spec.pose)
    if spec.inertial is not None:
        _add_inertial(link, spec.inertial)
    for collision in spec.collisions:
        _add_collision(link, collision)
    for visual in spec.visuals:
        _add_visual(link, visual)
    put(link, 'gravity', spec.gravity, plain.gravity)
    put(link, 'self_collide', spec.self_collide, plain.self_collide)
    put(link, 'kinematic', spec.kinematic, plain.kinematic)
    put(link, 'velocity_decay/linear', spec.linear_damping, plain.linear_damping)
    put(link, 'velocity_decay/angular', spec.angular_damping, plain.angular_damping)
    for sensor in spec.sensors:
        _add_sensor(link, sensor)
    for part in spec.parts:
        add_element(link, part)


def _add_inertial(link: etree._Element, spec: Inertial) -> None:
    inertial = etree.SubElement(link, 'inertial')
    put(inertial, 'mass', spec.mass)
    put_pose(inertial, spec.pose)
    for key in _MOMENTS:
        put(inertial, f'inertia/{key}', getattr(spec, key))


def _add_collision(link: etree._Element, spec: Collision) -> None:
    collision = etree.SubElement(link, 'collision', name=spec.name)
    put_pose(collision, spec.pose)
    _add_geometry(collision, spec.geometry)
    plain = Surface()
    for field, path in _SURFACE.items():
        put(collision, path, getattr(spec.surface, field), getattr(plain, field))
    put(
        collision,
        'surface/contact/category_bitmask',
        spec.surface.category_bitmask,
        spec.surface.collide_bitmask,
    )


def _add_visual(link: etree._Element, spec: Visual) -> None:
    visual = etree.SubElement(link, 'visual', name=spec.name)
    put_pose(visual, spec.pose)
    _add_geometry(visual, spec.geometry)
    if spec.material is not None and spec.material != Material():
        _add_material(visual, spec.material)


def _add_material(visual: etree._Element, spec: Material) -> None:
    """Write the script, and the colours that are not the script's."""
    base = gazebo_material(spec.script) or Material()
    if spec.script:
        script = etree.SubElement(etree.SubElement(visual, 'material'), 'script')
        places = [spec.script_file, os.path.dirname(spec.image)]
        uris = [f'file://{place}' for place in places if place] if spec.script_file else [_SCRIPTS]
        for uri in uris:
            etree.SubElement(script, 'uri').text = uri
        put(script, 'name', spec.script)
    own, others = spec.reflection, base.reflection
    alpha = spec.rgba[3]
    written = [tag for tag in _COLOURS if getattr(own, tag) != getattr(others, tag)]
    if 'diffuse' not in written and spec.rgba[:3] == own.diffuse != base.rgba[:3]:
        written.append('diffuse')
    for tag in written:
        put(visual, f'material/{tag}', (*getattr(own, tag), alpha))
    if not {'ambient', 'diffuse'} & set(written) and alpha != base.rgba[3]:
        put(visual, 'transparency', 1.0 - alpha / base.rgba[3])


def _add_geometry(shape: etree._Element, geometry: Geometry) -> None:
    within = etree.SubElement(shape, 'geometry')
    match geometry:
        case Box(size):
            put(within, 'box/size', size)
        case Sphere(radius):
            put(within, 'sphere/radius', radius)
        case Cylinder(radius, length):
            put(within, 'cylinder/radius', radius)
            put(within, 'cylinder/length', length)
        case Plane(normal, size):
            put(within, 'plane/normal', normal)
            put(within, 'plane/size', size)
        case Mesh():
            _add_mesh(within, geometry)


def _add_mesh(within: etree._Element, mesh: Mesh) -> None:
    is_findable = mesh.uri.startswith(_FINDABLE) or mesh.submesh
    put(within, 'mesh/uri', mesh.uri if is_findable else f'file://{mesh.path}')
    put(within, 'mesh/submesh/name', mesh.submesh, '')
    put(within, 'mesh/submesh/center', mesh.is_centred, False)
    put(within, 'mesh/scale', mesh.scale, (1.0, 1.0, 1.0))


def _add_joint(model: etree._Element, spec: JointSpec) -> None:
    joint = etree.SubElement(model, 'joint', name=spec.name, type=spec.type)
    put(joint, 'parent', spec.parent)
    put(joint, 'child', spec.child)
    put_pose(joint, spec.pose)
    if spec.type == FIXED:
        return
    put(joint, 'axis/xyz', spec.axis)
    put(joint, 'axis/limit/lower', -_ENDLESS if spec.lower is None else spec.lower)
    put(joint, 'axis/limit/upper', _ENDLESS if spec.upper is None else spec.upper)
    for field in ('effort', 'velocity'):
        limit = getattr(spec, field)
        if limit is not None:
            put(joint, f'axis/limit/{field}', limit)
    put(joint, 'axis/dynamics/damping', spec.damping, 0.0)
    put(joint, 'axis/dynamics/friction', spec.friction, 0.0)
    put(joint, 'axis/dynamics/spring_stiffness', spec.stiffness, 0.0)
    put(joint, 'axis/dynamics/spring_reference', spec.reference, 0.0)


def _add_sensor(link: etree._Element, spec: SensorSpec) -> None:
    """Write a sensor as it was described, but at its pose in the link."""
    sensor = add_element(link, spec.element)
    for pose in sensor.findall('pose'):
        sensor.remove(pose)
    put_pose(sensor, spec.pose)
