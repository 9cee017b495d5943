"""What controllers read of a URDF: transmissions, limits, mimic joints."""

import math

import pytest

from rosbots_description.sim import ModelError
from rosbots_description.sim.description import Mimic, SoftLimits
from rosbots_description.sim.formats import load_robot_control

INTERFACE = '<hardwareInterface>hardware_interface/EffortJointInterface</hardwareInterface>'
GOOD = (
    '<transmission name="t"><type>x/SimpleTransmission</type>'
    f'<joint name="j">{INTERFACE}</joint><actuator name="m"/></transmission>'
)


def read(body):
    return load_robot_control(f'<robot name="r">{body}</robot>')


def joint(kind='revolute', body=''):
    return read(f'<joint name="j" type="{kind}">{body}</joint>').joints['j']


def test_a_transmission_is_read_with_its_joint():
    control = read(GOOD)
    (one,) = control.transmissions
    assert (one.name, one.type) == ('t', 'x/SimpleTransmission')
    assert one.joints == {'j': ('hardware_interface/EffortJointInterface',)}
    assert control.faults == ()


@pytest.mark.parametrize(
    ('old', 'new', 'faults'),
    [
        ('name="t"', '', ('No name attribute specified for transmission.',)),
        ('name="t"', 'name=""', ('Empty name attribute specified for transmission.',)),
        ('x/SimpleTransmission', ' ', ("Skipping empty type element in transmission 't'.",)),
        ('<type>x/SimpleTransmission</type>', '', ("No type element found in transmission 't'.",)),
        (
            'joint name="j"',
            'joint',
            (
                'No name attribute specified for joint.',
                "Failed to load joints for transmission 't'.",
            ),
        ),
        (
            'joint name="j"',
            'joint name=""',
            (
                'Empty name attribute specified for joint.',
                "Failed to load joints for transmission 't'.",
            ),
        ),
        (
            INTERFACE,
            '<hardwareInterface/>',
            (
                "No valid hardware interface element found in joint 'j'.",
                "Failed to load joints for transmission 't'.",
            ),
        ),
        ('<actuator name="m"/>', '', ("Failed to load actuators for transmission 't'.",)),
        (
            'actuator name="m"',
            'actuator',
            (
                'No name attribute specified for actuator.',
                "Failed to load actuators for transmission 't'.",
            ),
        ),
    ],
)
def test_an_incomplete_transmission_is_skipped_in_upstreams_words(old, new, faults):
    control = read(GOOD.replace(old, new) + GOOD.replace('"t"', '"other"'))
    assert control.faults == faults
    assert [one.name for one in control.transmissions] == ['other']


@pytest.mark.parametrize(
    ('kind', 'limits'),
    [('revolute', (-1.0, 2.0)), ('prismatic', (-1.0, 2.0)), ('continuous', (-math.inf, math.inf))],
)
def test_limits_are_read_by_type(kind, limits):
    found = joint(kind, '<limit lower="-1" upper="2" effort="3" velocity="4"/>')
    assert (found.lower, found.upper) == limits
    assert (found.effort, found.velocity) == (3.0, 4.0)


def test_a_joint_without_limits_has_infinite_ones():
    found = joint('continuous')
    assert (found.effort, found.velocity) == (math.inf, math.inf)


def test_safety_mimic_and_origin_are_read():
    found = joint(
        body='<limit lower="0" upper="1" effort="1" velocity="1"/>'
        '<safety_controller soft_lower_limit="0.1" soft_upper_limit="0.9" '
        'k_position="15" k_velocity="7"/><origin xyz="1 2 3"/>'
        '<mimic joint="other" multiplier="-2" offset="0.5"/>'
    )
    assert found.soft == SoftLimits(0.1, 0.9, 15.0, 7.0)
    assert found.mimic == Mimic('other', -2.0, 0.5)
    assert found.origin == (1.0, 2.0, 3.0)


@pytest.mark.parametrize('bad', ['nan', 'inf', '1e999', 'x', '', '1 2'])
def test_a_number_that_is_none_is_the_default(bad):
    found = joint(
        body=f'<limit lower="{bad}" upper="1" effort="{bad}" velocity="{bad}"/>'
        f'<mimic joint="o" multiplier="{bad}"/><origin xyz="{bad} 0 0 0"/>'
    )
    assert (found.lower, found.effort, found.velocity) == (0.0, 0.0, 0.0)
    assert found.mimic == Mimic('o', 1.0)
    assert found.origin == (0.0, 0.0, 0.0)


def test_swapped_limits_are_sorted_and_a_mimic_without_joint_is_none():
    found = joint(body='<limit lower="2" upper="1" effort="1" velocity="1"/><mimic/>')
    assert (found.lower, found.upper, found.mimic) == (1.0, 2.0, None)


def test_what_is_not_xml_is_refused():
    with pytest.raises(ModelError, match='robot_description'):
        load_robot_control('<robot')
