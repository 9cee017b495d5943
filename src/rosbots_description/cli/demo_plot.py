"""Plots the robot's path in the demo."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from matplotlib.image import imsave
from numpy.typing import NDArray

from ..ros_api.clients.planar_sample import PlanarSample
from .demo_report import Segment

_ARROW = 0.35  # [m] length of the arrow that shows a heading


def save_picture(path: Path, pixels: NDArray[np.uint8]) -> None:
    """Write RGB bytes (height, width, 3) as PNG.

    Raises:
        OSError: the file cannot be written.
    """
    imsave(path, pixels)


def plot_path(
    path: Path,
    drive: Sequence[tuple[Segment, Sequence[PlanarSample]]],
    odometry: Sequence[PlanarSample],
) -> None:
    """Write a top view of the drive as PNG.

    Args:
        drive: each segment with its ground truth, in the world frame.
        odometry: of the whole drive.
    Raises:
        OSError: the file cannot be written.
    """
    figure = Figure(figsize=(8, 6), layout='constrained')
    axes = figure.subplots()
    for segment, samples in drive:
        label = f'{segment.name}: {segment.speed:g} m/s, {segment.turn_rate:g} rad/s'
        axes.plot([s.x for s in samples], [s.y for s in samples], linewidth=3, label=label)
    axes.plot([s.x for s in odometry], [s.y for s in odometry], 'k:', linewidth=1, label='odometry')
    for sample in (drive[0][1][0], drive[-1][1][-1]):
        axes.arrow(
            sample.x,
            sample.y,
            _ARROW * math.cos(sample.yaw),
            _ARROW * math.sin(sample.yaw),
            width=0.02,
            color='0.3',
            zorder=3,
        )
    axes.set(
        title='The drive from above; arrows: heading at start and end',
        xlabel='x [m]',
        ylabel='y [m]',
        aspect='equal',
    )
    axes.margins(0.15)
    axes.grid(alpha=0.3)
    axes.legend(loc='best', fontsize='small')
    figure.savefig(path, dpi=120)
