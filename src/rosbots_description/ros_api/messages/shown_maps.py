"""Messages of mapping, localisation and planning to what a window shows of them."""

import math
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from geometry_msgs.msg import Pose as PoseMessage
from geometry_msgs.msg import PoseArray, PoseStamped
from nav_msgs.msg import OccupancyGrid, Path
from numpy.typing import NDArray

from ...sim.core import SimError
from ...sim.description import ShownGrid, ShownReading
from .conversions import read_pose, read_quaternion, read_vector

WIDEST = 2048  # cells along an edge of a shown map; larger ones are shown with larger cells
MOST_POSES = 5000  # that are shown of a path or a cloud; of more, every second, third … is
OCCUPIED = 100  # of cells, which count from 0; -1 is unknown
PATH, CLOUD, GOAL = (20, 150, 60), (140, 60, 200), (255, 120, 0)  # colours of lines
ARROW, GOAL_ARROW, BARB = 0.15, 0.6, 0.3  # lengths [m], and that of a barb as a part of them
WIDTH = 3.0  # of lines [pixels]
LIFT = 0.02  # [m] of lines above the plane of the map, which would hide them
FREE, FULL = 150, 235  # opacity of a free and of an occupied cell, of 255
INVALID = (255, 0, 0, FULL)


def map_cells(occupancy: NDArray[np.int8]) -> NDArray[np.uint8]:
    """Return RGBA (rows, columns, 4) of occupancies, the first row last.

    Free cells are white and occupied ones black, unknown ones cannot be seen, and values that
    nav_msgs/OccupancyGrid does not define are red.
    """
    values = np.arange(-128, 128)
    palette: NDArray[np.uint8] = np.zeros((256, 4), np.uint8)
    known = (values >= 0) & (values <= OCCUPIED)
    share = values[known] / OCCUPIED
    palette[known, :3] = np.rint(255.0 * (1.0 - share))[:, None]
    palette[known, 3] = np.rint(FREE + share * (FULL - FREE))
    palette[(values < -1) | (values > OCCUPIED)] = INVALID
    return np.asarray(palette[occupancy[::-1].astype(np.int16) + 128])


def map_grid(message: OccupancyGrid) -> ShownReading:
    """Return a map.

    Raises:
        SimError: it has another number of cells than its size says, or is nowhere.
    """
    info = message.info
    cells = np.asarray(message.data, np.int8)
    if len(cells) != info.width * info.height:
        raise SimError(f'it has {len(cells)} cells instead of {info.width} x {info.height}')
    if not 0.0 < info.resolution < math.inf:
        raise SimError(f'its resolution is {info.resolution:g} m')
    try:
        origin = read_pose(info.origin)
    except ValueError as error:
        raise SimError(f'its origin is nowhere: {error}') from None
    words = f'{info.width} x {info.height} cells of {info.resolution:.3g} m'
    if not len(cells):
        return ShownReading(message.header.frame_id, words=words)
    merged = -(-max(info.width, info.height) // WIDEST)
    shown = _merged(cells.reshape(info.height, info.width), merged)
    return ShownReading(
        message.header.frame_id,
        words=words,
        grid=ShownGrid(map_cells(shown), info.resolution * merged, origin),
    )


def _merged(cells: NDArray[np.int8], number: int) -> NDArray[np.int8]:
    """Return cells of which each is the most occupied of so many by so many."""
    if number == 1:
        return cells
    rows, columns = (-(-size // number) * number for size in cells.shape)
    whole = np.full((rows, columns), -1, np.int8)
    whole[: cells.shape[0], : cells.shape[1]] = cells
    return np.asarray(
        whole.reshape(rows // number, number, columns // number, number).max(axis=(1, 3))
    )


def path(message: Path) -> ShownReading:
    """Return the way through the poses of a path."""
    points = _numbers([one.pose for one in message.poses])[:, :3]
    return ShownReading(
        message.header.frame_id,
        lines=np.stack([points[:-1], points[1:]], axis=1).astype('f4'),
        line_colour=PATH,
        line_width=WIDTH,
        words=f'{len(message.poses)} poses',
    )


def pose_cloud(message: PoseArray) -> ShownReading:
    """Return an arrow for each pose."""
    return ShownReading(
        message.header.frame_id,
        lines=_arrows(message.poses, ARROW),
        line_colour=CLOUD,
        line_width=WIDTH,
        words=f'{len(message.poses)} poses',
    )


def goal(message: PoseStamped) -> ShownReading:
    """Return an arrow."""
    at = message.pose.position
    return ShownReading(
        message.header.frame_id,
        lines=_arrows([message.pose], GOAL_ARROW),
        line_colour=GOAL,
        line_width=WIDTH,
        words=f'x {at.x:.3f}, y {at.y:.3f} m',
    )


def _arrows(poses: Sequence[PoseMessage], length: float) -> NDArray[np.float32]:
    """Return a shaft and two barbs (3 n, 2, 3) for each pose, along its x axis."""
    numbers = _numbers(poses)
    start, (x, y, z, w) = numbers[:, :3], numbers[:, 3:].T
    along = np.stack(
        [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + w * z), 2.0 * (x * z - w * y)], axis=1
    )
    left = np.stack(
        [2.0 * (x * y - w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z + w * x)], axis=1
    )
    tip = start + length * along
    ends = [start, *(tip - BARB * length * (along + side * left) for side in (-1.0, 1.0))]
    return np.concatenate([np.stack([tip, end], axis=1) for end in ends], dtype=np.float32)


def _numbers(poses: Sequence[PoseMessage]) -> NDArray[np.float64]:
    """Return lifted positions and unit quaternions (n, 7) of the poses that are poses."""
    shown = poses[:: max(1, -(-len(poses) // MOST_POSES))]
    numbers = np.array(
        [(*read_vector(one.position), *read_quaternion(one.orientation)) for one in shown], float
    ).reshape(-1, 7)
    numbers[:, 2] += LIFT
    norms = np.linalg.norm(numbers[:, 3:], axis=1, keepdims=True)
    with np.errstate(divide='ignore', invalid='ignore'):
        numbers[:, 3:] = np.where(norms == 0.0, (0.0, 0.0, 0.0, 1.0), numbers[:, 3:] / norms)
    return np.asarray(numbers[np.isfinite(numbers).all(axis=1)])


SHOWN: dict[type[Any], Callable[[Any], ShownReading]] = {
    OccupancyGrid: map_grid,
    Path: path,
    PoseArray: pose_cloud,
    PoseStamped: goal,
}
