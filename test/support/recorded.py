"""What was recorded in Gazebo 11.1.0 (test/data/gazebo), and how far from it we are."""

import json
from collections.abc import Iterable
from functools import cache
from typing import NamedTuple

from . import ROOT

DATA = ROOT / 'test' / 'data' / 'gazebo'


Reason = tuple[str, str, str]  # beginning of a scene, of a quantity, and why we differ there

_CALM = 'what slides or lies does not rock; in Gazebo with 0.07 rad/s, on and on'
_LIES = 'a can that rolls is held back by 0.005 of its weight, so that one that lies stays'
# Where mechanics wins over Gazebo. All is printed all the same.
ON_PURPOSE: tuple[Reason, ...] = (
    ('stack', 'a', 'five cubes that touch stand; Gazebo lets them collapse after 3.2 s'),
    ('stack', 'p', 'a box whose weight is over the one below stays there'),
    ('stack', 'g', 'cubes that lie on each other do not creep; in Gazebo by 6 cm'),
    ('sleep', '', 'nothing sleeps here; in Gazebo a velocity moves no sleeping body'),
    *((scene, f'{box}::link spin', _CALM) for scene, boxes in (
        ('mu_pairs', ('f3', 'f4', 'f5')), ('mu_pairs_diag', ('f1', 'f2', 'f3')),
        ('slope', ('b6',)), ('push', ('b_mu0.2_heavy',))) for box in boxes),
    ('roll', 'c::', _LIES),
    ('push', 'b_mu1', '25 N at half the height of a cube of mu 1: between sliding and tipping'),
    ('bounce', 'soft', '1e4 N/m give way by 1 mm under 1 kg; in Gazebo by 46'),
    ('bounce', '', 'a floor without restitution gives nothing back; Gazebo parts by a leap'),
    ('bounce_plate', 'r0.8_on0.5', 'restitution of 0.63, whose square is the height; see above'),
    ('bounce_plate', 'r0.8_on0::', 'as above'),
    ('burger turn_w1.5', 'v', 'wheels that turn alike against each other do not go back'),
    ('burger turn_w1.5', 'odom', 'the same'),
    ('burger turn_w1.5', 'path', 'the same'),
    ('burger turn_w1.5', 'rest', 'the same'),
    ('burger turn_w1.5', 'end place', 'the same'),
    ('burger', 'pitch', 'min_depth lets the wheels sink in, and the lighter caster not'),
    ('planar turn_w1.0', 'w', 'Gazebo tells 0.904, and turns by 4.262 rad in 5 s'),
)  # fmt: skip


class Difference(NamedTuple):
    """One quantity of a recorded scene, there and here, in the same unit.

    What should be least, and is no worse than Gazebo's for being less, is `least`.
    """

    scene: str
    quantity: str
    unit: str
    gazebo: float
    ours: float
    tolerance: float
    least: bool = False

    @property
    def share(self) -> float:
        """Return how much of the tolerance is used up; beyond 1 it is exceeded."""
        off = self.ours if self.least else self.ours - self.gazebo
        return abs(off) / self.tolerance

    @property
    def why(self) -> str:
        """Return why this differs on purpose; empty if it does not."""
        return next((why for *where, why in ON_PURPOSE if self.is_at(*where)), '')

    def is_at(self, scene: str, quantity: str) -> bool:
        """Tell whether this is of a scene and quantity that begin so."""
        return f'{self.scene} '.startswith(f'{scene} ') and self.quantity.startswith(quantity)


def worst_first(differences: Iterable[Difference]) -> list[Difference]:
    """Return all differences, the one that uses up most of its tolerance first."""
    return sorted(differences, key=lambda one: -one.share)


def exceeded(
    differences: Iterable[Difference], known: Iterable[tuple[str, str, float, str]] = ()
) -> list[str]:
    """Return a line for each quantity that is beyond its tolerance, but for those on purpose.

    Args:
        known: beginnings of scene and quantity, how much of its tolerance that may use up, and why.
    """

    def limit(one: Difference) -> float:
        return next((most for *where, most, _ in known if one.is_at(*where)), 1.0)

    return [line(one) for one in worst_first(differences) if not one.why and one.share > limit(one)]


def line(one: Difference) -> str:
    """Return a difference as a row of a table."""
    sign = '<' if one.least else '±'
    return (
        f'{one.share:7.2f}  {one.scene:24} {one.quantity:26} {one.unit:5} {one.gazebo:9.4f} '
        f'{one.ours:9.4f} {one.ours - one.gazebo:+9.4f} {sign}{one.tolerance:.4f}  {one.why}'
    ).rstrip()


HEADER = (f'{"share":>7}  {"scene":24} {"quantity":26} {"unit":5} {"Gazebo":>9} {"ours":>9} '
          f'{"off by":>9} tolerance; share: of the tolerance')


@cache
def load(name: str) -> dict:
    """Return what was recorded of a robot or of a passive scene."""
    return json.loads((DATA / f'{name}.json').read_text(encoding='utf-8'))
