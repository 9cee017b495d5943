#!/usr/bin/env python3
"""Compare the motion of the article's robot with the real Gazebo's.

Without arguments the three commands of test/data/gazebo_motion.json are driven. Each argument is a
recorded trace to be replayed: CSV with the columns t_since_cmd [s], cmd_v [m/s], cmd_w [rad/s],
gt_x, gt_y [m] and gt_yaw [rad], as Gazebo's ground truth has them.
"""

import bisect
import csv
import json
import logging
import math
import sys
from collections.abc import Sequence
from pathlib import Path

from article import ROOT, SETTLED, SPAWN_POSE, robot_spec

from rosbots_description.sim.model import Model
from rosbots_description.sim.pose import Pose, from_rpy, relative, yaw_of
from rosbots_description.sim.world import World
from rosbots_description.sim.worlds import add_empty_world

REST = 3.0  # [s] after the end of a command
STEADY_FROM = 1.0  # [s] after its beginning
REACHED = 0.9  # share of the steady speed

Command = tuple[float, float, float]  # when [s], forward [m/s], turning [rad/s]
Sample = tuple[float, Pose, float, float]  # when [s], pose, forward [m/s], turning [rad/s]


def drive(commands: Sequence[Command], duration: float) -> list[Sample]:
    """Return the motion from the first command on, poses relative to where it began."""
    world = World()
    try:
        add_empty_world(world)
        model = world.spawn(robot_spec(), 'rosbots', SPAWN_POSE)
        world.run(SETTLED)
        start, begin = model.pose, world.clock.now
        samples, waiting = [], list(commands)
        while world.clock.now - begin < duration:
            while waiting and world.clock.now - begin >= waiting[0][0]:
                model.plugins[0].command(*waiting.pop(0)[1:])
            samples.append((world.clock.now - begin, *_motion(model, start)))
            world.run(1)
        return samples
    finally:
        world.close()


def _motion(model: Model, start: Pose) -> tuple[Pose, float, float]:
    pose, ((vx, vy, _), (_, _, turning)) = model.state()
    yaw = yaw_of(pose.orientation)
    return relative(pose, start), math.cos(yaw) * vx + math.sin(yaw) * vy, turning


def compare_summary(name: str, gazebo: dict) -> list[str]:
    """Return table rows: what Gazebo did, what we do, by how much they differ."""
    forward, turning = gazebo['command']
    seconds = gazebo['seconds']
    samples = drive([(0.0, forward, turning), (seconds, 0.0, 0.0)], seconds + REST)
    steady = [sample for sample in samples if STEADY_FROM <= sample[0] < seconds]
    ours = {
        'v': sum(sample[2] for sample in steady) / len(steady),
        'w': sum(sample[3] for sample in steady) / len(steady),
    }
    kind = 2 if forward else 3
    aim = REACHED * abs(ours['v' if forward else 'w'])
    ours['t90'] = next(sample[0] for sample in samples if abs(sample[kind]) >= aim)
    end = samples[-1][1]
    ours['x'], ours['y'], _ = end.position
    turns = round((gazebo['yaw'] - yaw_of(end.orientation)) / (2 * math.pi))
    ours['yaw'] = yaw_of(end.orientation) + turns * 2 * math.pi
    units = {'v': 'm/s', 'w': 'rad/s', 't90': 's', 'x': 'm', 'y': 'm', 'yaw': 'rad'}
    return [
        f'{name:9} {key:4} {unit:6} {gazebo[key]:9.4f} {ours[key]:9.4f} '
        f'{ours[key] - gazebo[key]:+9.4f} {_percent(ours[key], gazebo[key])}'
        for key, unit in units.items()
    ]


def _percent(ours: float, theirs: float) -> str:
    return f'{100 * (ours / theirs - 1):+7.2f} %' if abs(theirs) > 0.2 else ''


def compare_trace(path: Path) -> str:
    """Return one table row: how far our path is from a recorded one."""
    with path.open(encoding='utf-8') as file:
        rows = [row for row in csv.DictReader(file) if row['t_since_cmd']]
    rows = [row for row in rows if float(row['t_since_cmd']) >= 0.0]
    if not rows:
        raise ValueError(f'{path}: no row with t_since_cmd of 0 or later')
    commands, last = [], None
    for row in rows:
        command = float(row['cmd_v']), float(row['cmd_w'])
        if command != last:
            commands.append((float(row['t_since_cmd']), *command))
            last = command
    origin = Pose(
        (float(rows[0]['gt_x']), float(rows[0]['gt_y']), 0.0),
        from_rpy(0.0, 0.0, float(rows[0]['gt_yaw'])),
    )
    samples = drive(commands, float(rows[-1]['t_since_cmd']) + 0.002)
    times = [sample[0] for sample in samples]
    apart = turned = 0.0
    for row in rows:
        theirs = relative(
            Pose(
                (float(row['gt_x']), float(row['gt_y']), 0.0),
                from_rpy(0.0, 0.0, float(row['gt_yaw'])),
            ),
            origin,
        )
        index = min(bisect.bisect_left(times, float(row['t_since_cmd'])), len(samples) - 1)
        ours = samples[index][1]
        apart = max(apart, math.dist(ours.position[:2], theirs.position[:2]))
        difference = yaw_of(ours.orientation) - yaw_of(theirs.orientation)
        turned = max(turned, abs(math.remainder(difference, 2 * math.pi)))
    return f'{path.name:28} {apart:9.4f} m {turned:9.4f} rad'


def idle_creep(seconds: int) -> str:
    """Return how far the standing robot moves by itself."""
    samples = drive([(0.0, 0.0, 0.0)], seconds)
    way = math.dist(samples[0][1].position, samples[-1][1].position)
    return f'idle for {seconds} s: {1000 * way:.4f} mm'


def main(arguments: Sequence[str]) -> int:
    """Print the comparison; return the exit code."""
    logging.disable(logging.WARNING)
    if arguments:
        print('trace                         largest distance    in heading')
        for argument in arguments:
            print(compare_trace(Path(argument)))
        return 0
    text = (ROOT / 'test' / 'data' / 'gazebo_motion.json').read_text(encoding='utf-8')
    print('command   what unit      Gazebo      ours  difference')
    for name, gazebo in json.loads(text).items():
        if isinstance(gazebo, dict):
            print('\n'.join(compare_summary(name, gazebo)))
    print(idle_creep(30))
    return 0


if __name__ == '__main__':
    sys.exit(main(sys.argv[1:]))
