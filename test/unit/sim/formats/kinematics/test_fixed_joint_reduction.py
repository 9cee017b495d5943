"""Reduction of fixed joints as in sdformat: names, masses, poses, references."""

import math
import re
from functools import partial

import numpy as np
import pytest
from support import robot_spec
from support.urdf import INERTIAL, joint, link

from rosbots_description.sim.core.transforms import Pose, compose, from_rpy
from rosbots_description.sim.description.inertia import tensor
from rosbots_description.sim.formats.urdf.urdf import load_urdf

BALL = '<geometry><sphere radius="1"/></geometry>'
COLLISION, VISUAL = f'<collision>{BALL}</collision>', f'<visual>{BALL}</visual>'
TWO = link('a') + link('b') + joint('j', 'a', 'b', 'fixed')
fixed = partial(joint, kind='fixed')


def load(body):
    return load_urdf(f'<robot name="r">{body}</robot>', 'bot')[0]


def names(items):
    return [item.name for item in items]


@pytest.fixture(scope='module')
def article():
    return robot_spec()


def test_the_articles_robot_has_three_links_of_1_4_kg(article):
    assert names(article.links) == ['base_footprint', 'wheel_left_link', 'wheel_right_link']
    assert [link.inertial.mass for link in article.links] == pytest.approx([0.6, 0.4, 0.4])


def test_the_articles_base_has_the_mass_properties_measured_in_gazebo(article):
    base = article.link('base_footprint').inertial
    np.testing.assert_allclose(base.pose.position, (-0.0667, 0.0167, 0.0933), atol=5e-5)
    np.testing.assert_allclose((base.ixx, base.iyy, base.izz), (0.0175, 0.0300, 0.0452), atol=5e-5)


def test_the_articles_wheels_are_children_of_the_base(article):
    left, right = article.joints
    assert (left.name, left.parent, left.child) == (
        'wheel_left_joint',
        'base_footprint',
        'wheel_left_link',
    )
    assert article.link('wheel_right_link').pose == compose(
        Pose((0.0, 0.0, 0.05)), Pose((0.15, -0.5625, 0.3), from_rpy(-1.57, 0.0, 0.0))
    )
    assert right.axis == (0.0, 0.0, 1.0)


def test_the_articles_reduced_shapes_have_gazebos_names(article):
    shapes = names(article.link('base_footprint').collisions)
    assert shapes[:3] == [
        'base_footprint_fixed_joint_lump__base_link_collision',
        'base_footprint_fixed_joint_lump__batery_link_collision_1',
        'base_footprint_fixed_joint_lump__caster_back_link_collision_2',
    ]
    assert len(shapes) == 14
    assert names(article.link('wheel_left_link').collisions) == ['wheel_left_link_collision']


def test_the_articles_reduced_links_have_one_parent(article):
    assert len(article.reduced) == 14
    assert {parent for parent, _ in article.reduced.values()} == {'base_footprint'}


def test_shapes_are_named_and_numbered_as_in_gazebo():
    spec = load(
        link('base', f'{INERTIAL}{COLLISION}<collision name="own">{BALL}</collision>')
        + link('arm', f'{INERTIAL}<collision name="pad">{BALL}</collision>{VISUAL}')
        + link('tip', INERTIAL + COLLISION + VISUAL)
        + link('base_lid', INERTIAL + COLLISION)
        + fixed('a', 'base', 'arm')
        + fixed('b', 'arm', 'tip')
        + fixed('c', 'base', 'base_lid')
    )
    assert names(spec.links[0].collisions) == [
        'base_collision',
        'base_fixed_joint_lump__own_collision_1',
        'base_fixed_joint_lump__pad_collision_2',
        'base_fixed_joint_lump__tip_collision_3',
        'base_lid_collision_4',  # begins with the parent's name, so sdformat adds no prefix
    ]
    assert names(spec.links[0].visuals) == [
        'base_fixed_joint_lump__arm_visual',
        'base_fixed_joint_lump__tip_visual_1',
    ]


def test_shapes_and_joints_are_transformed_into_the_parents_frame():
    quarter = '<origin xyz="1 0 0" rpy="0 0 1.5707963267948966"/>'
    spec = load(
        link('base')
        + link('arm')
        + link('hand', f'{INERTIAL}<collision><origin xyz="1 0 0"/>{BALL}</collision>')
        + link('finger')
        + fixed('a', 'base', 'arm', inside=quarter)
        + fixed('b', 'arm', 'hand', inside=quarter)
        + joint('c', 'hand', 'finger', inside='<origin xyz="0 1 0"/>')
    )
    base, finger = spec.links
    assert base.collisions[0].pose.position == pytest.approx((0.0, 1.0, 0.0))
    assert finger.pose.position == pytest.approx((1.0, 0.0, 0.0))
    assert spec.joints[0].parent == 'base'
    assert spec.joints[0].pose == Pose()


def test_masses_in_rotated_frames_merge_by_the_parallel_axis_theorem():
    inertial = (
        '<inertial><origin xyz="0 0 1"/><mass value="1"/>'
        '<inertia ixx="1" iyy="2" izz="3" ixy="0" ixz="0" iyz="0"/></inertial>'
    )
    spec = load(
        '<link name="base"/>'
        + link('a', inertial)
        + link('b', inertial)
        + fixed('ja', 'base', 'a')
        + fixed('jb', 'base', 'b', inside=f'<origin rpy="{math.pi / 2} 0 0" xyz="0 1 1"/>')
    )
    merged = spec.links[0].inertial
    # Centre of b: (0 1 1) + z rotated to -y = (0 0 1); both centres coincide, y and z of b swap.
    assert merged.mass == 2.0
    np.testing.assert_allclose(merged.pose.position, (0.0, 0.0, 1.0), atol=1e-12)
    np.testing.assert_allclose(tensor(merged), np.diag([2.0, 5.0, 5.0]), atol=1e-12)


def kept(tag, joint_name='j'):
    return f'<gazebo reference="{joint_name}"><{tag}>true</{tag}></gazebo>'


def test_a_preserved_joint_stays_fixed():
    spec = load(TWO + kept('preserveFixedJoint'))
    assert names(spec.links) == ['a', 'b']
    assert (spec.joints[0].type, spec.joints[0].parent) == ('fixed', 'a')


def test_disabled_lumping_makes_a_joint_with_zero_range():
    spec = load(TWO + kept('disableFixedJointLumping'))
    (j,) = spec.joints
    assert (j.type, j.lower, j.upper) == ('revolute', 0.0, 0.0)


@pytest.mark.parametrize(
    'tags',
    [
        ('preserveFixedJoint', 'disableFixedJointLumping'),
        ('disableFixedJointLumping', 'preserveFixedJoint'),
    ],
)
def test_preserve_fixed_joint_takes_precedence_over_disabled_lumping(tags):
    blocks = ''.join(kept(tag) for tag in tags)
    (j,) = load(TWO + blocks).joints
    assert j.type == 'fixed'


def test_robot_below_world_is_fixed_and_reduced():
    spec = load(
        link('world', '')
        + link('base')
        + link('arm')
        + fixed('bolt', 'world', 'base', inside='<origin xyz="0 0 2"/>')
        + fixed('j', 'base', 'arm')
    )
    assert names(spec.links) == ['base']
    assert spec.links[0].pose.position == (0.0, 0.0, 2.0)
    (bolt,) = spec.joints
    assert (bolt.type, bolt.parent, bolt.child) == ('fixed', 'world', 'base')


def test_content_of_the_world_link_is_reported_as_not_simulated(caplog):
    load(link('world', COLLISION) + link('a') + fixed('j', 'world', 'a'))
    assert "'world': a root of that name is the world itself" in caplog.text


def test_movable_link_without_mass_is_left_out_with_its_descendants(caplog):
    spec = load(
        link('base')
        + link('hub', '')
        + link('tyre')
        + link('cap')
        + joint('a', 'base', 'hub')
        + joint('b', 'hub', 'tyre')
        + fixed('c', 'tyre', 'cap')
    )
    assert names(spec.links) == ['base']
    assert spec.joints == ()
    assert len(caplog.messages) == 1
    assert re.search(
        r"'hub': no mass .* not simulated, as in Gazebo: 'hub', 'tyre', 'cap'", caplog.text
    )


def test_fixed_link_without_mass_is_kept_without_its_movable_children(caplog):
    spec = load(
        link('base')
        + link('mount', COLLISION)
        + link('wheel')
        + fixed('a', 'base', 'mount')
        + joint('b', 'mount', 'wheel')
    )
    assert names(spec.links) == ['base']
    assert names(spec.links[0].collisions) == ['base_fixed_joint_lump__mount_collision']
    assert "'mount': no mass" in caplog.text
    assert "as in Gazebo: 'wheel'" in caplog.text


def test_root_without_mass_is_kept_if_a_fixed_child_has_mass(caplog):
    spec = load(
        link('footprint', '')
        + link('base')
        + link('wheel')
        + fixed('a', 'footprint', 'base')
        + joint('b', 'base', 'wheel')
    )
    assert names(spec.links) == ['footprint', 'wheel']
    assert caplog.text == ''
