"""Recordings of Gazebo 11.1.0 (test/data/gazebo), and differences from them."""

import json
from collections.abc import Iterable
from functools import cache
from typing import NamedTuple

from . import ROOT

DATA = ROOT / 'test' / 'data' / 'gazebo'


Reason = tuple[str, str, str]  # prefix of a scene, prefix of a quantity, why we differ there

_CALM = 'sliding and resting bodies do not rock; in Gazebo at 0.07 rad/s, without end'
_LIES = 'rolling resistance of 0.005 of the weight, so that a lying can stays'
# Intended differences, where Gazebo contradicts mechanics. They are printed too.
ON_PURPOSE: tuple[Reason, ...] = (
    ('stack', 'a', 'a stack of five cubes stands; in Gazebo it collapses after 3.2 s'),
    ('stack', 'p', 'a box with its centre of mass above the box below stays there'),
    ('stack', 'g', 'stacked cubes do not creep; in Gazebo by 6 cm'),
    ('sleep', '', 'no body sleeps; in Gazebo a set velocity does not move a sleeping body'),
    *((scene, f'{box}::link spin', _CALM) for scene, boxes in (
        ('mu_pairs', ('f3', 'f4', 'f5')), ('mu_pairs_diag', ('f1', 'f2', 'f3')),
        ('slope', ('b6',)), ('push', ('b_mu0.2_heavy',))) for box in boxes),
    ('roll', 'c::', _LIES),
    ('push', 'b_mu1', '25 N at half the height of a cube with mu 1: at the limit of tipping'),
    ('bounce', 'soft', '1e4 N/m yield 1 mm under 1 kg; in Gazebo 46 mm'),
    ('bounce', '', 'no bounce without restitution; in Gazebo bodies jump apart'),
    ('bounce_plate', 'r0.8_on0.5', 'restitution 0.63: rebound to its square of the height'),
    ('bounce_plate', 'r0.8_on0::', 'as above'),
    ('burger turn_w1.5', 'v', 'equal and opposite wheel speeds do not move the robot back'),
    ('burger turn_w1.5', 'odom', 'the same'),
    ('burger turn_w1.5', 'path', 'the same'),
    ('burger turn_w1.5', 'rest', 'the same'),
    ('burger turn_w1.5', 'end place', 'the same'),
    ('burger', 'pitch', 'min_depth: the wheels penetrate the ground, the lighter caster does not'),
    ('planar turn_w1.0', 'w', 'Gazebo reports 0.904, but turns by 4.262 rad in 5 s'),
)  # fmt: skip


class Difference(NamedTuple):
    """A quantity of a recorded scene, in Gazebo and here, in the same unit.

    `least` marks an error that should be small: being smaller than Gazebo's is no difference.
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
        """Return the difference relative to the tolerance; above 1 it is exceeded."""
        off = self.ours if self.least else self.ours - self.gazebo
        return abs(off) / self.tolerance

    @property
    def why(self) -> str:
        """Return the reason of an intended difference; empty if it is not intended."""
        return next((why for *where, why in ON_PURPOSE if self.is_at(*where)), '')

    def is_at(self, scene: str, quantity: str) -> bool:
        """Return whether scene and quantity begin with these words."""
        return f'{self.scene} '.startswith(f'{scene} ') and self.quantity.startswith(quantity)


def worst_first(differences: Iterable[Difference]) -> list[Difference]:
    """Return the differences, sorted by their share of the tolerance, largest first."""
    return sorted(differences, key=lambda one: -one.share)


def exceeded(
    differences: Iterable[Difference], known: Iterable[tuple[str, str, float, str]] = ()
) -> list[str]:
    """Return a line for each unintended difference outside its tolerance.

    Args:
        known: prefixes of scene and quantity, permitted share of the tolerance, reason.
    """

    def limit(one: Difference) -> float:
        return next((most for *where, most, _ in known if one.is_at(*where)), 1.0)

    return [line(one) for one in worst_first(differences) if not one.why and one.share > limit(one)]


def line(one: Difference) -> str:
    """Return a difference as a row of the table."""
    sign = '<' if one.least else '±'
    return (
        f'{one.share:7.2f}  {one.scene:24} {one.quantity:26} {one.unit:5} {one.gazebo:9.4f} '
        f'{one.ours:9.4f} {one.ours - one.gazebo:+9.4f} {sign}{one.tolerance:.4f}  {one.why}'
    ).rstrip()


HEADER = (f'{"share":>7}  {"scene":24} {"quantity":26} {"unit":5} {"Gazebo":>9} {"ours":>9} '
          f'{"off by":>9} tolerance; share: of the tolerance')


@cache
def load(name: str) -> dict:
    """Return the recording of a robot or of a passive scene."""
    return json.loads((DATA / f'{name}.json').read_text(encoding='utf-8'))
