"""The rays of one sensor, a grid of rows and columns, and which of them may hit a shape."""

import math
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple
from weakref import WeakValueDictionary

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Indices = NDArray[np.int64]

_SLACK = 1e-6  # [rad] for rounding
_LEVEL = 1e-4  # [m] for rounding
_ON_AXIS = 1e-200  # [m^2], instead of zero, by which nothing can be divided


def directions(pitch: Floats, yaw: Floats) -> tuple[Floats, Floats, Floats]:
    """Return x, y, z of unit vectors at elevations and azimuths [rad]; the angles broadcast."""
    return np.cos(pitch) * np.cos(yaw), np.cos(pitch) * np.sin(yaw), np.sin(pitch) + 0.0 * yaw


@dataclass(frozen=True)
class Sweep:
    """Angles about one axis: `samples` rays are cast, `count` readings interpolated from them."""

    samples: int
    count: int
    least: float  # [rad]
    greatest: float  # [rad]

    @property
    def first(self) -> float:
        """Return the angle of the first ray [rad]; a single ray is at 0, as in Gazebo."""
        return self.least if self.samples > 1 else 0.0

    @property
    def step(self) -> float:
        """Return the angle between neighbouring rays [rad]."""
        return (self.greatest - self.least) / max(1, self.samples - 1)

    @property
    def angles(self) -> Floats:
        """Return the angles of the rays [rad]."""
        return self.first + np.arange(self.samples) * self.step

    def within(self, low: Floats, high: Floats) -> tuple[Indices, Indices]:
        """Return begin and end indices of the rays from `low` to `high` [rad]."""
        if self.samples == 1 or self.step == 0.0:
            met = (low <= self.first) & (high >= self.first)
            return np.zeros(met.shape, np.int64), met * self.samples
        ends = (low - self.first) / self.step, (high - self.first) / self.step
        begin, end = ends if self.step > 0.0 else ends[::-1]
        begin = np.minimum(np.maximum(np.ceil(begin), 0.0), self.samples)
        end = np.minimum(np.maximum(np.floor(end) + 1.0, 0.0), self.samples)
        return begin.astype(np.int64), end.astype(np.int64)

    def neighbours(self) -> tuple[Indices, Indices, Floats]:
        """Return for each reading the rays below and above, and its position between, 0 to 1."""
        place = np.arange(self.count) * ((self.samples - 1) / max(1, self.count - 1))
        below = np.floor(place).astype(np.int64)
        return below, np.minimum(below + 1, self.samples - 1), place - below


class Patches(NamedTuple):
    """Patches of a fan: the rows and columns that may hit one bounding box each.

    Attributes:
        shapes: (m,) indices of the shapes, ascending.
        rows: (m,) the first row; `rows_end` is one past the last.
        columns: (m,) likewise for columns.
    """

    shapes: Indices
    rows: Indices
    rows_end: Indices
    columns: Indices
    columns_end: Indices


class RayFan:
    """Rays from one point, row by row by elevation, each row by azimuth. It does not change."""

    @classmethod
    def of(cls, rows: Sweep, columns: Sweep) -> 'RayFan':
        """Return the fan of two sweeps, shared by all sensors that have these."""
        fan = _FANS.get((rows, columns))
        if fan is None:
            fan = _FANS[rows, columns] = cls(rows, columns)
        return fan

    def __init__(self, rows: Sweep, columns: Sweep) -> None:
        self.rows, self.columns = rows, columns
        self.shape = rows.samples, columns.samples
        ways = directions(rows.angles[:, None], columns.angles)
        self.ways = np.stack(ways).reshape(3, -1)  # (3, n) unit vectors in the sensor's frame
        ends = sorted((columns.angles[0], columns.angles[-1]))
        # Azimuths are modulo 2 pi; these are the full turns within the fan.
        turns = range(math.floor(ends[0] / math.tau - 0.5), math.ceil(ends[1] / math.tau + 0.5) + 1)
        self._turns = np.array(turns) * math.tau
        least, greatest = self._elevations = sorted((rows.angles[0], rows.angles[-1]))
        # Rays between two cones; beyond the poles they would be on both sides of the axis.
        self._is_band = -math.pi / 2.0 < least and greatest < math.pi / 2.0
        self._band = tuple(
            (math.sin(angle), math.cos(angle)) for angle in (least - _SLACK, greatest + _SLACK)
        )
        self._is_half = self._is_band and ends[1] - ends[0] <= math.pi + _SLACK
        middle = (ends[0] + ends[1]) / 2.0
        self._middle = math.cos(middle), math.sin(middle)

    def may_meet(self, centres: Floats, radii: Floats, reaches: Floats, most: float) -> Indices:
        """Return the shapes that rays of length up to `most` [m] may hit, by plain arithmetic.

        Args:
            centres: (m, 3) in the frame of the fan [m].
            radii: (m,) of their bounding spheres [m].
            reaches: (m,) half extents of their bounding boxes along the axis of the fan [m].
        """
        x, y, z = centres.T
        flat_square = x * x + y * y
        met = flat_square + z * z < (radii + most) ** 2
        least, greatest = self._elevations
        # Above rays that are level or go down is what is above the origin, and likewise below.
        if greatest <= 0.0:
            met &= z - reaches <= _LEVEL
        if least >= 0.0:
            met &= z + reaches >= -_LEVEL
        if self._is_band and least != greatest:
            flat = np.sqrt(flat_square)
            (low_sin, low_cos), (high_sin, high_cos) = self._band
            met &= z * high_cos - flat * high_sin <= radii
            met &= z * low_cos - flat * low_sin >= -radii
        if self._is_half:
            met &= x * self._middle[0] + y * self._middle[1] >= -radii
        return np.flatnonzero(met)

    def near(self, centres: Floats, radii: Floats, corners: Floats, most: float) -> Patches:
        """Return which rays of length up to `most` [m] may hit bounding spheres and boxes.

        Args:
            centres: (m, 3) in the frame of the fan [m].
            radii: (m,) [m].
            corners: (3, 8, m) of the boxes, relative to the centres [m].
        """
        x, y, z = centres.T
        flat = np.hypot(x, y)
        middle = np.arctan2(y, x)
        low, high = _span(middle, radii, flat)
        # A box whose corners are all ahead of the axis subtends the azimuths of its corners.
        across, ahead = x * corners[1] - y * corners[0], x * corners[0] + y * corners[1]
        ahead += flat * flat
        np.maximum(ahead, _ON_AXIS, out=ahead)
        slopes, is_ahead = across / ahead, ahead.min(axis=0) > _ON_AXIS
        np.maximum(low, middle + np.arctan(slopes.min(axis=0)) - _SLACK, out=low, where=is_ahead)
        np.minimum(high, middle + np.arctan(slopes.max(axis=0)) + _SLACK, out=high, where=is_ahead)
        columns, columns_end = self.columns.within(
            low[:, None] + self._turns, high[:, None] + self._turns
        )
        there = columns_end > columns
        if self.shape[0] > 1:
            far = np.hypot(flat, z)
            rows, rows_end = self.rows.within(*_span(np.arctan2(z, flat), radii, far))
            there &= ((rows_end > rows) & (far - radii < most))[:, None]
        else:
            rows, rows_end = np.zeros(len(x), np.int64), np.ones(len(x), np.int64)
        shapes, turns = np.nonzero(there)
        return Patches(
            shapes,
            rows[shapes],
            rows_end[shapes],
            columns[shapes, turns],
            columns_end[shapes, turns],
        )

    def rays(self, patches: Patches) -> tuple[Indices, Indices, Indices]:
        """Return indices of patches and rays, and the counts of rays by patch.

        The first two have an entry for each ray in each patch, the third for each patch.
        """
        widths = patches.columns_end - patches.columns
        counts = widths * (patches.rows_end - patches.rows)
        which = np.repeat(np.arange(len(counts)), counts)
        before = counts.cumsum() - counts
        if self.shape[0] == 1:
            return which, np.arange(len(which)) + (patches.columns - before)[which], counts
        down, along = np.divmod(np.arange(len(which)) - before[which], widths[which])
        first = patches.rows * self.shape[1] + patches.columns
        return which, down * self.shape[1] + along + first[which], counts

    @cached_property
    def blend(self) -> 'Blend':
        """Return the interpolation of readings from rays, whose numbers may differ."""
        low, high, up = self.rows.neighbours()
        left, right, along = self.columns.neighbours()
        corners = tuple(
            ((row[:, None] * self.shape[1] + column).ravel(), np.outer(a, b).ravel())
            for row, a in ((low, 1.0 - up), (high, up))
            for column, b in ((left, 1.0 - along), (right, along))
        )
        return Blend(corners, (low + high) / 2.0, (left + right) / 2.0)


class Blend(NamedTuple):
    """Bilinear interpolation of each reading from four rays.

    Attributes:
        corners: four pairs of ray indices (n,) and weights (n,).
        rows: (r,) midpoint of a reading's rays, in rows.
        columns: (c,) likewise in columns.
    """

    corners: tuple[tuple[Indices, Floats], ...]
    rows: Floats
    columns: Floats

    def ranges(self, cast: Floats) -> Floats:
        """Return the interpolated readings."""
        found: Floats = np.sum([share * cast[rays] for rays, share in self.corners], axis=0)
        return found

    def intensities(self, cast: Floats) -> Floats:
        """Return the readings, each the mean of its four rays."""
        found: Floats = np.mean([cast[rays] for rays, _ in self.corners], axis=0)
        return found


_FANS: WeakValueDictionary[tuple[Sweep, Sweep], RayFan] = WeakValueDictionary()


def _span(middle: Floats, radii: Floats, far: Floats) -> tuple[Floats, Floats]:
    """Return the angles that spheres subtend: least and greatest [rad]."""
    half = np.where(far > radii, np.arcsin(radii / np.maximum(far, radii)), math.pi)
    return middle - half - _SLACK, middle + half + _SLACK
