"""Place a body so that its links are reported at given poses to the last bit.

PyBullet normalises an orientation that it is given, keeps it by way of a matrix, and reports it by
way of another. So what it reports of a body that it has moved is rarely what it reports again of
one that is put there. For most bodies some orientation within a few units in the last place gives
the same reports, which is searched for. Where there is none, as for some bodies with joints, the
body is first moved by rounding errors to where there is one.
"""

import itertools
import math
from collections.abc import Callable, Iterator, Sequence

from ...core import Pose, Quaternion, as_quaternion, conjugate, multiply
from .body import Part
from .client import pybullet

NEAR = 3  # units in the last place that are tried in each component: 2401 orientations, some 10 ms
CHANCES = 10  # orientations of which one is reported as some other one
_ROUNDING = 1e-9  # [m], and of half an angle [rad]: more is another pose


class ExactPlacement:
    """One root of a body with the links that depend on it."""

    def __init__(self, client: int, part: Part, read_links: Callable[[], Sequence[Pose]]) -> None:
        self._client, self._body, self._read_links = client, part.body, read_links
        self._bodies = (part.body, *part.also)
        self._velocity = pybullet.getBaseVelocity(part.body, client)

    @property
    def axes(self) -> Pose:
        """The pose of the principal axes of the root, as it is reported."""
        return Pose(*pybullet.getBasePositionAndOrientation(self._body, self._client))

    def settle(self) -> None:
        """Move by rounding errors to poses that `match` restores."""
        axes, links = self.axes, self._read_links()
        for _ in range(CHANCES):
            if self._search(axes, links) or self._search(axes):
                return
            axes = self._place(axes)

    def match(self, axes: Pose, links: Sequence[Pose]) -> None:
        """Move by rounding errors so that axes and links are these, unless they were moved."""
        if self._read_links() == links or not _are_close(self.axes, axes):
            return
        if not self._search(axes, links):
            self._place(axes)

    def _search(self, axes: Pose, links: Sequence[Pose] | None = None) -> bool:
        """Place the root so that axes, and links if given, are reported so; tell if it is done."""
        for near in _near(axes.orientation):
            reported = self._place(Pose(axes.position, near))
            if reported == axes and (links is None or self._read_links() == links):
                return True
        return False

    def _place(self, axes: Pose) -> Pose:
        """Place the root, keep its velocity, and return its pose as it is reported."""
        for number in self._bodies:
            pybullet.resetBasePositionAndOrientation(number, *axes, self._client)
            pybullet.resetBaseVelocity(number, *self._velocity, physicsClientId=self._client)
        return self.axes


def _near(q: Quaternion) -> Iterator[Quaternion]:
    """Yield the quaternions next to one, the nearest first."""
    around = [[_moved(x, steps) for steps in range(-NEAR, NEAR + 1)] for x in q]
    for moves in _MOVES:
        yield as_quaternion(
            numbers[NEAR + steps] for numbers, steps in zip(around, moves, strict=True)
        )


_MOVES = sorted(
    itertools.product(range(-NEAR, NEAR + 1), repeat=4), key=lambda moves: sum(map(abs, moves))
)


def _moved(x: float, steps: int) -> float:
    """Return the number that comes so many floating-point numbers after `x`."""
    for _ in range(abs(steps)):
        x = math.nextafter(x, math.copysign(math.inf, steps))
    return x


def _are_close(one: Pose, other: Pose) -> bool:
    """Tell whether two poses differ by rounding only."""
    x, y, z, _ = multiply(one.orientation, conjugate(other.orientation))
    return math.dist(one.position, other.position) < _ROUNDING and math.hypot(x, y, z) < _ROUNDING
