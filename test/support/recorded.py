"""Recordings of Gazebo 11.1.0 (test/data/gazebo), and differences from them."""

import json
import math
from collections.abc import Collection, Iterable
from functools import cache
from typing import NamedTuple

from . import ROOT

DATA = ROOT / 'test' / 'data' / 'gazebo'
LEEWAY = 1.25  # of the limit of a known difference, above what it is


class Known(NamedTuple):
    """A difference from Gazebo that stays: permitted share of the tolerance, and the reason.

    With a limit of infinity, the quantity is not compared.
    """

    scene: str
    quantity: str
    limit: float
    reason: str


class Difference(NamedTuple):
    """A quantity of a recorded scene, in the reference and here, in the same unit.

    `least` marks an error that should be small: being smaller than Gazebo's is no difference.
    `reason` is why mechanics is the reference, see support/mechanics.py. Gazebo's solver leaves up
    to 5 % of a steady speed unconverged: there `mechanics` is what mechanics predicts, and the
    reference is the interval between both.
    """

    scene: str
    quantity: str
    unit: str
    expected: float
    ours: float
    tolerance: float
    least: bool = False
    reference: str = 'Gazebo'
    reason: str = ''
    mechanics: float | None = None

    @property
    def off(self) -> float:
        """Return the signed difference from the reference; 0 within the interval."""
        ends = (self.expected, self.expected if self.mechanics is None else self.mechanics)
        return self.ours - max(min(ends), min(max(ends), self.ours))

    @property
    def share(self) -> float:
        """Return the difference relative to the tolerance; above 1 it is exceeded."""
        return abs(self.ours if self.least else self.off) / self.tolerance

    @property
    def replaces(self) -> tuple[str, ...]:
        """Return the quantities of the scene that are not compared with Gazebo for this one."""
        if self.reference == 'Gazebo':
            return ()
        link = self.quantity.removesuffix('rebound')
        return (self.quantity,) if link == self.quantity else (f'{link}place', f'{link}velocity')


def worst_first(differences: Iterable[Difference]) -> list[Difference]:
    """Return the differences, sorted by their share of the tolerance, largest first."""
    return sorted(differences, key=lambda one: -one.share)


def exceeded(differences: Collection[Difference], known: Iterable[Known] = ()) -> list[str]:
    """Return a line for each difference outside its tolerance, and for each needless exception.

    An exception (a known difference, or a comparison with mechanics instead) is needless where
    Gazebo's value is met without it; a limit is too wide that is never nearly reached.

    Args:
        known: of any scenes.
    """
    scenes = {one.scene for one in differences}
    limits = {(one.scene, one.quantity): one.limit for one in known if one.scene in scenes}
    others = {(one.scene, quantity) for one in differences for quantity in one.replaces}
    lines = []
    for one in worst_first(differences):
        key = one.scene, one.quantity
        theirs = one.reference == 'Gazebo'
        limit = limits.pop(key, 1.0) if theirs else 1.0
        if theirs and (limit > 1.0 or key in others) and one.share <= 1.0:
            lines.append(f'met without an exception: {line(one)}')
        elif LEEWAY * max(1.0, one.share) < limit < math.inf:
            lines.append(f'a limit of {limit:g} is too wide: {line(one)}')
        elif one.share > limit and not (theirs and key in others):
            lines.append(line(one))
    return [*lines, *(f'no such quantity: {key}' for key in limits)]


def line(one: Difference) -> str:
    """Return a difference as a row of the table."""
    sign = '<' if one.least else '±'
    mechanics = f'{one.mechanics:9.4f}' if one.mechanics is not None else 9 * ' '
    return (
        f'{one.share:7.2f}  {one.scene:24} {one.quantity:26} {one.unit:5} {one.reference:9} '
        f'{one.expected:9.4f} {mechanics} {one.ours:9.4f} {one.off:+9.4f} '
        f'{sign}{one.tolerance:.4f}  {one.reason}'
    ).rstrip()


HEADER = (
    f'{"share":>7}  {"scene":24} {"quantity":26} {"unit":5} {"reference":9} {"expected":>9} '
    f'{"mechanics":>9} {"ours":>9} {"off by":>9} tolerance; share: of the tolerance; '
    'off by: from the interval between both where there are two'
)


@cache
def load(name: str) -> dict:
    """Return the recording of a robot or of a passive scene."""
    return json.loads((DATA / f'{name}.json').read_text(encoding='utf-8'))
