"""Drive the article's robot as it was driven in Gazebo, and measure its motion as it was there."""

import json
import math
from collections.abc import Sequence
from typing import NamedTuple

from rosbots_description.sim.pose import relative, yaw_of
from rosbots_description.sim.tuning import Tuning

from . import ROOT, SETTLED, SPAWN_POSE, empty_world, robot_spec

REST = 3.0  # [s] after the end of a command
STEADY_FROM = 1.0  # [s] after its beginning
REACHED = 0.9  # share of the steady speed
STOPPED = 0.05  # share of the steady speed
RECORDED = json.loads((ROOT / 'test' / 'data' / 'gazebo_motion.json').read_text(encoding='utf-8'))
COMMANDS = ('straight', 'turn', 'arc')  # what was recorded, by name

Command = tuple[float, float, float]  # when [s], forward [m/s], turning [rad/s]


class Sample(NamedTuple):
    """Where the robot is, in its frame at the first command, and how it moves."""

    time: float  # [s] since the first command
    x: float  # [m]
    y: float  # [m]
    yaw: float  # [rad], in -pi to pi
    forward: float  # [m/s]
    lateral: float  # [m/s] to the left
    turning: float  # [rad/s]
    left: float  # speed of the left wheel [rad/s]
    right: float  # [rad/s]


def drive(
    commands: Sequence[Command], duration: float, tuning: Tuning | None = None
) -> list[Sample]:
    """Return the motion after each step from the first command on."""
    with empty_world(tuning) as world:
        model = world.spawn(robot_spec(), 'rosbots', SPAWN_POSE)
        world.run(SETTLED)
        start, begin = model.pose, world.clock.now
        wheels = model.plugins[0].wheels
        samples, waiting = [], list(commands)
        for _ in range(round(duration * 1000)):
            while waiting and world.clock.now - begin >= waiting[0][0] - 1e-9:
                model.plugins[0].command(*waiting.pop(0)[1:])
            world.run(1)
            pose, ((vx, vy, _), (_, _, turning)) = model.state()
            yaw = yaw_of(pose.orientation)
            forward = math.cos(yaw) * vx + math.sin(yaw) * vy
            lateral = math.cos(yaw) * vy - math.sin(yaw) * vx
            way = relative(pose, start)
            samples.append(Sample(
                world.clock.now - begin, *way.position[:2], yaw_of(way.orientation),
                forward, lateral, turning, *(wheel.velocity for wheel in wheels),
            ))
        return samples


def drive_as_recorded(name: str, tuning: Tuning | None = None) -> list[Sample]:
    """Return the motion for a command of gazebo_motion.json, until it is at rest."""
    command, seconds = RECORDED[name]['command'], RECORDED[name]['seconds']
    return drive([(0.0, *command), (seconds, 0.0, 0.0)], seconds + REST, tuning)


def measure(samples: Sequence[Sample], seconds: float, turns: bool) -> dict[str, float]:
    """Return what gazebo_motion.json tells of a command that ended after `seconds`.

    Args:
        turns: whether the command is to turn on the spot, so that its speed is that of turning.
    """
    steady = [sample for sample in samples if STEADY_FROM <= sample.time < seconds]

    def mean(field: str) -> float:
        return sum(getattr(sample, field) for sample in steady) / len(steady)

    speed = 'turning' if turns else 'forward'
    full = abs(mean(speed))
    after = [sample for sample in samples if sample.time > seconds]
    moving = [sample.time for sample in after if abs(getattr(sample, speed)) > STOPPED * full]
    end = next(sample for sample in samples if sample.time >= seconds)
    rest = samples[-1]
    return {
        'v': mean('forward'),
        'w': mean('turning'),
        'lateral': mean('lateral'),
        'left': mean('left'),
        'right': mean('right'),
        't90': next(s.time for s in samples if abs(getattr(s, speed)) >= REACHED * full),
        'stop': (moving[-1] if moving else seconds) - seconds,
        'end_x': end.x,
        'end_y': end.y,
        'end_yaw': end.yaw,
        'x': rest.x,
        'y': rest.y,
        'yaw': rest.yaw,
    }


def angle_between(a: float, b: float) -> float:
    """Return a - b [rad], the shorter way round."""
    return math.remainder(a - b, 2.0 * math.pi)


def ramp_delays(samples: Sequence[Sample], speeds: Sequence[Sequence[float]], start: float,
                rising: bool) -> list[float]:
    """Return by how much later than in Gazebo each of the recorded speeds is passed [s].

    Args:
        speeds: pairs of a time since `start` [s] and a forward speed [m/s].
    """
    passing = [sample for sample in samples if sample.time > start]
    return [
        next(s.time for s in passing if (s.forward >= speed if rising else s.forward <= speed))
        - start - time
        for time, speed in speeds
    ]
