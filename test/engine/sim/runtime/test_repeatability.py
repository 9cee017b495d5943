"""Runs are bit-identical: in parts, in several worlds and processes, and after a reset."""

import hashlib
import sys
from pathlib import Path

from support import SPAWN_POSE, empty_world, robot_spec
from support.programs import ran

from rosbots_description.sim.core.transforms import Pose


def drive_and_hash(world, model):
    """Return a hash of all poses of a drive."""
    digest = hashlib.sha256()
    world.run(1000)
    next(iter(model.plugins.values())).command(0.5, 0.5)
    for _ in range(50):
        world.run(20)
        digest.update(repr(model.state()).encode())
    return digest.hexdigest()


def fresh_drive():
    with empty_world() as world:
        return drive_and_hash(world, world.spawn(robot_spec(), 'rosbots', SPAWN_POSE))


def test_run_in_parts_is_identical_to_a_single_run():
    with empty_world() as world:
        model = world.spawn(robot_spec(), 'rosbots', SPAWN_POSE)
        next(iter(model.plugins.values())).command(0.3, 0.2)
        world.run(1500)
        at_once = model.state()
    with empty_world() as world:
        model = world.spawn(robot_spec(), 'rosbots', SPAWN_POSE)
        next(iter(model.plugins.values())).command(0.3, 0.2)
        for _ in range(500):
            world.run(3)
        assert model.state() == at_once


def test_readers_of_outputs_do_not_change_the_motion(world, robot):
    found = []
    for output in robot.plugin('diff_drive').outputs.values():
        output.connect(found.append)
    assert drive_and_hash(world, robot) == fresh_drive()
    assert len(found) > 2 * 200  # of 2 s at 100 Hz


def test_motion_after_reset_simulation_is_bit_identical(world, robot):
    first = drive_and_hash(world, robot)
    world.reset_simulation()
    assert world.clock.now_ns == 0
    assert drive_and_hash(world, robot) == first


def test_another_process_with_another_kernel_is_bit_identical():
    code = 'from test_repeatability import fresh_drive; print(fresh_drive())'
    here = Path(__file__).parent
    paths = [str(here), str(here.parent), str(here.parents[3] / 'src'), *sys.path]
    # Another linear algebra kernel, as on another machine.
    environment = {'PYTHONPATH': ':'.join(paths), 'OPENBLAS_CORETYPE': 'Nehalem'}
    result = ran(sys.executable, '-c', code, env=environment)
    assert result.stdout.strip() == fresh_drive()


def test_simultaneous_worlds_are_independent():
    alone = fresh_drive()
    with empty_world() as other:
        other.spawn(robot_spec(), 'rosbots', Pose((1.0, 1.0, 1.0)))
        other.run(100)
        assert fresh_drive() == alone
