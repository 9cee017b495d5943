"""Write a world as a world file, from which the same world is read."""

from lxml import etree

from ...core import NANOSECONDS
from ...description import SPOT, LightSpec, ModelState, PhysicsSettings, SceneSpec, WorldSpec
from .elements import (
    add_element,
    add_plugin,
    add_pose,
    new_document,
    put,
    put_pose,
    text_of_document,
    text_of_value,
)
from .exact import AXES, EFFORT, EXACT, TARGET, VELOCITY
from .physics import CONE, FRICTION, PATHS
from .scene import READ_OF_SCENE
from .writer import add_model


def sdf_of_world(spec: WorldSpec) -> str:
    """Return a world file. Models have the names of their specs."""
    root = new_document()
    world = etree.SubElement(root, 'world', name=spec.name)
    _add_physics(world, spec.physics)
    scene = _add_scene(world, spec.scene)
    for part in spec.parts:
        if part.tag == 'scene':
            for child in part.children:
                add_element(scene, child)
        else:
            add_element(world, part)
    if spec.scene.user_camera is not None and world.find('gui') is None:
        camera = etree.SubElement(etree.SubElement(world, 'gui'), 'camera', name='user_camera')
        add_pose(camera, spec.scene.user_camera)
    for light in spec.lights:
        _add_light(world, light)
    for model, pose in spec.models:
        add_model(world, model, pose)
    for plugin in spec.plugins:
        add_plugin(world, plugin)
    _add_states(world, spec)
    return text_of_document(root)


def sdf_of_light(spec: LightSpec) -> str:
    """Return an SDF document with one light."""
    root = new_document()
    _add_light(root, spec)
    return text_of_document(root)


def _add_physics(world: etree._Element, physics: PhysicsSettings) -> None:
    put(world, 'gravity', physics.gravity)
    element = etree.SubElement(world, 'physics', name='default_physics', default='1', type='ode')
    for field, paths in PATHS.items():
        if field != 'gravity':
            put(element, paths[0], getattr(physics, field))
    put(element, 'real_time_factor', physics.step_size * physics.max_update_rate)
    if physics.friction_cone:
        put(element, FRICTION, CONE)


def _add_scene(world: etree._Element, scene: SceneSpec) -> etree._Element:
    element = etree.SubElement(world, 'scene')
    for field in READ_OF_SCENE:
        put(element, field, getattr(scene, field))
    return element


def _add_light(parent: etree._Element, spec: LightSpec) -> None:
    light = etree.SubElement(parent, 'light', name=spec.name, type=spec.type)
    put_pose(light, spec.pose)
    put(light, 'cast_shadows', spec.cast_shadows)
    put(light, 'diffuse', spec.diffuse)
    put(light, 'specular', spec.specular)
    put(light, 'attenuation/range', spec.range)
    put(light, 'attenuation/constant', spec.attenuation_constant)
    put(light, 'attenuation/linear', spec.attenuation_linear)
    put(light, 'attenuation/quadratic', spec.attenuation_quadratic)
    put(light, 'direction', spec.direction)
    if spec.type == SPOT:
        put(light, 'spot/inner_angle', spec.spot_inner_angle)
        put(light, 'spot/outer_angle', spec.spot_outer_angle)
        put(light, 'spot/falloff', spec.spot_falloff)


def _add_states(world: etree._Element, spec: WorldSpec) -> None:
    if not (spec.states or spec.time):
        return
    state = etree.SubElement(world, 'state', {'world_name': spec.name, EXACT: 'true'})
    seconds, nanoseconds = divmod(round(spec.time * NANOSECONDS), NANOSECONDS)
    put(state, 'sim_time', f'{seconds} {nanoseconds}')
    put(state, 'iterations', str(round(spec.time / spec.physics.step_size)))
    for model in spec.states:
        _add_state(state, model)


def _add_state(parent: etree._Element, state: ModelState) -> None:
    model = etree.SubElement(parent, 'model', name=state.name)
    if state.pose is not None:
        add_pose(model, state.pose)
    for name, (position, velocity) in state.joints.items():
        joint = etree.SubElement(model, 'joint', {'name': name, VELOCITY: repr(velocity)})
        if name in state.motors:
            target, effort = state.motors[name]
            joint.set(TARGET, repr(target))
            joint.set(EFFORT, repr(effort))
        put(joint, 'angle', position)
        joint[0].set('axis', '0')
    for name, pose in state.links.items():
        link = etree.SubElement(model, 'link', name=name)
        add_pose(link, pose)
        axes = state.axes.get(name)
        if axes is not None:
            link.set(AXES, text_of_value((*axes.position, *axes.orientation)))
        twist = state.twists.get(name)
        if twist is not None:
            put(link, 'velocity', (*twist.linear, *twist.angular))
