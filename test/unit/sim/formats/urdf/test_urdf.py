"""Models from URDF; errors give location, reason and cure."""

import logging
import math

import pytest
from support.refusals import sentence_of
from support.urdf import INERTIAL, joint, link

from rosbots_description.sim.core.errors import ModelError
from rosbots_description.sim.core.transforms import Pose, from_rpy
from rosbots_description.sim.description import (
    Box,
    Cylinder,
    Material,
    Mesh,
    Sphere,
    gazebo_material,
)
from rosbots_description.sim.formats.urdf.urdf import load_urdf
from rosbots_description.sim.resources.uris import UnknownPackage

TWO = link('a') + link('b')
BALL = '<geometry><sphere radius="1"/></geometry>'
TRIANGLE = 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n'


def load(body, **options):
    spec, _ = load_urdf(f'<robot name="r">{body}</robot>', 'bot', source='bot.urdf', **options)
    return spec


def only(kind='continuous', inside=''):
    """Return the joint of two links."""
    (made,) = load(TWO + joint('j', 'a', 'b', kind, inside)).joints
    return made


def error_message(body):
    sentence = sentence_of(ModelError, load, body)
    assert sentence.startswith('bot.urdf, line ')
    return sentence


def geometry(shape, name='a'):
    return link(name, f'{INERTIAL}<collision><geometry>{shape}</geometry></collision>')


def test_obstacle_of_the_course_loads_with_a_physical_inertia(caplog):
    text = """<robot name="simple_box"><link name="my_box">
      <inertial><origin xyz="2 0 0"/><mass value="1.0"/>
        <inertia ixx="1.0" ixy="0.0" ixz="0.0" iyy="100.0" iyz="0.0" izz="1.0"/></inertial>
      <visual><origin xyz="2 0 1"/><geometry><box size="1 1 2"/></geometry></visual>
      <collision><origin xyz="2 0 1"/><geometry><box size="1 1 2"/></geometry></collision>
      </link><gazebo reference="my_box"><material>Gazebo/Blue</material></gazebo></robot>"""
    spec, pose = load_urdf(text, 'my_object')
    box = spec.link('my_box')
    assert pose == Pose()
    assert spec.name == 'my_object'
    assert box.collisions[0].geometry == Box((1.0, 1.0, 2.0))
    assert box.collisions[0].pose.position == (2.0, 0.0, 1.0)
    assert box.visuals[0].material == gazebo_material('Gazebo/Blue')
    # Nearest to (1, 100, 1): a, 2a, a with a = 101/3.
    assert (box.inertial.ixx, box.inertial.iyy, box.inertial.izz) == pytest.approx(
        (101 / 3, 202 / 3, 101 / 3)
    )
    (message,) = caplog.messages
    assert 'ixx=1 iyy=100 izz=1 ixy=0' in message
    assert 'ixx=33.6667 iyy=67.3333 izz=33.6667 ixy=0' in message
    assert box.inertial.pose.position == (2.0, 0.0, 0.0)


def test_poses_of_links_follow_from_the_joints():
    spec = load(
        link('a')
        + link('b')
        + link('c')
        + joint('ab', 'a', 'b', inside='<origin xyz="1 0 0" rpy="0 0 1.5707963267948966"/>')
        + joint('bc', 'b', 'c', inside='<origin xyz="1 0 0"/>')
    )
    assert spec.link('b').pose == Pose((1.0, 0.0, 0.0), from_rpy(0.0, 0.0, math.pi / 2))
    assert spec.link('c').pose.position == pytest.approx((1.0, 1.0, 0.0))


def test_links_are_depth_first_in_order_of_joint_names():
    spec = load(
        link('late')
        + link('root')
        + link('early')
        + link('deep')
        + joint('z', 'root', 'late')
        + joint('a', 'root', 'early')
        + joint('b', 'early', 'deep')
    )
    assert [link.name for link in spec.links] == ['root', 'early', 'deep', 'late']
    assert [joint.name for joint in spec.joints] == ['a', 'b', 'z']


def test_a_revolute_joint_has_its_limits_and_unit_axis():
    j = only(
        'revolute',
        '<axis xyz="0 3 4"/><limit lower="-1" upper="2" effort="5" velocity="6"/>'
        '<dynamics damping="0.1" friction="0.2"/>',
    )
    assert (j.type, j.parent, j.child, j.pose) == ('revolute', 'a', 'b', Pose())
    assert j.axis == pytest.approx((0.0, 0.6, 0.8))
    assert (j.lower, j.upper, j.effort, j.velocity) == (-1.0, 2.0, 5.0, 6.0)
    assert (j.damping, j.friction) == (0.1, 0.2)


def test_continuous_joint_has_no_limits_and_axis_x_by_default():
    j = only(inside='<limit lower="-1" upper="1" effort="5" velocity="-1"/>')
    assert (j.lower, j.upper, j.effort, j.velocity) == (None, None, 5.0, None)
    assert j.axis == (1.0, 0.0, 0.0)


def test_short_axis_is_normalised():
    assert only(inside='<axis xyz="0 0 -1e-200"/>').axis == (0.0, 0.0, -1.0)


def test_reversed_limits_are_swapped_with_a_warning(caplog):
    j = only('prismatic', '<limit lower="2" upper="-1" effort="0" velocity="0"/>')
    assert (j.lower, j.upper, j.effort, j.velocity) == (-1.0, 2.0, 0.0, 0.0)
    assert 'the two are swapped' in caplog.text


@pytest.mark.parametrize('kind', ['floating', 'planar'])
def test_unconstrained_joint_leaves_its_child_free_with_a_warning(kind, caplog):
    spec = load(TWO + joint('j', 'a', 'b', kind, '<origin xyz="0 0 2"/>'))
    assert spec.joints == ()
    assert spec.link('b').pose.position == (0.0, 0.0, 2.0)
    assert f"joint 'j': a {kind} joint imposes no constraint here" in caplog.text


def test_all_shapes_are_read():
    shapes = ['<box size="1 2 3"/>', '<sphere radius="1"/>', '<cylinder radius="1" length="2"/>']
    collisions = (f'<collision><geometry>{shape}</geometry></collision>' for shape in shapes)
    spec = load(link('a', INERTIAL + ''.join(collisions)))
    assert [c.geometry for c in spec.links[0].collisions] == [
        Box((1.0, 2.0, 3.0)),
        Sphere(1.0),
        Cylinder(1.0, 2.0),
    ]
    assert [c.name for c in spec.links[0].collisions] == [
        'a_collision',
        'a_collision_1',
        'a_collision_2',
    ]


def test_mesh_is_found_in_its_package_and_keeps_its_uri(tmp_path):
    (tmp_path / 'm.obj').write_text(TRIANGLE)
    spec = load(
        geometry('<mesh filename="package://p/m.obj" scale="1 -2 3"/>'),
        find_package={'p': str(tmp_path)}.get,
    )
    (shape,) = spec.links[0].collisions
    assert shape.geometry == Mesh(str(tmp_path / 'm.obj'), (1.0, -2.0, 3.0), 'package://p/m.obj')


@pytest.mark.parametrize(
    ('material', 'colour'),
    [
        ('<material name="mine"><color rgba="0.1 0.2 0.3 1"/></material>', (0.1, 0.2, 0.3, 1.0)),
        ('<material name="global"/>', (0.4, 0.5, 0.6, 1.0)),
        ('<material name="Gazebo/Red"/>', (1.0, 0.0, 0.0, 1.0)),
        ('<material name="of_another_link"/>', (0.9, 0.8, 0.7, 1.0)),
        ('', (0.7, 0.7, 0.7, 1.0)),
    ],
)
def test_visual_has_the_colour_of_the_urdf_or_grey(material, colour, caplog):
    spec = load(
        '<material name="global"><color rgba="0.4 0.5 0.6 1"/></material>'
        + link('a', f'{INERTIAL}<visual>{BALL}{material}</visual>')
        + link(
            'b',
            f'{INERTIAL}<visual>{BALL}<material name="of_another_link">'
            '<color rgba="0.9 0.8 0.7 1"/></material></visual>',
        )
        + joint('j', 'a', 'b')
    )
    assert spec.link('a').visuals[0].material.rgba == colour
    assert caplog.text == ''


def test_a_material_without_colour_is_grey_with_a_warning(caplog):
    visual = f'<visual>{BALL}<material name="bleu"/></visual>'
    blue = '<material name="blue"><color rgba="0 0 1 1"/></material>'
    spec = load(blue + link('a', INERTIAL + visual))
    assert spec.links[0].visuals[0].material == Material()
    assert (
        "material 'bleu': it has no <color> anywhere; grey is shown; did you mean 'blue'?"
        in caplog.text
    )


def test_a_mesh_without_material_keeps_its_own_colours(tmp_path):
    (tmp_path / 'm.obj').write_text(TRIANGLE)
    visual = f'<visual><geometry><mesh filename="{tmp_path}/m.obj"/></geometry></visual>'
    spec = load(link('a', INERTIAL + visual))
    assert spec.links[0].visuals[0].material is None


def test_origin_of_the_robot_is_returned():
    _, pose = load_urdf(f'<robot><origin xyz="1 2 3" rpy="0 0 1"/>{link("a")}</robot>', 'bot')
    assert pose == Pose((1.0, 2.0, 3.0), from_rpy(0.0, 0.0, 1.0))


def test_malformed_origin_of_the_robot_is_ignored_with_an_error(caplog):
    _, pose = load_urdf(f'<robot><origin xyz="1 x 3"/>{link("a")}</robot>', 'bot')
    assert pose == Pose()
    assert [record.levelno for record in caplog.records] == [logging.ERROR]


def test_zero_inertia_is_replaced_with_a_warning(caplog):
    zero = '<inertia ixx="0" iyy="0" izz="0" ixy="0" ixz="0" iyz="0"/>'
    spec = load(link('a', f'<inertial><mass value="2"/>{zero}</inertial>'))
    inertial = spec.links[0].inertial
    assert inertial.mass == 2.0
    assert min(inertial.ixx, inertial.iyy, inertial.izz) > 0.0
    assert "'a': an inertia of zero cannot be simulated" in caplog.text


def test_elements_without_use_in_simulation_are_not_reported(caplog):
    load(
        link('a')
        + '<transmission name="t"><x/></transmission><unknown/>'
        + link('b')
        + joint('j', 'a', 'b', inside='<mimic joint="j"/><safety_controller/>')
    )
    assert caplog.text == ''


@pytest.mark.parametrize(
    ('body', 'expected'),
    [
        ('', 'the model has no <link>'),
        (link('a') + link('a'), "the link 'a' is already defined in line 1"),
        (
            TWO + link('c') + joint('j', 'a', 'b') + joint('j', 'a', 'c'),
            "joint 'j': the joint 'j' is already defined in line 1",
        ),
        (
            TWO,
            "2 links are not the child of any joint: 'a' (line 1), 'b' (line 1)",
        ),
        (
            TWO + joint('j', 'a', 'b') + joint('k', 'b', 'a'),
            "joint 'j': the joints form a loop; one link must have no parent joint",
        ),
        (
            TWO + link('c') + joint('j', 'b', 'c') + joint('k', 'c', 'b'),
            "the joints of 'b', 'c' form a loop that is not connected to the root 'a'",
        ),
        (link('a') + joint('j', 'a', 'a'), 'the joints form a loop'),
        (
            TWO + link('c') + joint('j', 'a', 'c') + joint('k', 'b', 'c'),
            "joint 'k': child link 'c' is already the child of joint 'j' (line 1)",
        ),
        (
            link('base') + link('wheel') + joint('j1', 'base', 'whel'),
            "joint 'j1': child link 'whel' does not exist; did you mean 'wheel'?",
        ),
        (
            link('base') + joint('j1', 'chassis', 'base'),
            "joint 'j1': parent link 'chassis' does not exist; there are 'base'",
        ),
        (
            link('a') + '<joint name="j" type="fixed"><child link="a"/></joint>',
            "joint 'j': it has no parent link; add <parent link=",
        ),
        (
            link('a') + '<joint name="j" type="fixed"><parent link="a"/></joint>',
            "joint 'j': it has no child link; add <child link=",
        ),
        (
            TWO + joint('j', 'a', 'b', 'hinge'),
            "type 'hinge' is unknown; there are revolute",
        ),
        (TWO + joint('j', 'a', 'b', ''), 'it has no type; there are revolute'),
        ('<link/>', 'a <link> without name'),
        (link('n' * 1001), 'its name has 1001 characters; at most 1000'),
        (TWO + joint('j' * 1100, 'a', 'b'), 'its name has 1100 characters'),
    ],
)
def test_invalid_tree_is_rejected_with_location(body, expected):
    assert expected in error_message(body)


@pytest.mark.parametrize(
    ('inside', 'expected'),
    [
        ('<axis xyz="0 1"/>', 'xyz="0 1" of <axis> is wrong; it takes three finite numbers'),
        ('<axis xyz="0 0 nan"/>', 'xyz="0 0 nan" of <axis> is wrong'),
        ('<origin xyz="0 a 0"/>', 'xyz="0 a 0" of <origin> is wrong'),
        ('<origin rpy="0 inf 0"/>', 'rpy="0 inf 0" of <origin> is wrong'),
        ('<origin xyz="1,5 0 0"/>', 'xyz="1,5 0 0" of <origin> is wrong'),
        ('<origin xyz="1_0 0 0"/>', 'xyz="1_0 0 0" of <origin> is wrong'),
        (
            '<limit effort="x" velocity="1"/>',
            'effort="x" of <limit> is wrong; it takes one finite number',
        ),
        ('<limit effort="1"/>', '<limit> has no velocity; it takes one finite number'),
        ('<limit effort="1" velocity="1" upper="1e999"/>', 'upper="1e999" of <limit> is wrong'),
    ],
)
def test_malformed_number_in_a_joint_is_rejected_with_location(inside, expected):
    sentence = error_message(TWO + joint('j', 'a', 'b', inside=inside))
    assert "line 1: joint 'j': " + expected in sentence


@pytest.mark.parametrize('kind', ['revolute', 'prismatic'])
def test_joint_without_its_required_limits_is_rejected(kind):
    assert f'a {kind} joint needs <limit lower upper effort velocity/>' in error_message(
        TWO + joint('j', 'a', 'b', kind)
    )


def inertial(mass='1', **moments):
    values = {'ixx': '1', 'iyy': '1', 'izz': '1', 'ixy': '0', 'ixz': '0', 'iyz': '0'} | moments
    text = ' '.join(f'{key}="{value}"' for key, value in values.items())
    return link('a', f'<inertial><mass value="{mass}"/><inertia {text}/></inertial>')


@pytest.mark.parametrize(
    ('body', 'expected'),
    [
        (inertial('-1'), 'mass -1 kg is negative'),
        (inertial('abc'), 'value="abc" of <mass> is wrong; it takes one finite number'),
        (inertial('1,5'), 'value="1,5" of <mass> is wrong'),
        (inertial('nan'), 'value="nan" of <mass> is wrong'),
        (
            inertial(ixx='-1'),
            'ixx="-1" of <inertia> is not valid; a moment of inertia must be greater than zero',
        ),
        (inertial(iyy='inf'), 'iyy="inf" of <inertia> is wrong'),
        (link('a', '<inertial><mass value="1"/></inertial>'), 'an <inertial> without <inertia'),
        (
            link('a', '<inertial><inertia ixx="1" iyy="1" izz="1"/></inertial>'),
            'an <inertial> without <mass',
        ),
        (
            link('a', '<inertial><mass value="1"/><inertia ixx="1" izz="1"/></inertial>'),
            '<inertia> has no iyy',
        ),
        (geometry('<box size="1 -1 1"/>'), 'size="1 -1 1" of <box> is not valid; a size must be'),
        (
            geometry('<box size="1 1"/>'),
            'size="1 1" of <box> is wrong; it takes three finite numbers',
        ),
        (geometry('<box/>'), '<box> has no size'),
        (geometry('<sphere radius="-1"/>'), 'radius="-1" of <sphere> is not valid'),
        (geometry('<cylinder radius="1" length="-1"/>'), 'length="-1" of <cylinder> is not valid'),
        (
            geometry('<capsule radius="1"/>'),
            "geometry 'capsule' is unknown; there are box, cylinder",
        ),
        (geometry('<mesh/>'), 'a <mesh> without filename'),
        (geometry(''), 'a <collision> without shape'),
        (link('a', INERTIAL + '<visual/>'), 'a <visual> without shape'),
    ],
)
def test_invalid_part_of_a_link_is_rejected_with_location(body, expected):
    sentence = error_message(body)
    assert expected in sentence
    assert "'a': " in sentence or "'m': " in sentence


def test_unknown_package_raises_its_own_error():
    body = link('a') + '<gazebo><plugin filename="x"><f>package://nope/x</f></plugin></gazebo>'
    with pytest.raises(UnknownPackage) as caught:
        load(body, find_package={}.get)
    assert caught.value.package == 'nope'


def test_other_root_element_than_robot_is_rejected():
    with pytest.raises(ModelError, match=r'^s, line 1: the first element is <sdf>'):
        load_urdf('<sdf version="1.6"/>', 'bot', source='s')


@pytest.mark.parametrize(
    'body',
    [
        link('a', ''),
        inertial('0'),
        link('world', ''),
        link('world', '') + link('a', '') + joint('j', 'world', 'a', 'fixed'),
    ],
)
def test_model_without_mass_is_rejected(body):
    assert 'with a' in error_message(body)


def test_warning_begins_with_model_and_source(caplog):
    load(link('a') + '\n<gazebo reference="b"/>')
    assert caplog.messages[0].startswith(
        "model 'bot' (bot.urdf): line 2: <gazebo reference='b'>: there is no link or joint"
    )


def test_long_chain_of_fixed_links_is_reduced_quickly():
    count = 5000
    collision = f'<collision>{BALL}</collision>'
    links = link('l0') + ''.join(link(f'l{i}', collision) for i in range(1, count))
    joints = ''.join(
        joint(f'j{i}', f'l{i}', f'l{i + 1}', 'fixed', '<origin xyz="0 0 1"/>')
        for i in range(count - 1)
    )
    spec = load(links + joints)
    assert len(spec.links) == 1
    assert spec.links[0].collisions[-1].pose.position == (0.0, 0.0, count - 1.0)
