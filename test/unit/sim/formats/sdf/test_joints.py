"""Joints of SDF: frames of axes, limits, and trees from any graph."""

import math

import pytest
from support.refusals import sentence_of

from rosbots_description.sim.core.errors import ModelError
from rosbots_description.sim.core.transforms import Pose, compose
from rosbots_description.sim.description.model_spec import FIXED, PRISMATIC, REVOLUTE
from rosbots_description.sim.formats.sdf.sdf import load_sdf
from rosbots_description.sim.resources.search_path import ModelSearch

# b is at x = 1 m, rotated by 90 degrees about z: its x axis is the model's y axis.
LINKS = f"""<link name="a"/><link name="b"><pose>1 0 0 0 0 {math.pi / 2}</pose></link>
  <link name="c"><pose>2 0 0 0 0 0</pose></link><link name="d"><pose>3 0 0 0 0 0</pose></link>"""


def load(joints, version='1.6', links=LINKS):
    text = f'<sdf version="{version}"><model name="m">{links}{joints}</model></sdf>'
    return load_sdf(text, 'm', source='m.sdf', find_model=ModelSearch())[0]


def joint(parent='a', child='b', kind='revolute', inside='<axis><xyz>1 0 0</xyz></axis>', name=''):
    return (
        f'<joint name="{name or parent + child}" type="{kind}"><parent>{parent}</parent>'
        f'<child>{child}</child>{inside}</joint>'
    )


def only(*arguments, version='1.6', **options):
    return load(joint(*arguments, **options), version).joints[0]


def error_message(joints):
    sentence = sentence_of(ModelError, load, joints)
    assert sentence.startswith('m.sdf, line ')
    return sentence


def test_a_fixed_joint_stays_a_joint():
    made = only(kind='fixed', inside='')
    assert (made.type, made.parent, made.child, made.pose) == (FIXED, 'a', 'b', Pose())


def test_a_continuous_joint_is_a_revolute_one_without_limits():
    made = only(
        kind='continuous', inside='<axis><limit><lower>0</lower><upper>1</upper></limit></axis>'
    )
    assert (made.type, made.lower, made.upper) == (REVOLUTE, None, None)


@pytest.mark.parametrize(
    ('version', 'inside', 'axis'),
    [
        ('1.4', '<xyz>1 0 0</xyz>', (0.0, -1.0, 0.0)),  # all axes in the model's frame
        ('1.6', '<xyz>1 0 0</xyz>', (1.0, 0.0, 0.0)),
        (
            '1.6',
            '<xyz>1 0 0</xyz><use_parent_model_frame>1</use_parent_model_frame>',
            (0.0, -1.0, 0.0),
        ),
        ('1.7', '<xyz expressed_in="__model__">1 0 0</xyz>', (0.0, -1.0, 0.0)),
        ('1.7', '<xyz expressed_in="b">1 0 0</xyz>', (1.0, 0.0, 0.0)),
        ('1.6', '<xyz>0 3 4</xyz>', (0.0, 0.6, 0.8)),  # of unit length
    ],
)
def test_an_axis_is_given_in_the_frame_of_its_version(version, inside, axis):
    assert only(version=version, inside=f'<axis>{inside}</axis>').axis == pytest.approx(axis)


def test_the_joints_pose_is_given_in_the_childs_frame():
    made = only(inside='<pose>0 0 1 0 0 0</pose><axis><xyz>1 0 0</xyz></axis>')
    assert made.pose == Pose((0.0, 0.0, 1.0))


def test_the_joints_pose_may_be_given_in_the_parents_frame():
    made = only(version='1.7', inside='<pose relative_to="a">0 0 1 0 0 0</pose>')
    assert made.pose.position == pytest.approx((0.0, 1.0, 1.0))


def test_limits_and_dynamics_are_read():
    made = only(
        kind='prismatic',
        inside="""<axis><xyz>0 0 1</xyz><limit><lower>-1</lower>
      <upper>2</upper><effort>10</effort><velocity>3</velocity></limit>
      <dynamics><damping>0.5</damping><friction>0.1</friction></dynamics></axis>""",
    )
    assert made.type == PRISMATIC
    assert (made.lower, made.upper, made.effort, made.velocity) == (-1.0, 2.0, 10.0, 3.0)
    assert (made.damping, made.friction) == (0.5, 0.1)


@pytest.mark.parametrize(
    'lower, upper', [('-1e16', '1e16'), ('-inf', 'inf'), ('-1.79769e+308', '1.79769e+308')]
)
def test_infinite_limits_are_none(lower, upper):
    made = only(
        inside=f"""<axis><xyz>0 0 1</xyz><limit><lower>{lower}</lower>
      <upper>{upper}</upper><effort>-1</effort><velocity>-1</velocity></limit></axis>"""
    )
    assert (made.lower, made.upper, made.effort, made.velocity) == (None, None, None, None)


def test_reversed_limits_are_swapped_and_reported(caplog):
    made = only(inside='<axis><limit><lower>1</lower><upper>-1</upper></limit></axis>')
    assert (made.lower, made.upper) == (-1.0, 1.0)
    assert 'the two are swapped' in caplog.text


@pytest.mark.parametrize('kind', ['ball', 'universal', 'screw', 'revolute2', 'gearbox'])
def test_unsupported_joint_is_left_out_and_reported(kind, caplog):
    assert load(joint(kind=kind)).joints == ()
    assert f"joint 'ab': {kind} joints are not simulated" in caplog.text


def test_parent_of_a_joint_may_be_the_world():
    made = only('world', 'b', kind='fixed', inside='')
    assert (made.parent, made.child) == ('world', 'b')


def test_fixed_joint_with_the_world_as_child_is_reversed():
    made = only('b', 'world', kind='fixed', inside='')
    assert (made.parent, made.child) == ('world', 'b')


def test_several_trees_are_one_model():
    spec = load(joint('a', 'b') + joint('c', 'd'))
    assert [(made.parent, made.child) for made in spec.joints] == [('a', 'b'), ('c', 'd')]


def test_joint_that_closes_a_loop_is_left_out_and_reported(caplog):
    spec = load(joint('a', 'b') + joint('b', 'c') + joint('a', 'c'))
    assert [made.name for made in spec.joints] == ['ab', 'bc']
    assert "joint 'ac': it closes a kinematic loop" in caplog.text


def test_second_joint_to_the_world_closes_a_loop(caplog):
    spec = load(joint('world', 'a') + joint('a', 'b') + joint('world', 'b'))
    assert [made.name for made in spec.joints] == ['worlda', 'ab']
    assert 'closes a kinematic loop' in caplog.text


def test_one_joint_of_a_link_with_two_parents_is_reversed():
    inside = '<pose>0 0 1 0 0 0</pose><axis><xyz>1 0 0</xyz></axis>'
    spec = load(joint('a', 'b') + joint('c', 'b', inside=inside))
    turned = spec.joints[1]
    assert [(made.parent, made.child) for made in spec.joints] == [('a', 'b'), ('b', 'c')]
    # The joint stays where it was, and its position keeps its sign.
    in_model = compose(spec.link('c').pose, turned.pose)
    assert in_model.position == pytest.approx((1.0, 0.0, 1.0))
    assert turned.axis == (-1.0, 0.0, 0.0)


def test_tree_connected_to_the_world_is_rooted_there():
    spec = load(joint('a', 'b') + joint('world', 'b', kind='fixed', inside=''))
    assert {(made.parent, made.child) for made in spec.joints} == {('world', 'b'), ('b', 'a')}


@pytest.mark.parametrize(
    'text, part',
    [
        (joint(kind='hinge'), "type 'hinge' is unknown"),
        (joint('', 'b', name='j'), 'it has no <parent>'),
        (joint('a', 'a'), "connects 'a' to itself"),
        (joint('a', 'world'), 'the world cannot be the child'),
        (joint() + joint(), "there are two joints 'ab'"),
        (
            joint(inside='<axis><dynamics><damping>-1</damping></dynamics></axis>'),
            '<damping> is -1; it must not be negative',
        ),
    ],
)
def test_invalid_joint_is_rejected(text, part):
    assert part in error_message(text)


def test_springs_are_read_and_negative_stiffness_is_rejected():
    inside = (
        '<axis><xyz>1 0 0</xyz><dynamics><spring_stiffness>{}</spring_stiffness>'
        '<spring_reference>-0.5</spring_reference></dynamics></axis>'
    )
    made = only(inside=inside.format(7.5))
    assert (made.stiffness, made.reference) == (7.5, -0.5)
    assert '<spring_stiffness> is -1; it must not be negative' in error_message(
        joint(inside=inside.format(-1))
    )
