"""IMU readings agree with mechanics and with Gazebo's recordings."""

import math

import numpy as np
import pytest
from support.sensing import recordings, robot_text, timed

from rosbots_description.sim.core.transforms import Pose, Twist, from_rpy, rotate
from rosbots_description.sim.public.world import World

RECORDED = recordings('imu')
GRAVITY = 9.8  # [m/s^2]
# Residual motion of a body on PyBullet's ground [rad/s, m/s^2].
STILL = 1e-4


@pytest.fixture
def world():
    with World.empty() as made:
        yield made


def spawn(world, robot, yaw=0.0, edit=str):
    """Return the model, and a list that takes times [ms] and readings from now on."""
    model = world.spawn(edit(robot_text(robot)), 'ibot', yaw=yaw)
    (plugin,) = model.plugins.values()
    return model, timed(world, plugin.outputs['imu'])


def numbers(reading):
    return np.array((*reading.orientation, *reading.angular_velocity, *reading.linear_acceleration))


def fall(model):
    """Let it fall and turn as it did in the recording."""
    model.set_pose(Pose((0.0, 0.0, 20.0), from_rpy(0.0, 0.2, 0.0)))
    model.set_twist(Twist((0.5, 0.0, 0.0), (0.0, 0.0, 1.0)))


@pytest.mark.parametrize('robot', RECORDED)
def test_reading_at_rest_agrees_with_the_recording(world, robot):
    recording = RECORDED[robot]
    _, found = spawn(world, robot, recording['yaw'])
    world.run(500)
    assert numbers(found[-1][1]) == pytest.approx(np.array(recording['rest']), abs=STILL)


@pytest.mark.parametrize('robot', [name for name in RECORDED if RECORDED[name]['fall']])
def test_reading_in_a_rotating_fall_agrees_with_the_recording(world, robot):
    world.strict = True  # imu_model is recorded with its flaw
    model, found = spawn(world, robot, RECORDED[robot]['yaw'])
    world.run(500)
    del found[:]
    fall(model)
    world.run(150)
    readings = np.array([numbers(reading) for _, reading in found[1:]])  # in the first it jumps
    for row in np.array(RECORDED[robot]['fall']):
        attitudes = np.abs(readings[:, :4] - row[:4]).max(axis=1)
        nearest = readings[attitudes.argmin()]
        assert attitudes.min() < 0.006  # of two readings 20 ms apart
        assert nearest[4:7] == pytest.approx(row[4:7], abs=0.003)
        assert nearest[7:] == pytest.approx(row[7:], abs=0.006 if robot == 'imu_model' else 0.001)


def test_integrated_readings_give_the_velocity_of_the_sensor(world):
    model, found = spawn(world, 'imu_sensor')
    world.run(5)
    fall(model)
    world.run(5)
    sensor = next(iter(model.sensors.values()))

    def velocity():
        pose, (linear, angular) = model.links['base_footprint'].state()
        return np.array(linear) + np.cross(
            angular, rotate(pose.orientation, sensor.spec.pose.position)
        )

    del found[:]
    before = velocity()
    gained = np.zeros(3)
    for _ in range(50):
        world.run(10)
        middle = np.array(rotate(found[-1][1].orientation, found[-1][1].linear_acceleration))
        gained += (middle - (0.0, 0.0, GRAVITY)) * 0.01
    assert gained == pytest.approx(velocity() - before, abs=1e-9)


def test_model_plugin_has_correct_axes_unless_the_world_is_strict(world):
    model, found = spawn(world, 'imu_model')
    world.run(20)
    fall(model)
    world.run(40)
    pitched = found[-1][1]
    assert pitched.angular_velocity == pytest.approx(
        (-math.sin(0.2), 0.0, math.cos(0.2)), abs=0.005
    )
    assert pitched.linear_acceleration == pytest.approx(
        (GRAVITY * math.sin(0.2), 0.0, -GRAVITY * math.cos(0.2)), abs=0.05
    )


def test_imu_on_a_reduced_link_has_its_true_orientation(world):
    model, found = spawn(world, 'imu_model_lumped')
    world.run(20)
    assert found[-1][1].orientation == pytest.approx(from_rpy(0.2, -0.3, 0.5), abs=STILL)
    (plugin,) = model.plugins.values()
    assert plugin.params.values['frameName'] == 'base_footprint'  # as recorded
    fall(model)
    world.run(40)
    attitude = found[-1][1].orientation
    assert rotate(attitude, found[-1][1].angular_velocity) == pytest.approx((0, 0, 1), abs=0.006)


def test_a_body_behind_a_fixed_joint_has_the_recorded_attitude_in_a_strict_world(world):
    world.strict = True
    _, found = spawn(world, 'imu_model_lumped', yaw=0.7)
    world.run(20)
    # rest.quat_mean of the recording
    assert found[-1][1].orientation == pytest.approx(
        (-0.00215763, 0.00228483, 0.338335, 0.941021), abs=1e-6
    )


@pytest.mark.parametrize(
    ('robot', 'deviations', 'claimed'),
    [
        ('imu_sensor_noise', [0.05] * 10, 0.05),
        ('imu_sensor_sdfnoise', [0.0] * 4 + [2e-4] * 3 + [0.017] * 3, 0.0),
        ('imu_model_noise', [0.0] * 4 + [0.05] * 6, 0.05),
    ],
)
def test_noise_is_on_the_same_values_as_in_gazebo(world, robot, deviations, claimed):
    _, found = spawn(world, robot)
    world.run(8000)
    readings = np.array([numbers(reading) for time, reading in found if time > 1000])
    assert readings.std(axis=0) == pytest.approx(np.array(deviations), rel=0.12, abs=1e-6)
    assert {reading.variances for _, reading in found} == {(claimed**2,) * 9}


@pytest.mark.parametrize(
    ('robot', 'times'),
    [
        ('imu_sensor', [10, 20, 30]),
        ('imu_sensor_norate', [1000, 2000, 3000]),
        ('imu_sensor_sdfnoise', [5, 10, 15]),
        ('imu_model', [20, 40, 60]),
    ],
)
def test_readings_have_the_rate_of_the_plugin(world, robot, times):
    _, found = spawn(world, robot)
    world.run(times[-1])
    assert [time for time, _ in found] == times


def test_model_plugin_without_a_rate_updates_every_step_with_defaults(world):
    def bare(text):
        plugin = (
            '<plugin name="p" filename="libgazebo_ros_imu.so"><bodyName>base_footprint'
            '</bodyName></plugin>'
        )
        return f'{text.split("<plugin")[0]}{plugin}</gazebo></robot>'

    model, found = spawn(world, 'imu_model', edit=bare)
    world.run(3)
    assert [time for time, _ in found] == [1, 2, 3]
    values = next(iter(model.plugins.values())).params.values
    assert (values['topicName'], values['serviceName'], values['frameName']) == (
        '/default_imu',
        '/default_imu',
        'base_footprint',
    )


@pytest.mark.parametrize(('text', 'yaw'), [('true', 0.0), ('false', 0.7), ('maybe', 0.7)])
def test_orientation_is_relative_to_the_initial_one_only_if_the_tag_says_true(world, text, yaw):
    tag = f'<initialOrientationAsReference>{text}</initialOrientationAsReference></plugin>'
    _, found = spawn(world, 'imu_sensor', 0.7, lambda robot: robot.replace('</plugin>', tag))
    world.run(10)
    assert found[0][1].orientation == pytest.approx(from_rpy(0.0, 0.0, yaw), abs=1e-3)


def test_tags_that_are_missing_are_warnings_in_upstreams_words(world, caplog):
    spawn(
        world,
        'imu_sensor',
        edit=lambda text: (
            text.split('<topicName>')[0]
            + '<frameName>imu_link</frameName></plugin></sensor></gazebo></robot>'
        ),
    )
    assert [record.getMessage() for record in caplog.records] == [
        'missing <robotNamespace>, set to default: /ibot/',
        'missing <topicName>, set to /namespace/default: imu_data',
        'missing <updateRateHZ>, set to default: 1',
        'missing <gaussianNoise>, set to default: 0',
        'missing <xyzOffset>, set to default: 0 0 0',
        'missing <rpyOffset>, set to default: 0 0 0',
    ]


def test_sensor_is_read_by_itself(world):
    model, _ = spawn(world, 'imu_sensor_noise')
    world.run(30)
    (sensor,) = model.sensors.values()
    assert sensor.read().linear_acceleration[2] == pytest.approx(GRAVITY, abs=0.01)
