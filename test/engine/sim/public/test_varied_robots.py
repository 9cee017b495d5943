"""Robots that use what public ones use are spawned, driven and sensed without an error."""

import logging
import math

import pytest
from support.varied_robots import ROBOTS, SENSORS, urdf

from rosbots_description.sim import World
from rosbots_description.sim.plugin_registry import missing_libraries
from rosbots_description.sim.plugin_registry.registry import known_filenames
from rosbots_description.sim.runtime import Output

SECONDS = 1.2  # of simulated time, each robot: ten updates of the slowest part
WORLDS = ('empty', 'line', 'maze', 'room', 'rooms', 'shapes')
FIRST, APART = 40.0, 3.0  # [m] from the walls of these worlds; from robot to robot


def outputs(part):
    """Return the outputs of a plugin or sensor."""
    return [
        value
        for name in dir(part)
        if not name.startswith('_') and isinstance(value := getattr(part, name, None), Output)
    ]


@pytest.mark.parametrize('number', range(len(WORLDS)))
def test_each_is_spawned_driven_and_sensed_without_an_error(number, caplog):
    caplog.set_level(logging.WARNING)
    robots = {}
    with World.from_file(WORLDS[number]) as world:
        for k in range(number, ROBOTS, len(WORLDS)):
            robots[k] = world.spawn(urdf(k), name=f'r{k}', x=FIRST, y=APART * len(robots), z=0.1)
        for robot in robots.values():
            for part in robot.parts:
                for output in outputs(part):
                    output.latch()
        world.run(seconds=0.2)
        starts = {k: robot.pose.position for k, robot in robots.items()}
        for robot in robots.values():
            robot.plugin('drive').command(0.3, 0.2)
        world.run(seconds=SECONDS - 0.2)
        for k, robot in robots.items():
            assert robot.plugin('drive').odometry.newest is not None, k
            way = math.dist(robot.pose.position, starts[k])
            assert 0.03 < way < 0.45, f'robot {k} has moved {way:.2f} m'
            for sensor in robot.sensors.values():
                if sensor.measures:
                    sensor.read()
    errors = [record.getMessage() for record in caplog.records if record.levelno >= logging.ERROR]
    assert errors == []
    missing = {
        name for k in robots if k % 6 == 5 for name in missing_libraries() if name in urdf(k)
    }
    for name in missing:
        assert name in caplog.text  # what is left out is said


def test_every_plugin_and_sensor_is_in_several_robots():
    texts = [urdf(k) for k in range(ROBOTS)]
    for name in known_filenames():
        assert sum(name in text for text in texts) >= 3, name
    for kind in {kind for kind, *_ in SENSORS}:
        assert sum(f'<sensor type="{kind}"' in text for text in texts) >= 3, kind
