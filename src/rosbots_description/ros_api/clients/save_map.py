"""Write the map of a world in files of this machine."""

from __future__ import annotations

import sys
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import NamedTuple

from rosbots_msgs.srv import SaveWorld

from ...sim.core import SimError, printable
from ...sim.public import OccupancyGrid, World
from . import service_program
from .service_program import LAYOUT, Call


class MapOptions(NamedTuple):
    """A horizontal section: height and resolution [m], margin [m], names of models to leave out."""

    height: float
    resolution: float
    margin: float
    without: tuple[str, ...]


def run(
    name: str, world: str | None, ros_arguments: Sequence[str], section: MapOptions, overwrite: bool
) -> int:
    """Write NAME.pgm and NAME.yaml of a world file, or of the running world; return exit code."""
    if world is None:
        return service_program.run(
            'save_map', lambda call: _save_running(call, name, section, overwrite), ros_arguments
        )
    try:
        for line in _save(name, world, section, overwrite):
            sys.stdout.write(f'{printable(line, LAYOUT)}\n')
    except SimError as error:
        sys.stderr.write(f'save_map: {printable(str(error), LAYOUT)}\n')
        return service_program.FAILED
    return service_program.DONE


def true_map(sdf: str, height: float) -> OccupancyGrid:
    """Return the map of a world file's text at a height [m], with the cells of `save_map`.

    Raises:
        SimError: the text is no world, or there is no such map.
    """
    with _file_of(sdf) as path, World.from_file(path) as world:
        try:
            return world.occupancy_grid(height)
        except ValueError as error:
            raise SimError(str(error)) from None


@contextmanager
def _file_of(sdf: str) -> Iterator[str]:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, 'running.world')
        path.write_text(sdf, encoding='utf-8')
        yield str(path)


def _save_running(call: Call, name: str, section: MapOptions, overwrite: bool) -> Iterator[str]:
    with _file_of(call('save_world', SaveWorld).sdf) as world:
        yield from _save(name, world, section, overwrite)


def _save(name: str, world: str, section: MapOptions, overwrite: bool) -> Iterator[str]:
    try:
        with World.from_file(world) as opened:
            grid = opened.save_map(
                name,
                section.height,
                section.resolution,
                without=section.without,
                margin=section.margin,
                overwrite=overwrite,
            )
    except ValueError as error:
        raise SimError(str(error)) from None
    rows, columns = grid.occupied.shape
    yield (
        f'a map of {columns} x {rows} cells, {grid.occupied.sum()} of them occupied: '
        f'{name.removesuffix(".yaml")}.yaml'
    )
    if grid.left_out:
        yield f'left out: {", ".join(grid.left_out)}'
