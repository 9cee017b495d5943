"""Outputs of range finders and block lasers agree with Gazebo's recordings."""

import io

import numpy as np
import pytest
from support.sensing import ROBOTS, box_sdf, recorded_scene, recordings, timed

from rosbots_description.ros_api.adapters.ray_sensors import range_message
from rosbots_description.sim.sensors.noise import gaussian

RECORDINGS = recordings('ray_plugins')
EXACT = 1e-5  # [m]


def reading_of(robot, library, output):
    """Return what a plugin makes of a reading where the robot stands, before physics moves it."""
    plugin = robot.plugin(library)
    plugin.outputs[output].latch()
    plugin.process(plugin.sensor.read())
    return plugin.outputs[output].newest


def readings_of(world, robot, library, output, steps):
    """Return times [ms] and readings that a plugin sends in so many steps."""
    found = timed(world, robot.plugin(library).outputs[output])
    world.run(steps)
    return found


def test_points_of_a_block_laser_agree_with_the_recording():
    recording = RECORDINGS['laser_block']
    world, robot = recorded_scene(recording)
    with world:
        points = reading_of(robot, 'block_laser', 'points')
    assert np.abs(points.positions - np.array(recording['points'])).max() < EXACT
    assert np.array_equal(points.intensities, recording['intensities'])


@pytest.mark.parametrize('name', ['range', 'range_miss', 'range_noise_ir'])
def test_message_of_a_range_finder_agrees_with_the_recording(name):
    world, robot = recorded_scene(RECORDINGS[name])
    with world:
        message = range_message(reading_of(robot, 'range', 'range'))
    for field, expected in RECORDINGS[name]['message'].items():
        assert getattr(message, field) == pytest.approx(expected, abs=EXACT)


def test_range_finder_has_its_own_mean_rate():
    world, robot = recorded_scene(RECORDINGS['range_noise_ir'])  # 20 Hz in a sensor of 50 Hz
    with world:
        times = [time for time, _ in readings_of(world, robot, 'range', 'range', 1000)]
    assert len(times) == 20
    assert set(np.diff(times)) == {40, 60}


def test_noise_of_a_range_finder_is_limited_to_its_range(scene):
    robot = scene.spawn(ROBOTS / 'range_noise_ir.urdf', 'robot')
    scene.spawn(box_sdf('.1 9 2', 'wall'), x=2.15)  # 1.98 m before the laser
    ranges = [one.range for _, one in readings_of(scene, robot, 'range', 'range', 5000)]
    assert max(ranges) == 2.0
    assert 1.92 < min(ranges) < 1.97
    assert len(set(ranges)) > 50


@pytest.mark.parametrize('deviation', [1e30, 1e39, 1e300])
def test_any_noise_fits_the_message_of_a_range_finder(deviation):
    world, robot = recorded_scene(RECORDINGS['range'])
    with world:
        robot.plugin('range').noise = gaussian(deviation, '<gaussianNoise>')
        found = [reading for _, reading in readings_of(world, robot, 'range', 'range', 1000)]
    for reading in found:
        range_message(reading).serialize(io.BytesIO())
    assert min(reading.range for reading in found) < -1e27
