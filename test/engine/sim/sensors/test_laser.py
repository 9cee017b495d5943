"""Laser scans agree with Gazebo's recordings and with geometry."""

import math
import random
from unittest.mock import Mock

import numpy as np
import pytest
from support.pictures import recorded_world
from support.sensing import (
    CUBE,
    ROBOTS,
    box_sdf,
    collected,
    numbers,
    recorded_scene,
    recordings,
    robot_text,
    timed,
)

from rosbots_description.sim.core.transforms import Pose, from_rpy, normalise
from rosbots_description.sim.public.world import World
from rosbots_description.sim.sensors.rays.fan import Patches, RayFan, Sweep

SCANS = recordings('laser')
EXACT = 1e-5  # [m] of all recorded ranges; they have six digits behind the point
ROBOT = robot_text('laser_nonoise')
NOISY = ROBOT.replace(
    '</ray>', '<noise><type>gaussian</type><mean>0.0</mean><stddev>0.01</stddev></noise></ray>'
)


def robot_with(**tags):
    """Return the robot with other numbers in some elements of its sensor."""
    text = ROBOT
    for tag, value in tags.items():
        before, rest = text.split(f'<{tag}>', 1)
        text = f'{before}<{tag}>{value}</{tag}>{rest.split(f"</{tag}>", 1)[1]}'
    return text


def stamped(world, sensor):
    return timed(world, sensor.readings)


@pytest.mark.parametrize('name', SCANS)
def test_scan_agrees_with_the_recording(name):
    world, robot = recorded_scene(SCANS[name])
    with world:
        scan = robot.sensor('head_hokuyo_sensor').read()
    message = SCANS[name]['message']
    expected = numbers(message['ranges'])
    assert np.array_equal(np.isinf(scan.ranges), np.isinf(expected))
    met = np.isfinite(expected)
    assert np.abs(scan.ranges[met] - expected[met]).max() < EXACT
    assert np.array_equal(scan.intensities, numbers(message['intensities']))
    for tag in ('angle_min', 'angle_max', 'angle_increment', 'range_min', 'range_max'):
        assert getattr(scan, tag) == pytest.approx(message[tag], rel=1e-6)


def test_scans_of_a_driving_robot_are_those_recorded(scene):
    """Gazebo's rays belong to the pose of the stamp or of one step later, within one scan, too."""
    robot = scene.spawn(ROBOTS / 'skid4_laser.urdf')
    sensor = robot.sensor('head_hokuyo_sensor')
    for recording in recordings('laser_driving'):
        expected, differences = numbers(recording['ranges']), []
        for row in recording['poses']:
            robot.set_pose(Pose(tuple(row[:3]), normalise(tuple(row[3:]))))
            found = sensor.read().ranges
            differences.append(np.abs(found.clip(max=99.0) - expected.clip(max=99.0)))
        assert np.minimum(*differences).max() < 2 * EXACT  # poses have seven digits


def test_a_scan_of_a_driving_robot_belongs_to_the_pose_of_its_stamp(scene):
    robot = scene.spawn(ROBOTS / 'skid4_laser.urdf')
    robot.plugin('skid_steer_drive').command(0.3, 0.8)
    sensor = robot.sensor('head_hokuyo_sensor')
    poses = []
    found = stamped(scene, sensor)
    sensor.readings.connect(lambda _: poses.append(robot.pose))
    scene.run(1000)
    assert [time for time, _ in found] == list(range(25, 1001, 25))
    assert math.dist(poses[0].position, poses[-1].position) > 0.2
    for (_, scan), pose in list(zip(found, poses, strict=True))[-5:]:
        robot.set_pose(pose)
        assert sensor.read().ranges == pytest.approx(scan.ranges, abs=1e-9)


def test_moving_model_is_seen_at_its_pose_at_the_end_of_the_step(scene):
    robot = scene.spawn(ROBOT)
    ball = scene.spawn(
        '<sdf version="1.6"><model name="ball"><link name="l"><gravity>0</gravity>'
        '<collision name="c"><geometry><sphere><radius>.1</radius></sphere>'
        '</geometry></collision></link></model></sdf>',
        x=2.12,
        y=0.2,
        z=0.35,
    )
    sensor = robot.sensor('head_hokuyo_sensor')
    for _ in range(3):
        ball.set_pose(Pose((ball.pose.position[0] - 0.3, 0.2, 0.35)))
        scene.run(1)
        (x, y, z), (bx, by, bz) = sensor.pose.position, ball.pose.position
        distance = math.dist((x, y, z), (bx, by, bz)) - 0.1
        assert sensor.read().ranges.min() == pytest.approx(distance, abs=1e-4)  # near its middle


def test_poses_are_read_once_after_steps_in_which_something_was_awake(scene, monkeypatch):
    robot, read = scene.spawn(ROBOT), Mock(wraps=scene.engine.link_pose)
    monkeypatch.setattr(scene.engine, 'link_pose', read)
    counts = []
    for steps in (1, 0, 3000, 10):
        scene.run(steps)
        read.reset_mock()
        robot.sensor('head_hokuyo_sensor').read()
        counts.append(read.call_count)
    assert counts == [9, 1, 2, 1], 'at first of static models, too; its own for each scan'


def test_a_static_robot_among_static_models_scans_at_its_rate():
    static = ROBOT.replace('</robot>', '<gazebo><static>true</static></gazebo></robot>')
    with World.from_file('empty') as world:
        found = stamped(world, world.spawn(static).sensor('head_hokuyo_sensor'))
        world.run(seconds=1.0)
    assert len(found) == 40


def test_a_static_model_is_seen_where_it_was_put(scene):
    robot = scene.spawn(ROBOT)
    wall = scene.spawn(CUBE, x=0.62, y=0.03, z=0.35)
    sensor = robot.sensor('head_hokuyo_sensor')
    found = [sensor.read().ranges.min()]
    state = scene.save_state()
    wall.set_pose(Pose((0.72, 0.03, 0.35)))
    found.append(sensor.read().ranges.min())
    scene.restore(state)
    found.append(sensor.read().ranges.min())
    wall.set_pose(Pose((0.82, 0.03, 0.35)))
    scene.run(1)
    found.append(sensor.read().ranges.min())
    scene.reset_world()
    found.append(sensor.read().ranges.min())
    assert found == pytest.approx([0.49, 0.59, 0.49, 0.69, 0.49], abs=1e-4)


def test_a_level_fan_tries_no_shape_above_below_or_behind_it():
    fan = RayFan(Sweep(1, 1, 0.0, 0.0), Sweep(181, 181, -math.pi / 2, math.pi / 2))
    centres = np.array(
        (
            (2.0, 0.0, 0.0),
            (2.0, 0.0, 0.2),
            (2.0, 0.0, -0.2),
            (-2.0, 0.0, 0.0),
            (9.0, 0.0, 0.0),
            (2.0, 0.0, 0.09),
        )
    )
    flat_boxes = np.full(6, 0.5), np.full(6, 0.1)  # radii and half heights [m]
    assert fan.may_meet(centres, *flat_boxes, most=8.0).tolist() == [0, 5]


@pytest.mark.parametrize('elevations', [(-0.3, 0.2), (0.1, 0.4), (-0.4, -0.1)])
def test_a_fan_tries_the_spheres_that_reach_between_its_cones(elevations):
    fan = RayFan(Sweep(5, 5, *elevations), Sweep(91, 91, -0.5, 0.5))
    rise = np.linspace(-1.0, 1.0, 41)
    centres = np.stack((3.0 * np.cos(rise), 0.0 * rise, 3.0 * np.sin(rise)), axis=1)
    radius = 0.3
    met = fan.may_meet(centres, np.full(41, radius), np.full(41, radius), most=8.0)
    apart = np.maximum(elevations[0] - rise, rise - elevations[1])  # [rad] outside the band
    assert met.tolist() == np.flatnonzero(3.0 * np.sin(np.maximum(apart, 0.0)) <= radius).tolist()


@pytest.mark.parametrize('tilt', [(0.0, 0.0), (0.7, -0.4), (math.pi / 2, 0.0)])
def test_no_ray_misses_a_shape_that_it_meets(monkeypatch, tilt):
    """Compare with a cast of all rays at all shapes, near, around and far from the sensor."""

    def all_of(fan, centres, *_):
        every, none = np.arange(len(centres)), np.zeros(len(centres), int)
        return Patches(every, none, none + fan.shape[0], none, none + fan.shape[1])

    draw = random.Random(1)
    shapes = (
        '<box><size>{0} {1} {2}</size></box>',
        '<sphere><radius>{0}</radius></sphere>',
        '<cylinder><radius>{0}</radius><length>{2}</length></cylinder>',
    )
    links = ''.join(
        f'<collision name="c{i}"><pose>{" ".join(str(draw.gauss(0, 2)) for _ in range(6))}</pose>'
        f'<geometry>{shapes[i % 3].format(*(draw.lognormvariate(-0.9, 0.8) for _ in range(3)))}'
        '</geometry></collision>'
        for i in range(90)
    )
    with World() as world:
        world.spawn(
            f'<sdf version="1.6"><model name="m"><static>1</static><link name="l">{links}'
            '</link></model></sdf>'
        )
        robot = world.spawn(robot_with(min_angle=-3.0, max_angle=3.5, min=0.01))
        robot.set_pose(Pose((0.1, 0.2, 0.0), from_rpy(*tilt, 0.5)))
        sensor = robot.sensor('head_hokuyo_sensor')
        culled = sensor.cast()
        monkeypatch.setattr(RayFan, 'near', all_of)
        monkeypatch.setattr(RayFan, 'may_meet', lambda _fan, centres, *_: np.arange(len(centres)))
        whole = sensor.cast()
    assert np.isfinite(culled[0][culled[0] < 30.0]).sum() > 300
    assert np.array_equal(culled, whole)


def test_spawned_model_is_seen_until_deleted(scene):
    sensor = scene.spawn(ROBOT).sensor('head_hokuyo_sensor')
    before = sensor.read().ranges
    scene.spawn(box_sdf('.1 9 2', 'wall'), x=1.0)
    assert np.isfinite(sensor.read().ranges).sum() > 500
    scene.delete('wall')
    assert np.array_equal(sensor.read().ranges, before)


@pytest.mark.parametrize(
    ('rate', 'times'),
    [
        (40, [25, 50, 75, 100]),
        (30, [34, 67, 100, 134]),
        (7, [143, 286, 429, 572]),
    ],
)
def test_readings_have_the_mean_rate_at_ends_of_steps(scene, rate, times):
    sensor = scene.spawn(robot_with(update_rate=rate, samples=3)).sensor('head_hokuyo_sensor')
    found = stamped(scene, sensor)
    scene.run(600)
    assert [time for time, _ in found[:4]] == times


def test_rate_of_a_sensor_does_not_depend_on_others_or_readers(scene):
    sensors = [
        scene.spawn(robot_with(update_rate=rate, samples=3), f'r{rate}', x=rate).sensor(
            'head_hokuyo_sensor'
        )
        for rate in (40, 30, 7)
    ]
    found = [stamped(scene, sensor) for sensor in sensors[1:]]
    scene.run(500)
    late = stamped(scene, sensors[0])
    scene.run(500)
    assert [len(one) for one in (late, *found)] == [20, 30, 7]
    assert late[0][0] == 525  # in the rhythm that there would be without having slept


def test_no_scan_is_computed_without_readers(scene):
    sensor = scene.spawn(ROBOT).sensor('head_hokuyo_sensor')
    read = collected(sensor.readings)
    sensor.readings.disconnect(read.append)
    sensor.measure = pytest.fail
    scene.run(100)
    assert read == []


def test_noise_has_its_deviation_and_stays_within_the_range(scene):
    scans = stamped(scene, scene.spawn(NOISY).sensor('head_hokuyo_sensor'))
    scene.run(1000)
    clean = scene.models['lbot'].sensor('head_hokuyo_sensor').cast()[0]
    ranges = np.array([scan.ranges for _, scan in scans])
    met = clean < 29.0
    noise = ranges[:, met] - clean[met]
    assert noise.std() == pytest.approx(0.01, rel=0.02)
    assert abs(noise.mean()) < 4 * 0.01 / math.sqrt(noise.size)
    rays = np.corrcoef(noise[:, :100].T)
    assert np.abs(rays - np.eye(100)).max() < 0.75  # of 40 scans; the deviation is 1 / sqrt(40)
    assert np.isposinf(ranges[:, ~met]).all()


def test_noise_repeats_with_the_seed_at_any_start_of_reading():
    def scan_at(seed, begin):
        with recorded_world() as world:
            world.seed = seed
            sensor = world.spawn(NOISY).sensor('head_hokuyo_sensor')
            world.run(begin)
            found = stamped(world, sensor)
            world.run(200 - begin)
            return found[-1][1].ranges.tobytes()

    assert scan_at(1, 0) == scan_at(1, 120)
    assert scan_at(1, 0) != scan_at(2, 0)


def test_seed_and_scale_of_the_noise_change_in_a_running_world_and_are_restored(scene):
    sensor = scene.spawn(NOISY).sensor('head_hokuyo_sensor')
    clean, state = sensor.cast()[0], scene.save_state()
    assert sensor.is_noisy

    def noise():
        return (sensor.read().ranges - clean)[clean < 29.0]

    first = noise()
    sensor.noise_scale = 3.0
    assert noise() == pytest.approx(3.0 * first, abs=1e-12)
    scene.seed = 5
    assert np.abs(noise() - 3.0 * first).max() > 0.01
    scene.restore(state)
    assert np.array_equal(noise(), first)


def test_noise_differs_between_sensors(scene):
    sensors = [scene.spawn(NOISY, f'r{i}').sensor('head_hokuyo_sensor') for i in range(2)]
    found = [stamped(scene, sensor) for sensor in sensors]
    scene.run(50)
    assert not np.array_equal(found[0][0][1].ranges, found[1][0][1].ranges)


def test_plugin_outputs_scans_only_with_readers(scene):
    robot = scene.spawn(ROBOT)
    plugin = robot.plugin('laser')
    assert plugin.params.values == {'frameName': 'laser_link', 'topicName': '/scan'}
    assert not plugin.sensor.readings.wanted
    read = collected(plugin.outputs['scan'])
    scene.run(50)
    plugin.outputs['scan'].disconnect(read.append)
    assert len(read) == 2
    assert not plugin.sensor.readings.wanted


def test_a_million_rays_and_deletion_during_use(scene):
    many = scene.spawn(robot_with(samples=1_000_000)).sensor('head_hokuyo_sensor')
    few = scene.spawn(ROBOT, 'few', x=0.0, y=0.0).sensor('head_hokuyo_sensor')
    dense, sparse = many.read().ranges, few.read().ranges
    assert dense[0] == sparse[0]
    assert dense[-1] == sparse[-1]
    stamped(scene, few)
    scene.delete('few')
    scene.delete('lbot')
    scene.run(50)
