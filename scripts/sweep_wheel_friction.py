#!/usr/bin/env python3
"""Sweep the friction of the wheels, and plot how far the robot gets from rest in two seconds.

Many short runs of config/scenarios/wheel_friction.yaml by rosbots_description.batch, on all cores
of this machine. Needs matplotlib and what `pip install '.[ray]'` installs.
"""

import argparse
from pathlib import Path

import numpy as np
from matplotlib import pyplot

from rosbots_description import batch

SCENARIO = Path(__file__).resolve().parents[1] / 'config' / 'scenarios' / 'wheel_friction.yaml'
RADIUS = 0.23  # of the wheels [m]


def plot(rows, path):
    """Write a picture of the ways that the robot and its wheels made; `rows` are columns."""
    figure, axes = pyplot.subplots(figsize=(6, 4), layout='constrained')
    for speed in np.unique(rows['speed']):
        made = (rows['speed'] == speed) & (rows['outcome'] == 'passed')
        friction, x, wheel = (rows[name][made] for name in ('friction', 'x_end', 'wheel_end'))
        (line,) = axes.plot(friction, x, marker='.', label=f'robot, at {speed} m/s')
        axes.plot(friction, RADIUS * wheel, '--', color=line.get_color(), label='its wheels')
    axes.set(xlabel='coefficient of friction of the wheels', ylabel='way in 2 s from rest [m]')
    axes.grid(alpha=0.3)
    axes.legend()
    figure.savefig(path, dpi=100)


def main():
    """Make the runs, and plot them."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('picture', help='file to write')
    parser.add_argument('--workers', type=int, help='processes; default: one per core')
    parser.add_argument('--output', help='folder for the rows; an interrupted sweep goes on there')
    options = parser.parse_args()
    result = batch.run(SCENARIO, workers=options.workers, output=options.output)
    print(result.outcomes)
    plot(
        {name: np.array(column) for name, column in result.table.to_pydict().items()},
        options.picture,
    )


if __name__ == '__main__':
    main()
