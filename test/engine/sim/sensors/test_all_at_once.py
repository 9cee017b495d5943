"""Robots with all kinds of sensors in one world: bit-identical runs, and resets."""

import pickle

import numpy as np
import pytest
from support.pictures import recorded_world
from support.sensing import robot_text

from rosbots_description.sim.formats.urdf.urdf import load_urdf

NOISY = (
    'laser_noise',
    'laser_block',
    'range_noise_ir',
    'imu_sensor_noise',
    'imu_model_noise',
    'bumper',
    'camera_noise',
    'multicamera',
    'openni_kinect',
    'skid4_p3d',
    'tricycle',
    'planar',
    'arm_ft',
)
# Periods [ms] of outputs of those of the recording, and of others.
PERIODS = {
    'laser_nonoise': {'scan': [25]},
    'imu_sensor': {'imu': [10]},
    'imu_model': {'imu': [20]},
    'bumper': {'contacts': [20]},
    'range': {'range': [100]},
    'arm_ft': {'wrench': [10]},
    'camera_320': {'image': [33, 34], 'camera_info': [33, 34]},
    'openni_kinect': {'depth': [100], 'points': [100], 'depth_camera_info': [100]},
    'skid4_p3d': {'odometry': [10, 20, 34, 1], 'joint_states': [50]},
    'tricycle': {'odometry': [20], 'joint_states': [20]},
    'planar': {'odometry': [51]},
}


def spawn_all(world, robots, are_read=True):
    """Return a list that takes robot, output, time [ms] and bytes of all readings."""
    found = []
    for number, name in enumerate(robots):
        model = world.spawn(
            load_urdf(robot_text(name), name, robot_namespace='/')[0],
            name,
            y=3.0 * (number - len(robots) // 2),
            z=0.02,
        )
        for plugin in model.plugins.values():
            if hasattr(plugin, 'target'):
                plugin.command(0.4, 0.3)
            for output, readings in plugin.outputs.items() if are_read else ():
                readings.connect(
                    lambda reading, key=(name, plugin.spec.name, output): found.append(
                        (key, world.clock.now_ns // 10**6, pickle.dumps(reading))
                    )
                )
    return found


@pytest.fixture
def world():
    with recorded_world(shadows=True) as made:
        yield made


def require_equal(found, first):
    """Compare readings with those of the first time, bit by bit."""
    assert [entry[:2] for entry in found] == [entry[:2] for entry in first]
    pairs = zip(first, found, strict=True)
    assert {key for (key, _, one), (_, _, other) in pairs if one != other} == set()


def test_runs_with_all_sensors_and_drives_read_are_bit_identical():
    def run():
        with recorded_world(shadows=True) as world:
            found = spawn_all(world, NOISY)
            world.run(300)
            return found

    first = run()
    assert len({key for key, _, _ in first}) > 30
    assert first == run()


def test_readings_after_a_reset_are_bit_identical(world):
    found = spawn_all(world, NOISY)
    world.reset_simulation()
    world.run(200)
    first = found.copy()
    world.reset_simulation()
    found.clear()
    world.run(200)
    require_equal(found, first)


def test_from_a_saved_state_everything_is_measured_again_bit_by_bit(world):
    found = spawn_all(world, NOISY)
    world.run(130)
    state = world.save_state()
    found.clear()
    world.run(150)
    first = found.copy()
    world.restore(state)
    found.clear()
    world.run(150)
    require_equal(found, first)


@pytest.mark.parametrize('robot', PERIODS)
def test_outputs_continue_after_resets_of_poses_and_of_time(world, robot):
    found = spawn_all(world, [robot])

    def times():
        made = {}
        for (_, plugin, output), ms, _ in found:
            made.setdefault((plugin, output), []).append(ms)
        return {key: made[key] for key in made if key[1] in PERIODS[robot]}

    world.run(155)
    world.reset_world()
    world.run(266)
    before = times()
    found.clear()
    world.reset_simulation()
    world.run(421)
    assert times() == before
    assert {output for _, output in before} == set(PERIODS[robot])
    for (_, output), stamps in before.items():
        between = set(np.diff([0, *stamps]).tolist())
        # The first of some comes a step late, which the second is not.
        assert any(between <= {period, period + 1, period - 1} for period in PERIODS[robot][output])


def test_reset_of_the_world_stops_a_diff_drive_and_keeps_its_steps(world):
    found = spawn_all(world, ['burger'])
    world.run(155)
    world.reset_world()
    found.clear()
    world.run(100)
    assert found[0][1] == 167  # the fifth of 30 Hz
    assert next(iter(world.models['burger'].plugins.values())).target == (0.0, 0.0, 0.0)


@pytest.mark.parametrize('is_read', [True, False])
def test_a_robot_with_any_sensor_may_go_at_any_step(world, is_read):
    found = spawn_all(world, NOISY, is_read)
    for gone, name in enumerate(NOISY, 1):
        world.run(7)
        world.delete(name)
        found.clear()
        world.run(60)
        heard = {robot for (robot, _, _), _, _ in found}
        assert heard <= set(NOISY[gone:])
        assert bool(heard) == (is_read and gone < len(NOISY))
