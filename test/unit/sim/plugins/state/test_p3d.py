"""P3D: tags, timing, noise and frames."""

import logging
import math
import statistics
from dataclasses import replace

import pytest
from support.fake_drive import collect, fake_model, make_drive, place, run
from support.refusals import sentence_of

from rosbots_description.sim.core.errors import PluginError
from rosbots_description.sim.core.transforms import (
    Pose,
    Twist,
    conjugate,
    from_rpy,
    multiply,
    rotate,
    subtract,
)
from rosbots_description.sim.plugins.state.p3d import P3D

TILTED = Pose((1.0, 2.0, 3.0), from_rpy(0.3, -0.4, 0.5))
MOVING = Twist((0.1, 0.2, 0.3), (0.4, 0.5, 0.6))


def make(model=None, **tags):
    tags = {'bodyName': 'base', 'topicName': 'gt'} | tags
    return make_drive(P3D, model or fake_model(), **tags)


def told(plugin, pose=TILTED, twist=MOVING):
    readings = collect(plugin.odometry)
    place(plugin, pose, twist)
    run(plugin, 1)
    return readings[-1]


def test_defaults_are_upstreams_and_logged_at_debug_level(caplog):
    caplog.set_level(logging.INFO)
    plugin = make()
    assert plugin.params.values == {
        'bodyName': 'base',
        'topicName': 'gt',
        'frameName': 'world',
        'xyzOffset': '0 0 0',
        'rpyOffset': '0 0 0',
        'gaussianNoise': 0.0,
        'updateRate': 0.0,
    }
    assert plugin.namespace == ''
    assert not caplog.messages


@pytest.mark.parametrize(
    ('tags', 'sentence'),
    [
        ({'bodyName': None}, 'missing <bodyName>, cannot proceed'),
        ({'topicName': None}, 'missing <topicName>, cannot proceed'),
        ({'bodyName': 'arm'}, "bodyName: arm does not exist: model 'robot' has no link 'arm'"),
        ({'xyzOffset': '1 2'}, "<xyzOffset> is '1 2'; it takes three numbers"),
        ({'rpyOffset': '0 0 nan'}, "<rpyOffset> is 'nan'; it takes a finite number"),
        ({'gaussianNoise': 'inf'}, "<gaussianNoise> is 'inf'; it takes a finite number"),
        ({'updateRate': '1e-9'}, '<updateRate> is 1e-09 Hz; it must be at least'),
    ],
)
def test_invalid_tags_are_rejected_with_a_message(tags, sentence):
    assert sentence_of(PluginError, make, **tags).startswith(f'gazebo_ros_p3d plugin: {sentence}')


def test_old_names_of_the_offsets_are_reported_as_unknown(caplog):
    make(xyzOffsets='1 2 3')
    assert caplog.messages == [
        'gazebo_ros_p3d plugin: not read by this plugin: <xyzOffsets> (the offset is <xyzOffset>)'
    ]


@pytest.mark.parametrize(
    ('rate', 'steps'),
    [
        ('50', [1, 21, 41, 61, 81]),
        ('30', [1, 35, 69, 103, 137]),  # recorded: 0.034 s
        ('0', [1, 2, 3, 4, 5]),
        ('-1', [1, 2, 3, 4, 5]),
        ('1e6', [1, 2, 3, 4, 5]),
    ],
)
def test_first_reading_is_immediate_and_then_one_per_started_period(rate, steps):
    plugin = make(updateRate=rate)
    run(plugin, 100)  # without readers
    begin, found = plugin.world.clock.steps, []
    plugin.odometry.connect(lambda _: found.append(plugin.world.clock.steps - begin))
    run(plugin, 140)
    assert found[:5] == steps


@pytest.mark.parametrize('frame', ['world', '/world', 'map', '/map'])
def test_names_of_the_world_frame_are_upstreams(frame):
    pose, twist = told(make(frameName=frame))
    assert pose.position == TILTED.position
    assert pose.orientation == pytest.approx(TILTED.orientation)
    assert twist == MOVING


def test_unknown_frame_is_an_error_and_gives_no_readings(caplog):
    plugin = make(frameName='odom')
    assert caplog.messages[0].startswith(
        'gazebo_ros_p3d plugin: frameName: odom does not exist, will not publish pose: '
    )
    assert not plugin.outputs


def test_offsets_are_in_the_axes_of_the_frame():
    pose, twist = told(make(xyzOffset='1 2 3', rpyOffset='0.1 0.2 0.5'))
    assert pose.position == (2.0, 4.0, 6.0)
    expected = multiply(from_rpy(0.1, 0.2, 0.5), TILTED.orientation)
    assert pose.orientation == pytest.approx(expected)
    assert twist == MOVING


def test_frame_of_another_link_is_applied_as_upstream(monkeypatch):
    plugin = make(frameName='left_link')
    body, frame = (
        (TILTED, MOVING),
        (Pose((0.5, 0.0, 0.0), from_rpy(0.0, 0.2, 1.0)), Twist((0.0, 1.0, 0.0), (0.0, 0.0, 0.1))),
    )
    states = {'base': body, 'left_link': frame}
    monkeypatch.setattr(plugin.world.engine, 'link_state', lambda _, name: states[name])
    pose, twist = told(plugin)
    back = conjugate(frame[0].orientation)
    assert pose.position == pytest.approx(rotate(back, (0.5, 2.0, 3.0)))
    assert pose.orientation == pytest.approx(multiply(TILTED.orientation, back))
    for own, there, found in zip(MOVING, frame[1], twist, strict=True):
        assert found == pytest.approx(rotate(frame[0].orientation, subtract(own, there)))


def noisy(name='drive', seed=0):
    model = fake_model()
    model.world.seed = seed
    plugin = make(model, gaussianNoise='0.05')
    plugin.spec = replace(plugin.spec, name=name)
    readings = collect(plugin.odometry)
    place(plugin, TILTED, MOVING)
    run(plugin, 2000)
    return readings


def test_noise_has_the_given_deviation_and_affects_the_twist_only():
    readings = noisy()
    (pose,) = {reading.pose for reading in readings}
    assert pose.orientation == pytest.approx(TILTED.orientation)
    for part in range(2):
        for axis in range(3):
            values = [reading.twist[part][axis] for reading in readings]
            assert statistics.stdev(values) == pytest.approx(0.05, rel=0.1)
            assert math.isclose(statistics.fmean(values), MOVING[part][axis], abs_tol=0.005)


def test_noise_is_repeatable_and_independent_of_readers():
    first = noisy()
    assert noisy() == first
    assert noisy('another')[0] != first[0]
    assert noisy(seed=1)[0] != first[0]
    plugin = make(gaussianNoise='0.05')
    place(plugin, TILTED, MOVING)
    run(plugin, 1000)
    readings = collect(plugin.odometry)
    run(plugin, 1000)
    assert readings == first[1000:]
