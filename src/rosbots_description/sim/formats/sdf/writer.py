"""Write a model as SDF 1.7: numbers so that they are read as the same, defaults left out."""

from lxml import etree

from ...core import IDENTITY, Pose, to_rpy
from ...description import (
    FIXED,
    Box,
    Collision,
    Cylinder,
    Element,
    Geometry,
    Inertial,
    JointSpec,
    LinkSpec,
    Material,
    Mesh,
    ModelSpec,
    Plane,
    PluginSpec,
    SensorSpec,
    Sphere,
    Surface,
    Visual,
    gazebo_material,
)

_ENDLESS = 1e16  # SDF's number for no limit
_SCRIPTS = 'file://media/materials/scripts/gazebo.material'
# Fields of Surface that differ from SDF's defaults are written here, below <collision>.
_SURFACE = {
    'mu': 'surface/friction/ode/mu', 'mu2': 'surface/friction/ode/mu2',
    'fdir1': 'surface/friction/ode/fdir1', 'slip1': 'surface/friction/ode/slip1',
    'slip2': 'surface/friction/ode/slip2', 'kp': 'surface/contact/ode/kp',
    'kd': 'surface/contact/ode/kd', 'max_vel': 'surface/contact/ode/max_vel',
    'min_depth': 'surface/contact/ode/min_depth',
    'restitution': 'surface/bounce/restitution_coefficient',
    'threshold': 'surface/bounce/threshold',
    'max_contacts': 'max_contacts', 'laser_retro': 'laser_retro',
}
_COLOURS = ('ambient', 'diffuse', 'specular', 'emissive')
_MOMENTS = ('ixx', 'ixy', 'ixz', 'iyy', 'iyz', 'izz')

Value = str | bool | float | tuple[float, ...]


def sdf_of_model(spec: ModelSpec, pose: Pose = IDENTITY) -> str:
    """Return an SDF document with one model.

    Fixed joints that were reduced stay so.

    Args:
        spec: of a URDF: neither nested models nor submeshes are written as such.
        pose: of the model in the world.
    """
    root = etree.Element('sdf', version='1.7')
    model = etree.SubElement(root, 'model', name=spec.name)
    _put(model, 'static', spec.static, False)
    _put_pose(model, pose)
    for link in spec.links:
        _add_link(model, link)
    for joint in spec.joints:
        _add_joint(model, joint)
    for plugin in spec.plugins:
        _add_plugin(model, plugin)
    etree.indent(root)
    return etree.tostring(root, encoding='unicode')


def _text(value: Value) -> str:
    if isinstance(value, str):
        return value
    if isinstance(value, bool):
        return str(int(value))
    numbers = value if isinstance(value, tuple) else (value,)
    return ' '.join(repr(number).removesuffix('.0') for number in numbers)


def _put(parent: etree._Element, path: str, value: Value, default: Value | None = None) -> None:
    """Write a value at a path below an element, unless it is the default."""
    if value == default:
        return
    for tag in path.split('/'):
        child = parent.find(tag)
        parent = etree.SubElement(parent, tag) if child is None else child
    parent.text = _text(value)


def _put_pose(parent: etree._Element, pose: Pose) -> None:
    if pose != IDENTITY:
        _put(parent, 'pose', (*pose.position, *to_rpy(pose.orientation)))


def _add_link(model: etree._Element, spec: LinkSpec) -> None:
    link = etree.SubElement(model, 'link', name=spec.name)
    plain = LinkSpec(spec.name)
    _put_pose(link, spec.pose)
    if spec.inertial is not None:
        _add_inertial(link, spec.inertial)
    for collision in spec.collisions:
        _add_collision(link, collision)
    for visual in spec.visuals:
        _add_visual(link, visual)
    _put(link, 'gravity', spec.gravity, plain.gravity)
    _put(link, 'self_collide', spec.self_collide, plain.self_collide)
    _put(link, 'kinematic', spec.kinematic, plain.kinematic)
    _put(link, 'velocity_decay/linear', spec.linear_damping, plain.linear_damping)
    _put(link, 'velocity_decay/angular', spec.angular_damping, plain.angular_damping)
    for sensor in spec.sensors:
        _add_sensor(link, sensor)
    for part in spec.parts:
        _add_element(link, part)


def _add_inertial(link: etree._Element, spec: Inertial) -> None:
    inertial = etree.SubElement(link, 'inertial')
    _put(inertial, 'mass', spec.mass)
    _put_pose(inertial, spec.pose)
    for key in _MOMENTS:
        _put(inertial, f'inertia/{key}', getattr(spec, key))


def _add_collision(link: etree._Element, spec: Collision) -> None:
    collision = etree.SubElement(link, 'collision', name=spec.name)
    _put_pose(collision, spec.pose)
    _add_geometry(collision, spec.geometry)
    plain = Surface()
    for field, path in _SURFACE.items():
        _put(collision, path, getattr(spec.surface, field), getattr(plain, field))


def _add_visual(link: etree._Element, spec: Visual) -> None:
    visual = etree.SubElement(link, 'visual', name=spec.name)
    _put_pose(visual, spec.pose)
    _add_geometry(visual, spec.geometry)
    if spec.material is not None and spec.material != Material():
        _add_material(visual, spec.material)


def _add_material(visual: etree._Element, spec: Material) -> None:
    """Write the script, and the colours that are not the script's."""
    base = gazebo_material(spec.script) or Material()
    if spec.script:
        _put(visual, 'material/script/uri', _SCRIPTS)
        _put(visual, 'material/script/name', spec.script)
    own, others = spec.reflection, base.reflection
    alpha = spec.rgba[3]
    written = [tag for tag in _COLOURS if getattr(own, tag) != getattr(others, tag)]
    if 'diffuse' not in written and spec.rgba[:3] == own.diffuse != base.rgba[:3]:
        written.append('diffuse')
    for tag in written:
        _put(visual, f'material/{tag}', (*getattr(own, tag), alpha))
    if not {'ambient', 'diffuse'} & set(written) and alpha != base.rgba[3]:
        _put(visual, 'transparency', 1.0 - alpha / base.rgba[3])


def _add_geometry(shape: etree._Element, geometry: Geometry) -> None:
    within = etree.SubElement(shape, 'geometry')
    match geometry:
        case Box(size):
            _put(within, 'box/size', size)
        case Sphere(radius):
            _put(within, 'sphere/radius', radius)
        case Cylinder(radius, length):
            _put(within, 'cylinder/radius', radius)
            _put(within, 'cylinder/length', length)
        case Plane(normal, size):
            _put(within, 'plane/normal', normal)
            _put(within, 'plane/size', size)
        case Mesh(path, scale, uri):
            _put(within, 'mesh/uri', uri or path)
            _put(within, 'mesh/scale', scale, (1.0, 1.0, 1.0))


def _add_joint(model: etree._Element, spec: JointSpec) -> None:
    joint = etree.SubElement(model, 'joint', name=spec.name, type=spec.type)
    _put(joint, 'parent', spec.parent)
    _put(joint, 'child', spec.child)
    _put_pose(joint, spec.pose)
    if spec.type == FIXED:
        return
    _put(joint, 'axis/xyz', spec.axis)
    _put(joint, 'axis/limit/lower', -_ENDLESS if spec.lower is None else spec.lower)
    _put(joint, 'axis/limit/upper', _ENDLESS if spec.upper is None else spec.upper)
    for field in ('effort', 'velocity'):
        limit = getattr(spec, field)
        if limit is not None:
            _put(joint, f'axis/limit/{field}', limit)
    _put(joint, 'axis/dynamics/damping', spec.damping, 0.0)
    _put(joint, 'axis/dynamics/friction', spec.friction, 0.0)
    _put(joint, 'axis/dynamics/spring_stiffness', spec.stiffness, 0.0)
    _put(joint, 'axis/dynamics/spring_reference', spec.reference, 0.0)


def _add_plugin(parent: etree._Element, spec: PluginSpec) -> None:
    plugin = _add_element(parent, spec.element)
    plugin.set('name', spec.name)
    plugin.set('filename', spec.filename)


def _add_sensor(link: etree._Element, spec: SensorSpec) -> None:
    """Write a sensor as it was described, but at its pose in the link."""
    sensor = _add_element(link, spec.element)
    for pose in sensor.findall('pose'):
        sensor.remove(pose)
    _put_pose(sensor, spec.pose)


def _add_element(parent: etree._Element, spec: Element) -> etree._Element:
    element = etree.SubElement(parent, spec.tag, dict(spec.attributes))
    element.text = spec.text or None
    for child in spec.children:
        _add_element(element, child)
    return element
