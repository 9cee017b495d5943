"""Plot of the speeds that the benchmark measured."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import matplotlib

matplotlib.use('Agg')  # before pyplot: there may be no display
from matplotlib import pyplot


def plot_speed(
    path: Path, curves: Mapping[str, Sequence[tuple[int, float]]], estimated: str
) -> None:
    """Write a PNG of steps per second against the number of driving robots.

    Args:
        curves: points (robots, steps per wall second) by their name in the legend.
        estimated: name of the curve that was not measured; it is dashed.
    Raises:
        OSError: the file cannot be written.
    """
    figure, axes = pyplot.subplots(figsize=(8, 5), layout='constrained')
    for name, points in curves.items():
        style = {'linestyle': '--', 'markerfacecolor': 'none'} if name == estimated else {}
        axes.plot(*zip(*points, strict=True), marker='o', label=name, **style)
    axes.axhline(1000.0, color='0.6', linestyle=':', label='real time')
    axes.set(
        title='Steps of 1 ms per second of wall time',
        xlabel='robots driving',
        ylabel='steps/s',
        xscale='log',
        yscale='log',
    )
    robots = sorted({number for points in curves.values() for number, _ in points})
    axes.set_xticks(robots, [str(number) for number in robots])
    axes.minorticks_off()
    axes.grid(alpha=0.3)
    axes.legend(fontsize='small')
    path.parent.mkdir(parents=True, exist_ok=True)
    try:
        figure.savefig(path, dpi=120)
    finally:
        pyplot.close(figure)
