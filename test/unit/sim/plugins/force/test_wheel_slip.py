"""Slip compliances of tyres."""

import pytest
from dynamic_reconfigure.encoding import Config
from dynamic_reconfigure.server import Server
from support.fake_drive import fake_model, load_plugin, run, turn, wheel_of

from rosbots_description.ros_api.reconfigure import wheel_slip
from rosbots_description.sim.core.errors import PluginError
from rosbots_description.sim.description.model_spec import Element
from rosbots_description.sim.plugins.force.wheel_slip import WheelSlip


def wheel(name='left_link', **numbers):
    numbers = {
        'slip_compliance_lateral': '0.5',
        'slip_compliance_longitudinal': '0.25',
        'wheel_normal_force': '50',
    } | numbers
    children = tuple(Element(tag, text) for tag, text in numbers.items() if text is not None)
    return Element('wheel', '', {'link_name': name}, children)


def load(*wheels, model=None, namespace=None):
    named = (Element('robotNamespace', namespace),) if namespace is not None else ()
    element = Element('plugin', children=(*named, *wheels))
    return load_plugin(WheelSlip, model or fake_model(wheel_of(0.1)), element)


def test_slip_compliance_is_proportional_to_rim_speed_over_normal_force():
    plugin = load(wheel())
    for speed in (-4.0, 8.0):  # [rad/s] in consecutive steps
        turn(plugin, left=speed)
        run(plugin, 1)
        rim = abs(speed) * 0.1
        assert plugin.world.engine.slips == {
            'left_link': pytest.approx((rim / 50 * 0.5, rim / 50 * 0.25))
        }


def test_given_radius_is_used_and_negative_compliance_is_zero():
    plugin = load(wheel(wheel_radius='0.2', slip_compliance_lateral='-3'))
    turn(plugin, left=1.0)
    run(plugin, 1)
    assert plugin.world.engine.slips['left_link'] == pytest.approx((0.0, 0.2 / 50 * 0.25))


@pytest.mark.parametrize(
    ('bad', 'told'),
    [
        (wheel('nowhere'), 'is no link'),
        (wheel('base'), 'no joint turns this link'),
        (wheel(wheel_normal_force=None), '<wheel_normal_force> must be above 0'),
        (wheel(slip_compliance_lateral='lots'), 'takes a finite number'),
    ],
)
def test_invalid_wheel_is_left_out_with_an_error(bad, told, caplog):
    plugin = load(bad, wheel('right_link'))
    assert told in caplog.text
    assert [one.joint.name for one in plugin.wheels] == ['right']


def test_wheel_whose_axle_is_no_principal_axis_is_left_out(caplog):
    model = fake_model(wheel_of(0.1))
    model.engine.rigid = {'left_link'}
    with pytest.raises(PluginError, match='no <wheel> that can slip'):
        load(wheel(), model=model)
    assert 'no principal axis' in caplog.text


@pytest.mark.parametrize(
    ('given', 'used'),
    [
        (None, 'robot/wheel_slip'),
        ('', 'robot/wheel_slip'),
        ('/', 'robot/wheel_slip'),
        ('rear', 'robot/rear'),
    ],
)
def test_namespace_is_within_that_of_the_model(given, used):
    assert load(wheel(), namespace=given).namespace == used


def test_compliances_change_for_all_wheels_unless_negative():
    plugin = load(wheel(), wheel('right_link'))
    plugin.set_compliance(lateral=2.0, longitudinal=-1.0)
    assert {(one.lateral, one.longitudinal) for one in plugin.wheels} == {(2.0, 0.25)}


def test_dynamic_reconfigure_sets_the_compliances(monkeypatch):
    monkeypatch.setattr(Server, '__init__', lambda *_: None)
    plugin = load(wheel())
    server = wheel_slip.serve_slip(plugin, lambda command: command())
    server._reconfigure(Config({wheel_slip.LATERAL: 3.0, wheel_slip.LONGITUDINAL: -1.0}), 0)
    assert (plugin.wheels[0].lateral, plugin.wheels[0].longitudinal) == (3.0, 0.25)
