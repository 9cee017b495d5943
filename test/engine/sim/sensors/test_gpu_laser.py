"""A gpu_ray measures as a ray does; Gazebo's differs by centimetres, and loses laser_retro."""

import logging

import numpy as np
import pytest
from support.sensing import collected, numbers, recordings, robot_text

NOISE = '<noise><type>gaussian</type><mean>0</mean><stddev>0.05</stddev></noise></ray>'


def spawn_gpu(scene, robot, old='', new=''):
    text = robot_text(robot, old, new)
    assert 'type="ray"' in text and 'ros_laser.so' in text
    text = text.replace('type="ray"', 'type="gpu_ray"').replace('ros_laser.so', 'ros_gpu_laser.so')
    return scene.spawn(text)


@pytest.mark.parametrize('robot', ['laser_nonoise', 'laser_short'])
def test_scan_agrees_with_the_recording_of_a_ray_sensor(scene, robot):
    scan = next(iter(spawn_gpu(scene, robot).sensors.values())).read()
    expected = numbers(recordings('laser')[robot]['message']['ranges'])
    assert np.array_equal(np.isinf(scan.ranges), np.isinf(expected))
    met = np.isfinite(expected)
    assert np.abs(scan.ranges[met] - expected[met]).max() < 1e-5
    assert scan.intensities.max() == 1500.0


def test_noise_is_limited_to_the_range_and_no_return_has_none(scene):
    """As recorded of a ray with a deviation of 0.05 m up to 3.5 m."""
    model = spawn_gpu(scene, 'laser_short', '</ray>', NOISE)
    (sensor,) = model.sensors.values()
    clean, scans = sensor.cast()[0], collected(sensor.readings)
    scene.run(2000)
    ranges, met = np.array([scan.ranges for scan in scans]), clean < 3.5
    assert np.isposinf(ranges[:, ~met]).all()
    assert ranges[:, met].max() <= 3.5
    assert (ranges[:, met] - clean[met]).std() == pytest.approx(0.05, rel=0.02)


def test_what_is_missing_is_said_in_upstreams_words_but_warns_of_nothing(scene, caplog):
    caplog.set_level(logging.INFO, 'rosbots_description.sim')
    spawn_gpu(scene, 'laser_nonoise', '<frameName>laser_link</frameName>', '')
    assert [(record.levelname, record.getMessage()) for record in caplog.records] == [
        ('INFO', 'Laser plugin missing <frameName>, defaults to /world')
    ]
