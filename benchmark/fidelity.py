#!/usr/bin/env python3
"""Compare motion with that recorded in Gazebo; print the largest differences first.

A steady speed is compared with the interval between Gazebo's value and that of mechanics, the
friction law solved to convergence. Where Gazebo contradicts mechanics, the motion is compared with
mechanics, too.

Repeats all recordings (test/data/gazebo), headless and with the real plugins: drives of six
robots, robots without commands, and passive scenes. Every quantity is compared, however small.
Arguments are names of robots and scenes, or traces to replay: CSV files with the columns
t_since_cmd [s], cmd_v or cmd_vx, cmd_vy [m/s], cmd_w [rad/s], gt_x, gt_y [m], gt_yaw [rad],
gt_v_body_x, gt_v_body_y [m/s], gt_wz [rad/s] of Gazebo's ground truth. The file name begins with
the name of the robot; the default is the article's.
"""

import csv
import logging
import math
import sys
from collections.abc import Iterable, Sequence
from pathlib import Path

from support.motion import (
    PLACE_SHARE,
    ROBOTS,
    SPEED_SHARE,
    STEADY_FROM,
    Command,
    compare_drive,
    compare_idle,
    drive,
    robot,
)
from support.passive import SCENES, compare_scene
from support.recorded import HEADER, Difference, line, load, worst_first

COLUMNS = ('gt_x', 'gt_y', 'gt_yaw', 'gt_v_body_x', 'gt_v_body_y', 'gt_wz')
STEADY = (('forward', 'm/s', 4), ('lateral', 'm/s', 5), ('turning', 'rad/s', 6))  # column of a row
FLOOR = 0.01  # [m, rad, m/s or rad/s] least tolerance


def compare_all(names: Iterable[str]) -> list[Difference]:
    """Return the differences in all recorded quantities of robots and scenes."""
    found = []
    for name in names:
        if name in SCENES:
            found += compare_scene(name)
            continue
        for command in load(name)['drives']:
            found += compare_drive(name, command)
        found += compare_idle(name)
    return found


def read_trace(path: Path) -> tuple[list[Command], list[tuple[float, ...]]]:
    """Return the commands of a recorded trace, and its rows: time, then `COLUMNS`.

    Raises:
        ValueError: the trace contains no command, or a column is missing.
    """
    commands: list[Command] = []
    rows = []
    with path.open(encoding='utf-8') as file:
        for row in csv.DictReader(file):
            if not row.get('t_since_cmd') or float(row['t_since_cmd']) < 0.0:
                continue
            try:
                forward = row['cmd_v'] if 'cmd_v' in row else row['cmd_vx']
                vx, vy, w = map(float, (forward, row.get('cmd_vy') or 0.0, row['cmd_w']))
                time, *values = (float(row[key]) for key in ('t_since_cmd', *COLUMNS))
            except KeyError as error:
                raise ValueError(f'{path}: column {error} is missing') from None
            if not commands or commands[-1][1:] != (vx, vy, w):
                commands.append((time if commands else 0.0, vx, vy, w))
            rows.append((time, *values))
    if not rows:
        raise ValueError(f'{path}: no row with t_since_cmd >= 0; the trace has no command')
    return commands, rows


def compare_trace(path: Path) -> list[Difference]:
    """Compare path, heading and steady speeds with those of a recorded trace."""
    commands, rows = read_trace(path)
    name = path.name.partition('_')[0]
    ours = drive(robot(name if name in ROBOTS else 'article'), commands, rows[-1][0])
    _, x0, y0, yaw0, *_ = rows[0]
    cos, sin = math.cos(yaw0), math.sin(yaw0)
    apart = turned = reach = 0.0
    for time, x, y, yaw, *_ in rows:
        sample = ours[round(1000.0 * time)]
        place = cos * (x - x0) + sin * (y - y0), cos * (y - y0) - sin * (x - x0)
        reach = max(reach, math.hypot(*place))
        apart = max(apart, math.dist(place, (sample.x, sample.y)))
        turned = max(turned, abs(math.remainder(sample.yaw - yaw + yaw0, math.tau)))
    found = [
        Difference(path.name, 'path', 'm', 0.0, apart, max(PLACE_SHARE * reach, FLOOR)),
        Difference(path.name, 'heading', 'rad', 0.0, turned, FLOOR),
    ]
    ends = [command[0] for command in commands[1:]] + [rows[-1][0]]
    for (begin, *command), end in zip(commands, ends, strict=True):
        if end - begin < 2.0 * STEADY_FROM or not any(command):
            continue
        for field, unit, column in STEADY:
            first = begin + STEADY_FROM
            theirs = _mean(row[column] for row in rows if first <= row[0] < end)
            own = _mean(getattr(one, field) for one in ours if first <= one.time < end)
            tolerance = max(SPEED_SHARE * abs(theirs), FLOOR)
            quantity = f'{field} from {begin:g} s'
            found.append(Difference(path.name, quantity, unit, theirs, own, tolerance))
    return found


def _mean(values: Iterable[float]) -> float:
    values = list(values)
    return sum(values) / len(values)


def main(arguments: Sequence[str]) -> int:
    """Print the comparison; return the exit code."""
    logging.disable(logging.WARNING)
    known = (*ROBOTS, *SCENES)
    names = [name for name in arguments if name in known]
    found = compare_all(names if arguments else known)
    for argument in arguments:
        if argument not in known:
            found += compare_trace(Path(argument))
    print(HEADER)
    for one in worst_first(found):
        print(line(one))
    for reference in ('Gazebo', 'mechanics'):
        compared = [one for one in found if one.reference == reference]
        beyond = {(one.scene, one.quantity) for one in compared if one.share > 1.0}
        print(
            f'{len(compared)} quantities compared with {reference}, '
            f'{len(beyond)} of them outside their tolerance'
        )
    return 0


if __name__ == '__main__':
    sys.exit(main(sys.argv[1:]))
