#!/usr/bin/env python3
"""Compare the motion of the article's robot with the real Gazebo's.

Without arguments the three commands of test/data/gazebo_motion.json are driven, through the real
plugin and headless, and what was measured in Gazebo is set beside what is measured here, with the
aim for those quantities that have one. Each argument is a recorded trace to be replayed, of any
commands: CSV with the columns t_since_cmd [s], cmd_v [m/s], cmd_w [rad/s], gt_x, gt_y [m],
gt_yaw, gt_v_body_x, gt_v_body_y [m/s], gt_wz, jl_vel, jr_vel [rad/s], as Gazebo's ground truth
has them.
"""

import bisect
import csv
import logging
import math
import sys
from collections.abc import Sequence
from pathlib import Path

from support.motion import (
    COMMANDS,
    RECORDED,
    STEADY_FROM,
    Command,
    Sample,
    angle_between,
    drive,
    drive_as_recorded,
    measure,
    ramp_delays,
)

UNITS = {
    'v': 'm/s', 'w': 'rad/s', 'lateral': 'm/s', 'left': 'rad/s', 'right': 'rad/s', 't90': 's',
    'stop': 's', 'end_x': 'm', 'end_y': 'm', 'end_yaw': 'rad', 'x': 'm', 'y': 'm', 'yaw': 'rad',
}
SMALL = 0.2  # of a quantity below this no share is told: it would say nothing
# Aims: share of Gazebo's mean, or distance in the quantity's unit.
SPEED_SHARE, REST_SHARE, T90_SHARE, RAMP = 0.03, 0.04, 0.05, 0.015
IDLE = 30.0  # [s]


def compare_recorded(name: str) -> list[str]:
    """Return table rows: what Gazebo did, what we do, by how much they differ."""
    gazebo = RECORDED[name]
    turns = not gazebo['command'][0]
    samples = drive_as_recorded(name)
    ours = measure(samples, gazebo['seconds'], turns)
    rows = [_row(name, key, gazebo[key], ours[key]) for key in UNITS]
    way = math.hypot(gazebo['x'], gazebo['y'])
    apart = math.dist((ours['x'], ours['y']), (gazebo['x'], gazebo['y']))
    if turns:
        share = abs(angle_between(ours['yaw'], gazebo['yaw']) / gazebo['yaw'])
        rows.append(_verdict(name, 'heading at rest', f'{share:.2%} off', share <= REST_SHARE))
    else:
        share = apart / way
        rows.append(_verdict(name, 'place at rest', f'{share:.2%} off', share <= REST_SHARE))
    for key, share in (('v', SPEED_SHARE), ('w', SPEED_SHARE), ('t90', T90_SHARE)):
        if abs(gazebo[key]) > SMALL:
            off = ours[key] / gazebo[key] - 1.0
            rows.append(_verdict(name, key, f'{off:+.2%}', abs(off) <= share))
    if name == 'straight':
        ramp = RECORDED['ramp']
        delays = ramp_delays(samples, ramp['start'], 0.0, rising=True)
        delays += ramp_delays(samples, ramp['stop'], gazebo['seconds'], rising=False)
        worst = max(delays, key=abs)
        rows.append(_verdict(name, 'ramp', f'{1000 * worst:+.1f} ms', abs(worst) <= RAMP))
    return rows


def _row(name: str, key: str, theirs: float, ours: float) -> str:
    off = angle_between(ours, theirs) if UNITS[key] == 'rad' else ours - theirs
    if UNITS[key] == 'rad':
        ours = theirs + off  # the same number of turns
    share = f'{100 * off / abs(theirs):+7.2f} %' if abs(theirs) > SMALL else ''
    return f'{name:9} {key:8} {UNITS[key]:6} {theirs:9.4f} {ours:9.4f} {off:+9.4f} {share}'


def _verdict(name: str, what: str, value: str, met: bool) -> str:
    return f'{name:9} {what:15} {value:>12}   aim {"met" if met else "MISSED"}'


def read_trace(path: Path) -> tuple[list[Command], list[Sample]]:
    """Return commands and motion of a recorded trace, in the robot's frame at the first command.

    Raises:
        ValueError: nothing is commanded in it, or a column is missing.
    """
    with path.open(encoding='utf-8') as file:
        rows = [row for row in csv.DictReader(file) if row.get('t_since_cmd')]
    try:
        table = [
            [float(row[key]) for key in (
                't_since_cmd', 'gt_x', 'gt_y', 'gt_yaw', 'gt_v_body_x', 'gt_v_body_y', 'gt_wz',
                'jl_vel', 'jr_vel', 'cmd_v', 'cmd_w',
            )]
            for row in rows if float(row['t_since_cmd']) >= 0.0
        ]
    except KeyError as error:
        raise ValueError(f'{path}: there is no column {error}') from None
    if not table:
        raise ValueError(f'{path}: no row has a t_since_cmd of 0 or later; nothing was commanded')
    _, x0, y0, yaw0, *_ = table[0]
    commands: list[Command] = []
    samples = []
    for time, x, y, yaw, *speeds, v, w in table:
        if not commands or commands[-1][1:] != (v, w):
            commands.append((time if commands else 0.0, v, w))
        dx, dy = x - x0, y - y0
        cos, sin = math.cos(yaw0), math.sin(yaw0)
        samples.append(Sample(
            time, cos * dx + sin * dy, cos * dy - sin * dx, angle_between(yaw, yaw0), *speeds
        ))
    return commands, samples


def compare_trace(path: Path) -> list[str]:
    """Return table rows: how far our path is from a recorded one, and the steady speeds of both."""
    commands, theirs = read_trace(path)
    ours = drive(commands, theirs[-1].time + 0.002)
    times = [sample.time for sample in ours]
    apart = turned = 0.0
    for sample in theirs:
        near = ours[min(bisect.bisect_left(times, sample.time), len(ours) - 1)]
        apart = max(apart, math.dist((near.x, near.y), (sample.x, sample.y)))
        turned = max(turned, abs(angle_between(near.yaw, sample.yaw)))
    rest = math.dist((ours[-1].x, ours[-1].y), (theirs[-1].x, theirs[-1].y))
    rows = [f'{path.name}: largest distance {apart:.4f} m, in heading {turned:.4f} rad; '
            f'{rest:.4f} m apart at the end']
    ends = [command[0] for command in commands[1:]] + [theirs[-1].time]
    for (begin, v, w), end in zip(commands, ends, strict=True):
        if end - begin < 2.0 * STEADY_FROM or not (v or w):
            continue
        for field in ('forward', 'turning', 'left', 'right'):
            a, b = (_steady(samples, field, begin, end) for samples in (theirs, ours))
            share = f'{100 * (b / a - 1.0):+7.2f} %' if abs(a) > SMALL / 4.0 else ''
            rows.append(f'  {v:+.2f} m/s {w:+.2f} rad/s  {field:8} {a:9.4f} {b:9.4f} '
                        f'{b - a:+9.4f} {share}')
    return rows


def _steady(samples: Sequence[Sample], field: str, begin: float, end: float) -> float:
    values = [getattr(s, field) for s in samples if begin + STEADY_FROM <= s.time < end]
    return sum(values) / len(values)


def idle_creep() -> str:
    """Return how far the standing robot moves by itself."""
    samples = drive([], IDLE)
    way = math.dist((samples[0].x, samples[0].y), (samples[-1].x, samples[-1].y))
    return _verdict('idle', f'way in {IDLE:.0f} s', f'{1000 * way:.4f} mm', way < 1e-4)


def main(arguments: Sequence[str]) -> int:
    """Print the comparison; return the exit code."""
    logging.disable(logging.WARNING)
    print('command   what     unit      Gazebo      ours  difference')
    if arguments:
        for argument in arguments:
            print('\n'.join(compare_trace(Path(argument))))
        return 0
    for name in COMMANDS:
        print('\n'.join(compare_recorded(name)))
    print(idle_creep())
    return 0


if __name__ == '__main__':
    sys.exit(main(sys.argv[1:]))
