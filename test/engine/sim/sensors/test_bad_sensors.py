"""Whatever stands in a <sensor>, its model comes and the clock goes on; a sentence says why."""

import gc
import logging
import re
import weakref

import pytest
from support.sensing import robot_text

from rosbots_description.sim.formats.urdf.urdf import load_urdf

LASER, RANGE, BUMPER, ARM = 'laser_nonoise', 'range', 'bumper', 'arm_ft'
IMU, LINK_IMU, CAMERA = 'imu_sensor', 'imu_model', 'camera_320'
RAYS = 'it takes a number from 1 to 1000000'
NOISE = '<noise><type>gaussian</type><mean>0</mean><stddev>{}</stddev></noise></ray>'


def spawn(world, robot, old='', new=''):
    """Return the model with a text replaced, and a list that takes the times [ms] of readings."""
    model = world.spawn(load_urdf(robot_text(robot, old, new), 'bot')[0], 'bot')
    times = []
    for plugin in model.plugins.values():
        for name, output in plugin.outputs.items():
            if name in ('scan', 'imu', 'contacts', 'wrench'):
                output.connect(lambda _: times.append(world.clock.now_ns // 10**6))
    return model, times


@pytest.mark.parametrize(
    ('robot', 'old', 'new', 'sentence'),
    [
        (LASER, '<samples>720<', '<samples>0<', f'line 14: <samples> is 0; {RAYS}'),
        (LASER, '<samples>720<', '<samples>-7<', f'line 14: <samples> is -7; {RAYS}'),
        (LASER, '<samples>720<', '<samples>2000000<', RAYS),
        (LASER, '<resolution>1<', '<resolution>0<', '<resolution> is 0; with 720 <samples>'),
        (LASER, '<resolution>1<', '<resolution>1e9<', 'it must give 1 to 1000000 ranges'),
        (
            LASER,
            '</horizontal>',
            '</horizontal><vertical><samples>9999</samples></vertical>',
            '7199280 rays; at most 1000000 are cast',
        ),
        (LASER, '<min>0.1<', '<min>31<', '<range> is from 31 to 30 m; it must begin at 0 or more'),
        (LASER, '<min>0.1<', '<min>-1<', '<range> is from -1 to 30 m; it must begin at 0 or more'),
        (
            LASER,
            '<max>30<',
            '<max>1e39<',
            '<range> is from 0.1 to 1e+39 m; it must begin at 0 or more '
            'and end beyond, at most at 3.40282e+38, which is all that a scan can hold',
        ),
        (RANGE, '<max>4<', '<max>1e308<', '<range> is from 0.01 to 1e+308 m; it must begin'),
        (
            RANGE,
            '<fov>0.28<',
            '<fov>-1e39<',
            '<fov> is -1e+39 rad; it must lie between -100 and 100',
        ),
        (LASER, '<max>30<', '<max>nan<', "<max> is 'nan'; it takes a finite number"),
        (
            LASER,
            '<max_angle>1.5708<',
            '<max_angle>1e9<',
            '<max_angle> is 1e+09 rad; it must lie between -100 and 100',
        ),
        (LASER, '</ray>', NOISE.format('NaN'), "<stddev> is 'NaN'; it takes a finite number"),
        (LASER, '</ray>', NOISE.format('-1'), '<stddev> of <noise> is -1; it must not be negative'),
        (LASER, '<update_rate>40<', '<update_rate>1e-12<', '<update_rate> is 1e-12 Hz; it must be'),
        (
            IMU,
            '<updateRateHZ>100<',
            '<updateRateHZ>nan<',
            "<updateRateHZ> is 'nan'; it takes a finite",
        ),
        (IMU, '<gaussianNoise>0<', '<gaussianNoise>NaN<', "<gaussianNoise> is 'NaN'; it takes a"),
        (IMU, '<frameName>imu_link</frameName>', '', 'missing <frameName>, cannot proceed'),
        (ARM, '<updateRate>100.0<', '<updateRate>nan<', "<updateRate> is 'nan'; it takes a finite"),
        (ARM, '<topicName>ft_elbow</topicName>', '', 'missing <topicName>, cannot proceed'),
        (IMU, '<gaussianNoise>0<', '<gaussianNoise>-1<', '<gaussianNoise> is -1; it must be'),
        (IMU, '<rpyOffset>0 0 0', '<rpyOffset>0 0', "<rpyOffset> is '0 0'; it takes three"),
        (LINK_IMU, '<bodyName>base_footprint</bodyName>', '', 'missing <bodyName>, cannot proceed'),
        (LINK_IMU, '>base_footprint</body', '>nobody</body', 'bodyName: nobody does not exist'),
        (ARM, '<jointName>elbow</jointName>', '', 'missing <jointName>, cannot proceed'),
        (ARM, '<jointName>elbow<', '<jointName>knee<', "couldn't get measured joint named knee"),
        (CAMERA, '<width>320<', '<width>9000<', '<width> is 9000; it takes a number from 1 to'),
    ],
)
def test_invalid_sensor_is_left_out_with_an_error(scene, caplog, robot, old, new, sentence):
    model, times = spawn(scene, robot, old, new)
    scene.run(30)
    assert sentence in caplog.text
    assert caplog.text.count('the model is spawned without it') == 1
    assert scene.clock.now_ns == 30_000_000
    assert bool(times) == (robot == ARM)  # whose other joint is measured
    assert model.name in scene.models


@pytest.mark.parametrize(
    ('robot', 'old', 'new', 'expected'),
    [
        (LASER, '<samples>720<', '<samples>1<', [25]),
        (LASER, '<update_rate>40<', '<update_rate>0<', [*range(1, 31)]),
        (LASER, '<update_rate>40<', '<update_rate>-3<', [*range(1, 31)]),
        (LASER, '<update_rate>40<', '<update_rate>1e9<', [*range(1, 31)]),
        (LASER, '<update_rate>40</update_rate>', '', [*range(1, 31)]),
        (LASER, '<topicName>/scan</topicName>', '', [25]),
        (LASER, '<topicName>/scan<', '<topicName><', []),
        (LASER, '<frameName>laser_link</frameName>', '', [25]),
        (LASER, '<max_angle>1.5708<', '<max_angle>-2<', [25]),
        (LASER, '</ray>', NOISE.format('1e300'), [25]),
        (IMU, '<updateRateHZ>100<', '<updateRateHZ>0<', [10, 20, 30]),  # at most that of the sensor
        (IMU, '<updateRateHZ>100<', '<updateRateHZ>-2<', [10, 20, 30]),
        (IMU, '<updateRateHZ>100<', '<updateRateHZ>1e9<', [10, 20, 30]),
        (IMU, '<update_rate>100<', '<update_rate>0<', [10, 20, 30]),
        (IMU, '<topicName>imu/data</topicName>', '', [10, 20, 30]),
        (BUMPER, '<update_rate>50<', '<update_rate>0<', [*range(1, 31)]),
        (BUMPER, '<update_rate>50<', '<update_rate>-1<', [*range(1, 31)]),
        (BUMPER, '<bumperTopicName>bumper</bumperTopicName>', '', [20]),
        (BUMPER, '<frameName>base_link</frameName>', '', [20]),
        (ARM, '<updateRate>100.0<', '<updateRate>0<', None),
        (ARM, '<updateRate>100.0<', '<updateRate>-1<', None),
    ],
)
def test_irregular_values_accepted_by_gazebo_work(scene, caplog, robot, old, new, expected):
    _, times = spawn(scene, robot, old, new)
    scene.run(30)
    assert 'spawned without' not in caplog.text
    assert 'ERROR' not in caplog.text
    if expected is None:  # one joint in each step, the other at 100 Hz
        assert len(times) == pytest.approx(30 + 3, abs=1)
    else:
        assert times == expected


def test_error_about_an_unknown_collision_lists_the_known_ones(scene, caplog):
    named = '<collision>base_footprint_fixed_joint_lump__base_link_collision</collision>'
    _, times = spawn(scene, BUMPER, named, '')
    scene.run(30)
    assert 'it names no <collision>; the collisions of' in caplog.text
    assert 'base_footprint_fixed_joint_lump__base_link_collision' in caplog.text
    assert times == [20]


def test_scan_of_a_million_rays_gives_a_warning(scene, caplog):
    with caplog.at_level(logging.WARNING):
        _, times = spawn(scene, LASER, '<samples>720<', '<samples>1000000<')
    assert (
        '1000000 rays, with those of all other sensors, take long; the simulation waits for '
        'each scan' in caplog.text
    )
    scene.run(30)
    assert times == [25]


def spawn_lasers(world, numbers, samples):
    text = robot_text(LASER, '<samples>720<', f'<samples>{samples}<')
    return [
        world.spawn(load_urdf(text, f'bot{one}')[0], f'bot{one}', x=30.0 + 3.0 * one)
        for one in numbers
    ]


def test_sum_of_all_rays_gives_a_warning_whenever_it_has_doubled(scene, caplog):
    spawn_lasers(scene, range(16), 90_000)
    warned = [
        int(re.search(r': (\d+) rays', line)[1]) for line in caplog.messages if 'take long' in line
    ]
    assert warned == [270_000, 540_000, 1_080_000]
    for one in range(16):
        scene.delete(f'bot{one}')
    caplog.clear()
    spawn_lasers(scene, range(3), 90_000)
    assert caplog.text.count('270000 rays, with those of all other sensors, take long') == 1


def test_sum_of_all_rays_is_limited_until_models_are_deleted(scene, caplog):
    spawn_lasers(scene, range(5), 1_000_000)
    assert 'spawned without it' not in caplog.text
    (refused,) = spawn_lasers(scene, [5], 1000)
    assert (
        'the sensors of this world would cast 5001000 rays with it; at most 5000000 are cast'
        in caplog.text
    )
    assert not refused.sensors
    scene.delete('bot0')
    (accepted,) = spawn_lasers(scene, [6], 1000)
    assert accepted.sensors


def test_rays_of_equal_sensors_are_stored_once_and_freed_with_the_last(scene, no_collection):
    models = spawn_lasers(scene, range(4), 100_000)
    fans = [weakref.ref(next(iter(model.sensors.values())).fan) for model in models]
    assert len(set(fans)) == 1
    for model in models:
        next(iter(model.sensors.values())).read()
    for number in range(4):
        assert fans[0]() is not None
        scene.delete(f'bot{number}')
    assert fans[0]() is None  # no cycle keeps megabytes


def test_deleted_models_are_referenced_by_no_ray_scene(scene):
    models = [weakref.ref(one) for one in spawn_lasers(scene, range(2), 720)]
    next(iter(models[0]().sensors.values())).read()
    for number in range(2):
        scene.delete(f'bot{number}')
    gc.collect()
    assert [one() for one in models] == [None, None]
