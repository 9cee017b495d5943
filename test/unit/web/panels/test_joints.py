"""Sliders for joints and for topics of controllers."""

import math

import pytest
from support.window import FakeJoints, model, models_with

from rosbots_description.sim.core import Pose
from rosbots_description.sim.description import (
    PRISMATIC,
    REVOLUTE,
    CommandTopic,
    JointSpec,
    SceneChange,
    ShownLink,
    ShownModel,
)
from rosbots_description.web.panels.joints import MOST, TOPICS, JointPanel

LIMITED = JointSpec('elbow', REVOLUTE, 'a', 'b', lower=-1.0, upper=2.0, effort=5.0)
FREE = JointSpec('wheel', REVOLUTE, 'a', 'c')
ELBOW = CommandTopic('/elbow_controller/command')
ARM = CommandTopic('/arm_controller/command', ('elbow', 'lift'), are_positions=True)
FORCES = CommandTopic('/forces/command', ('elbow', 'lift'))
LIFT = JointSpec('lift', PRISMATIC, 'a', 'd', lower=0.0)


@pytest.fixture
def joints():
    return FakeJoints()


@pytest.fixture
def models():
    arm = ShownModel('arm', (ShownLink(1, 'a', Pose()),), (LIMITED, FREE, LIFT))
    return models_with(arm, model('box', 2))


@pytest.fixture
def panel(site, joints, models, complaints):
    panel = JointPanel(site, joints, joints.command_topics, models, complaints.append)
    panel.refresh()
    return panel


def choose(browser, of, *labels):
    browser.wait_until(lambda: of in browser.props('Of')['options'])
    browser.choose('Of', of)
    browser.wait_until(lambda: all(browser.control(label) for label in labels))


def test_models_with_joints_are_offered(browser):
    assert list(browser.props('Of')['options']) == ['', 'arm']


def test_sliders_have_the_limits_of_their_joints(browser):
    choose(browser, 'arm', 'elbow [rad]', 'wheel [rad]', 'lift [m]')
    limits = [
        (browser.props(name)['min'], browser.props(name)['max'])
        for name in ('elbow [rad]', 'wheel [rad]', 'lift [m]')
    ]
    assert limits == [(-1.0, 2.0), (-math.pi, math.pi), (0.0, 1.0)]


def test_a_turned_wheel_stands_within_a_turn(panel, joints):
    joints.now = 7.0
    assert panel._range_of('arm', FREE, 'position', 10.0)[1] == pytest.approx(7.0 - math.tau)
    assert panel._range_of('arm', LIFT, 'position', 10.0)[1] == 7.0


def test_a_slider_sets_a_position(browser, joints):
    choose(browser, 'arm', 'elbow [rad]')
    assert joints.told == []
    browser.choose('elbow [rad]', 1.5)
    browser.wait_until(lambda: joints.told)
    assert joints.told == [('set_position', 'arm', 'elbow', 1.5)]


@pytest.mark.parametrize(
    ('what', 'label', 'greatest', 'told'),
    [
        ('velocity', 'elbow [rad/s]', 10.0, ('set_velocity', 'arm', 'elbow', 2.0, 10.0)),
        ('effort', 'elbow [N m]', 5.0, ('set_effort', 'arm', 'elbow', 2.0)),
    ],
)
def test_a_slider_sets_a_velocity_or_an_effort(browser, joints, what, label, greatest, told):
    browser.choose('Sliders set', what)
    choose(browser, 'arm', label)
    assert browser.props(label)['max'] == greatest
    browser.choose(label, 2.0)
    browser.wait_until(lambda: joints.told)
    assert joints.told == [told]


def test_release_ends_motors_and_efforts(browser, joints):
    choose(browser, 'arm', 'elbow [rad]')
    browser.click('Release')
    browser.wait_until(lambda: len(joints.told) == 6)
    assert ('set_velocity', 'arm', 'wheel', 0.0, 0.0) in joints.told
    assert ('set_effort', 'arm', 'lift', 0.0) in joints.told


def test_topics_of_controllers_have_sliders(browser, joints, panel):
    joints.topics = (ELBOW,)
    panel.refresh()
    browser.choose('Range', 3.0)
    choose(browser, TOPICS, '/elbow_controller/command')
    assert browser.props('/elbow_controller/command')['max'] == 3.0
    browser.choose('/elbow_controller/command', -1.0)
    browser.wait_until(lambda: joints.told == [('command', ELBOW, (-1.0,))])
    joints.topics = ()
    panel.refresh()
    browser.wait_until(lambda: not browser.control('/elbow_controller/command'))


@pytest.mark.parametrize(
    ('topic', 'limits', 'told'),
    [
        (ARM, (-1.0, 2.0), (1.5, 0.25)),  # the other joint stays where it stands
        (FORCES, (-10.0, 10.0), (1.5, 0.0)),
    ],
)
def test_a_controller_of_several_joints_has_a_slider_for_each(
    browser, joints, panel, topic, limits, told
):
    elbow, lift = (f'{topic.name} {name}' for name in topic.joints)
    joints.topics = (topic,)
    panel.refresh()
    choose(browser, TOPICS, elbow, lift)
    assert (browser.props(elbow)['min'], browser.props(elbow)['max']) == limits
    browser.choose(elbow, 1.5)
    browser.wait_until(lambda: joints.told)
    assert joints.told == [('command', topic, told)]


def test_a_topic_whose_joints_have_no_room_is_left_out(browser, joints, panel):
    many = CommandTopic('/many/command', tuple(f'joint{number}' for number in range(MOST)))
    joints.topics = (ELBOW, many, FORCES)
    panel.refresh()
    choose(browser, TOPICS, ELBOW.name, '/forces/command lift')
    assert not browser.control('/many/command joint0')


def test_a_model_that_is_deleted_takes_its_sliders_along(browser, models, panel):
    choose(browser, 'arm', 'elbow [rad]')
    models.apply(SceneChange(removed=('arm',)))
    panel.refresh()
    browser.wait_until(lambda: not browser.control('elbow [rad]'))


def test_sliders_stay_while_nothing_else_is_chosen(browser, panel):
    choose(browser, 'arm', 'elbow [rad]')
    slider = browser.control('elbow [rad]')
    panel.refresh()
    browser.choose('Sliders set', 'velocity')
    browser.wait_until(lambda: browser.control('elbow [rad/s]'))
    assert slider not in browser.controls
    slider = browser.control('elbow [rad/s]')
    panel._show()  # as the callback does, when the page has looked again before it
    browser.choose('Range', 3.0)
    browser.wait_until(lambda: browser.control('elbow [rad/s]') not in (None, slider))
    made = [message['props']['label'] for message in browser.received('GuiSliderMessage')]
    assert made.count('elbow [rad/s]') == 2


def test_a_refusal_is_told(browser, joints, complaints):
    choose(browser, 'arm', 'elbow [rad]')
    joints.fault = 'SetModelConfiguration: model does not exist'
    browser.choose('elbow [rad]', 1.0)
    browser.wait_until(lambda: complaints == [joints.fault])
