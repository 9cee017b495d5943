"""The cells of a map that something occupies."""

import math
from collections.abc import Collection, Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..core import NotFoundError, SimError, compose
from ..runtime import World
from .section import Section, section

MOST = 100_000_000  # cells of a map


@dataclass(frozen=True)
class OccupancyGrid:
    """Square cells of a plane; row 0 is at the lowest y, column 0 at the lowest x.

    `origin` is the outer corner of the first cell, `resolution` the edge of a cell [m].
    """

    occupied: NDArray[np.bool_]  # rows by columns
    origin: tuple[float, float]
    resolution: float
    left_out: tuple[str, ...] = ()  # models


def occupancy_grid(
    world: World,
    height: float,
    resolution: float = 0.05,
    *,
    without: Collection[str] = (),
    margin: float = 1.0,
) -> OccupancyGrid:
    """Return the cells that collision shapes occupy at a height, exactly.

    A cell is occupied if a shape has a part in it, however small. Models with joints, such as
    robots, are left out. Boxes, cylinders and spheres are solid; of meshes, the surfaces count.

    Args:
        world: as it stands.
        height: of the section, z in the world [m].
        resolution: edge of a cell [m]. Borders of cells are at multiples of it.
        without: names of models to leave out.
        margin: free space around everything [m].
    Raises:
        NotFoundError: there is no model of a name in `without`.
        SimError: the map would have more than 100 million cells, or a mesh cannot be read.
        ValueError: a number is not finite, `resolution` not positive or `margin` negative.
    """
    if not all(map(math.isfinite, (height, resolution, margin))) or not (
        resolution > 0.0 <= margin
    ):
        raise ValueError(
            f'a map takes a finite height, a positive resolution and a margin of at '
            f'least 0, not {height}, {resolution} and {margin}'
        )
    for name in without:
        if name not in world.models:
            raise NotFoundError(f"there is no model '{name}'; models: {', '.join(world.models)}")
    left_out = tuple(
        name for name, model in world.models.items() if name in without or model.joints
    )
    sections = list(_sections(world, height, left_out))
    points = np.concatenate([one.segments.reshape(-1, 2) for one in sections] or [np.zeros((1, 2))])
    low = np.floor((points.min(axis=0) - margin) / resolution)
    columns, rows = (np.ceil((points.max(axis=0) + margin) / resolution) - low).tolist()
    if not rows * columns <= MOST:
        raise SimError(
            f'a map of {columns:.0f} x {rows:.0f} cells is too large; {MOST} are drawn: '
            'choose a coarser resolution, or leave models out'
        )
    occupied = _occupied(sections, low, resolution, (int(rows), int(columns)))
    x, y = (low * resolution).tolist()
    return OccupancyGrid(occupied, (x, y), resolution, left_out)


def _sections(world: World, height: float, left_out: Collection[str]) -> Iterator[Section]:
    for name, model in world.models.items():
        for link in model.links.values() if name not in left_out else ():
            pose = link.pose
            for collision in link.spec.collisions:
                one = section(collision.geometry, compose(pose, collision.pose), height)
                if len(one.segments):
                    yield one


def _occupied(
    sections: list[Section], low: NDArray[np.float64], resolution: float, shape: tuple[int, int]
) -> NDArray[np.bool_]:
    """Return the cells that sections have parts in."""
    # Begins and ends of runs of cells along rows: their sums count the runs over each cell.
    change = np.zeros((shape[0], shape[1] + 1), np.int32)
    for one in sections:
        row, first, last = _runs(one.segments / resolution - low)
        if one.is_region:  # what a convex region has of a row is one run
            begin = int(row.min())
            firsts = np.full(int(row.max()) - begin + 1, shape[1])
            lasts = np.full_like(firsts, -1)
            np.minimum.at(firsts, row - begin, first)
            np.maximum.at(lasts, row - begin, last)
            row, first, last = np.arange(len(firsts)) + begin, firsts, lasts
        np.add.at(change, (row, first), 1)
        np.add.at(change, (row, last + 1), -1)
    return np.cumsum(change[:, :-1], axis=1, out=change[:, :-1]) > 0


def _runs(segments: NDArray[np.float64]) -> tuple[NDArray[np.intp], ...]:
    """Return row, first and last column of what segments [cells] pass in each row."""
    ordered = np.take_along_axis(segments, np.argsort(segments[:, :, 1], axis=1)[:, :, None], 1)
    (x0, y0), (x1, y1) = ordered[:, 0].T, ordered[:, 1].T
    lowest = np.floor(y0).astype(np.intp)
    counts = np.floor(y1).astype(np.intp) - lowest + 1
    which = np.repeat(np.arange(len(segments)), counts)
    row = np.arange(len(which)) - np.repeat(np.cumsum(counts) - counts, counts) + lowest[which]
    rise = np.where(y1 > y0, y1 - y0, 1.0)
    ends = [
        x0[which] + (x1 - x0)[which] * np.clip((border - y0[which]) / rise[which], 0.0, 1.0)
        for border in (row, row + 1)
    ]
    ends[1] = np.where((y1 > y0)[which], ends[1], x1[which])
    return row, *(np.floor(one).astype(np.intp) for one in (np.minimum(*ends), np.maximum(*ends)))
