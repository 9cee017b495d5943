"""A model that is written as SDF is read as the same model."""

from dataclasses import fields, is_dataclass, replace

import pytest
from support import ROOT
from support.urdf import INERTIAL

from rosbots_description.sim import Pose, from_rpy
from rosbots_description.sim.core import rotate
from rosbots_description.sim.description import (
    Box,
    Collision,
    Cylinder,
    Element,
    Inertial,
    JointSpec,
    LinkSpec,
    Material,
    ModelSpec,
    Plane,
    Sphere,
    Surface,
    Visual,
)
from rosbots_description.sim.formats import load_sdf, load_urdf, sdf_of_model

RECORDED = ROOT / 'test' / 'data' / 'gazebo'
ROBOTS = sorted([*RECORDED.glob('robots/*.urdf'), *RECORDED.glob('sensors/robots/*.urdf')])
# Where it was read, and what a URDF has lost by its conversion to SDF.
NOT_WRITTEN = {'line', 'location', 'reduced', 'nested', 'left_out'}
VISUAL = '<visual><geometry><box size="1 2 3"/></geometry>{}</visual>'
COLOUR = '<material name="m"><color rgba="{}"/></material>'
FIND = {'rosbots_description': str(ROOT)}.get
PLACE = Pose((0.1, -2.0, 3.0), from_rpy(0.1, -0.2, 2.5))


def flat(value):
    """Return the numbers and names of a value by their paths; rotations as the turned axes."""
    if isinstance(value, Pose):
        turned = [rotate(value.orientation, axis) for axis in ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0))]
        value = (value.position, *turned)
    if is_dataclass(value):
        inner = {
            field.name: getattr(value, field.name)
            for field in fields(value)
            if field.name not in NOT_WRITTEN
        }
    elif isinstance(value, dict):
        inner = value
    elif isinstance(value, tuple):
        inner = dict(enumerate(value))
    else:
        return {'': value}
    return {
        f'{key}/{path}': leaf for key, part in inner.items() for path, leaf in flat(part).items()
    }


def require_same(urdf):
    """Compare a URDF with what is read from the SDF that is written of it."""
    return require_same_model(*load_urdf(urdf, 'robot', find_package=FIND))


def require_same_model(spec, pose):
    """Compare a model with what is read from the SDF that is written of it."""
    again, place = load_sdf(
        sdf_of_model(spec, pose), 'robot', find_model=lambda inner: None, find_package=FIND
    )
    spec = replace(spec, control=None)  # SDF has no transmissions
    found, wanted = flat((again, place)), flat((spec, pose))
    # A sensor's element is as it was, except for its pose, which is told apart.
    wrong = {
        path: (found.get(path), value)
        for path, value in wanted.items()
        if '/element/' not in path and found.get(path) != pytest.approx(value, abs=1e-12)
    }
    assert wrong == {}
    assert len(again.links) == len(spec.links)
    return again


@pytest.mark.parametrize('robot', ROBOTS, ids=lambda path: path.stem)
def test_a_robot_is_read_as_it_was_written(robot):
    require_same(robot.read_text(encoding='utf-8'))


@pytest.mark.parametrize(
    'looks',
    ['', COLOUR.format('1 1 1 1'), COLOUR.format('0.25 0.5 0.75 0.5'), COLOUR.format('0 0 0 1')],
)
@pytest.mark.parametrize('script', ['', 'Gazebo/Red', 'Gazebo/SkyBlue', 'Gazebo/GreenTransparent'])
def test_colours_are_written_so_that_they_are_shown_the_same(looks, script):
    material = f'<gazebo reference="l"><material>{script}</material></gazebo>' if script else ''
    require_same(
        f'<robot name="r"><link name="l">{INERTIAL}{VISUAL.format(looks)}</link>{material}</robot>'
    )


def test_contacts_that_differ_from_the_defaults_are_written():
    again = require_same(
        f'<robot name="r"><link name="l">{INERTIAL}<collision><geometry><sphere radius="0.1"/>'
        '</geometry></collision></link><gazebo reference="l"><mu1>0.3</mu1><mu2>0.2</mu2>'
        '<kp>1e5</kp><fdir1>1 0 0</fdir1><maxVel>0.5</maxVel></gazebo></robot>'
    )
    surface = again.links[0].collisions[0].surface
    assert (surface.mu, surface.mu2, surface.kp, surface.max_vel) == (0.3, 0.2, 1e5, 0.5)


def test_a_mesh_is_written_with_its_address_and_scale():
    again = require_same(
        f'<robot name="r"><link name="l">{INERTIAL}<collision><geometry><mesh scale="2 3 0.5" '
        'filename="package://rosbots_description/meshes/battery.dae"/></geometry></collision>'
        '</link></robot>'
    )
    (collision,) = again.links[0].collisions
    assert (collision.geometry.scale, collision.geometry.path) == (
        (2.0, 3.0, 0.5),
        str(ROOT / 'meshes' / 'battery.dae'),
    )


def test_a_plugin_keeps_its_tags():
    again = require_same(
        f'<robot name="r"><link name="l">{INERTIAL}</link><gazebo><plugin name="p" '
        'filename="libp.so"><rate unit="Hz">20</rate><a><b>c &lt; d</b></a></plugin></gazebo>'
        '</robot>'
    )
    (plugin,) = again.plugins
    assert (plugin.name, plugin.filename) == ('p', 'libp.so')
    rate, outer = plugin.element.children
    assert (rate.text, rate.attributes) == ('20', {'unit': 'Hz'})
    assert isinstance(outer, Element)
    assert outer.children[0].text == 'c < d'


def test_every_field_is_written():
    shapes = Box((1.0, 2.0, 3.0)), Sphere(0.5), Cylinder(0.25, 2.0)
    surface = Surface(
        0.5, 0.25, (0.0, 1.0, 0.0), 1e5, 10.0, 0.5, 0.002, 3, 7.0, 0.75, 0.125, 2.0, 3.0
    )
    moving = LinkSpec(
        'moving',
        PLACE,
        Inertial(2.0, PLACE, 1.0, 1.1, 1.2, 0.01, 0.02, 0.03),
        tuple(Collision(f'c{n}', shape, PLACE, surface) for n, shape in enumerate(shapes)),
        tuple(Visual(f'v{n}', shape, PLACE) for n, shape in enumerate(shapes)),
        gravity=False,
        self_collide=True,
        linear_damping=0.1,
        angular_damping=0.2,
    )
    base = LinkSpec('base', inertial=Inertial(1.0, ixx=1.0, iyy=1.0, izz=1.0), kinematic=True)
    joints = (
        JointSpec(
            'slide',
            'prismatic',
            'base',
            'moving',
            PLACE,
            (1.0, 0.0, 0.0),
            -1.0,
            2.0,
            3.0,
            4.0,
            5.0,
            6.0,
            7.0,
            0.5,
        ),
    )
    visible = replace(
        moving, visuals=tuple(replace(visual, material=Material()) for visual in moving.visuals)
    )
    require_same_model(ModelSpec('robot', (base, visible), joints), PLACE)


def test_a_static_model_stays_static():
    ground = Collision('c', Plane((0.0, 0.6, 0.8), (3.0, 4.0)))
    again = require_same_model(
        ModelSpec('robot', (LinkSpec('l', collisions=(ground,)),), static=True), PLACE
    )
    assert again.static
