"""The URDF generated for PyBullet."""

import math
from xml.etree import ElementTree

import pytest
from support import robot_spec

from rosbots_description.sim.core.transforms import Pose, from_rpy
from rosbots_description.sim.description.model_spec import (
    FIXED,
    PRISMATIC,
    REVOLUTE,
    Box,
    Collision,
    Inertial,
    JointSpec,
    LinkSpec,
    Mesh,
    ModelSpec,
)
from rosbots_description.sim.physics.bullet.generated_urdf import (
    describe_tree,
    filtered_links,
    kinematic_trees,
)
from rosbots_description.sim.physics.bullet.shape_groups import surface_groups


def test_generated_urdf_has_no_visuals():
    (tree,) = kinematic_trees(robot_spec())
    count = len(tree.links)
    groups = [surface_groups(tree, i) for i in range(count)]
    text = describe_tree(tree, [Pose()] * count, groups, lambda mesh: mesh.path)
    touching = [
        link
        for link in ElementTree.fromstring(text).findall('link')
        if link.find('collision') is not None
    ]
    assert touching
    for link in touching:
        (seen,) = link.findall('visual')
        assert [shape.tag for shape in seen.find('geometry')] == ['box']


def links(*names, **given):
    return tuple(LinkSpec(name, **given) for name in names)


def shown(trees):
    """Return names of links, kinds of joints, and what does not move, of each tree."""
    return [
        (
            [link.name for link in tree.links],
            [one and one.type for one in tree.joints],
            tree.fixed_base,
            tree.is_static,
        )
        for tree in trees
    ]


@pytest.mark.parametrize(
    ('spec', 'trees'),
    [
        (
            ModelSpec('m', links('a', 'b'), (JointSpec('j', REVOLUTE, 'a', 'b'),), static=True),
            [(['a'], [None], True, True), (['b'], [None], True, True)],
        ),
        (
            ModelSpec('m', links('a', 'b', 'c'), (JointSpec('j', REVOLUTE, 'a', 'b'),)),
            [(['a', 'b'], [None, REVOLUTE], False, False), (['c'], [None], False, False)],
        ),
        (ModelSpec('m', links('a', kinematic=True)), [(['a'], [None], True, True)]),
        (
            ModelSpec(
                'm',
                links('a', 'b'),
                (JointSpec('j', FIXED, 'world', 'a'), JointSpec('k', PRISMATIC, 'a', 'b')),
            ),
            [(['a', 'b'], [None, PRISMATIC], True, False)],
        ),
        (
            ModelSpec('m', links('a'), (JointSpec('j', REVOLUTE, 'world', 'a'),)),
            [(['world of a', 'a'], [None, REVOLUTE], True, False)],
        ),
    ],
)
def test_trees_are_fixed_where_the_model_or_a_link_or_a_joint_to_the_world_is(spec, trees):
    assert shown(kinematic_trees(spec)) == trees


def test_two_links_collide_only_if_both_want_it_and_no_joint_connects_them():
    loose = links('a', 'b', 'c', self_collide=True) + links('d')
    spec = ModelSpec(
        'm',
        loose,
        (
            JointSpec('j', REVOLUTE, 'b', 'a'),
            JointSpec('k', REVOLUTE, 'b', 'c'),
            JointSpec('l', REVOLUTE, 'a', 'd'),
        ),
    )
    assert list(filtered_links(spec)) == [
        ('a', 'b'),
        ('a', 'd'),
        ('b', 'c'),
        ('b', 'd'),
        ('c', 'd'),
    ]


def described(spec, more_parts=False):
    """Return the URDF of the first tree of a model, all shapes of a link on itself or apart."""
    tree = kinematic_trees(spec)[0]
    groups = [
        [[one] for one in link.collisions] if more_parts and link.collisions else [link.collisions]
        for link in tree.links
    ]
    poses = [link.inertial.pose if link.inertial else Pose() for link in tree.links]
    return ElementTree.fromstring(describe_tree(tree, poses, groups, lambda mesh: mesh.path))


def numbers(element, name):
    return [float(word) for word in element.get(name).split()]


@pytest.mark.parametrize(
    ('limits', 'kind', 'lower', 'upper'),
    [
        ({}, 'continuous', -1e9, 1e9),
        ({'lower': -1.0, 'upper': 2.0}, 'revolute', -1.0, 2.0),
        ({'lower': -1.0}, 'revolute', -1.0, 1e9),
        ({'upper': 2.0}, 'revolute', -1e9, 2.0),
        ({'lower': 1.0, 'upper': 1.0}, 'revolute', 1.0, 1.000001),  # a locked joint
    ],
)
def test_limits_of_a_joint_are_those_of_the_model_and_never_empty(limits, kind, lower, upper):
    spec = ModelSpec('m', links('a', 'b'), (JointSpec('j', REVOLUTE, 'a', 'b', **limits),))
    (joint,) = described(spec).findall('joint')
    limit = joint.find('limit')
    assert joint.get('type') == kind
    assert (float(limit.get('lower')), float(limit.get('upper'))) == (lower, upper)


@pytest.mark.parametrize('static', [False, True])
def test_meshes_are_exact_only_if_static_and_moving_shapes_wait_for_their_filter(static):
    body = LinkSpec(
        'a',
        inertial=Inertial(2.0),
        collisions=(Collision('hull', Mesh('hull.stl')), Collision('box', Box((1.0, 2.0, 3.0)))),
    )
    (link,) = described(ModelSpec('m', (body,), static=static)).findall('link')
    hull, box = link.findall('collision')
    assert (hull.get('concave'), box.get('concave')) == ('yes' if static else None, None)
    assert {one.get('group') for one in (hull, box)} == {None if static else '2'}
    assert float(link.find('inertial/mass').get('value')) == (0.0 if static else 2.0)
    assert numbers(box.find('geometry/box'), 'size') == [1.0, 2.0, 3.0]


def test_frames_are_those_of_the_joints_and_further_parts_weigh_next_to_nothing():
    turn = from_rpy(0.0, 0.0, math.pi / 2.0)
    box = Collision('box', Box((1.0, 1.0, 1.0)), Pose((0.0, 0.0, 0.5)))
    child = LinkSpec(
        'b', Pose((1.0, 0.0, 0.0), turn), Inertial(3.0, Pose((0.1, 0.0, 0.0))), (box, box)
    )
    joint = JointSpec('j', REVOLUTE, 'a', 'b', pose=Pose((0.2, 0.0, 0.0)), axis=(0.0, 1.0, 0.0))
    parent = LinkSpec('a', inertial=Inertial(1.0))
    robot = described(ModelSpec('m', (parent, child), (joint,)), more_parts=True)
    _, own, further = robot.findall('link')
    fixed, moving = sorted(robot.findall('joint'), key=lambda one: one.get('type') != 'fixed')
    # The joint is 0.2 m along x of the child, which is y of its parent.
    assert numbers(moving.find('origin'), 'xyz') == pytest.approx([1.0, 0.2, 0.0])
    assert numbers(moving.find('origin'), 'rpy') == pytest.approx([0.0, 0.0, math.pi / 2.0])
    assert numbers(moving.find('axis'), 'xyz') == [0.0, 1.0, 0.0]
    assert numbers(own.find('inertial/origin'), 'xyz') == pytest.approx([-0.1, 0.0, 0.0])
    for link in (own, further):
        assert numbers(link.find('collision/origin'), 'xyz') == pytest.approx([-0.2, 0.0, 0.5])
    assert float(further.find('inertial/mass').get('value')) == 1e-9
    assert (fixed.find('parent').get('link'), fixed.find('child').get('link')) == (
        own.get('name'),
        further.get('name'),
    )
