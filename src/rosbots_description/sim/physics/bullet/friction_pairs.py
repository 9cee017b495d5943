"""How a pair of surfaces gets the lesser of their friction coefficients, as in Gazebo.

PyBullet uses the product mu1 * mu2. So each surface exists twice: once with its own mu, in contact
with surfaces of equal or greater mu, and once with 1, in contact with surfaces of equal or lesser
mu. Each pair then is a mu and a 1, and the product is min(mu1, mu2). A surface with mu = 1 has both
roles. The roles are assigned by PyBullet's collision filter.
"""

import math
from enum import Enum, IntEnum
from typing import NamedTuple

# PyBullet's limit for a pair; the angle of friction is 84 degrees.
MAX_FRICTION = 10.0
# Collision group of PyBullet's rays, which must hit each surface once.
_RAYS = 1
_FIRST = 1  # first bit for the kinds
# Distinct values of mu in a world besides 1, limited by the bits of a collision filter.
_CLASSES = 18


class Kind(IntEnum):
    """What a surface belongs to."""

    MOVING = 0
    ON_SLAB = 1  # moving, meets slabs instead of planes
    STATIC = 2
    PLANE = 3
    SLAB = 4


_MEETS = {
    Kind.MOVING: (Kind.MOVING, Kind.ON_SLAB, Kind.STATIC, Kind.PLANE),
    Kind.ON_SLAB: (Kind.MOVING, Kind.ON_SLAB, Kind.STATIC, Kind.SLAB),
    Kind.STATIC: (Kind.MOVING, Kind.ON_SLAB),
    Kind.PLANE: (Kind.MOVING,),
    Kind.SLAB: (Kind.ON_SLAB,),
}


class Role(Enum):
    """Friction coefficient of a part: the surface's own mu, 1, or 1 for both roles."""

    OWN = 'own'
    ONE = 'one'
    BOTH = 'both'


class Side(NamedTuple):
    """One of the two parts for a surface of friction coefficient `mu`."""

    kind: Kind
    role: Role
    mu: float


def coefficient(mu: float) -> float:
    """Return the friction coefficient that PyBullet can give to a pair of equal surfaces."""
    return min(max(mu, 0.0), MAX_FRICTION)


def roles(mu: float, is_static: bool) -> tuple[Role, ...]:
    """Return the roles that a surface needs; a static one with the greatest mu needs just 1."""
    if mu == 1.0:
        return (Role.BOTH,)
    if is_static and mu == MAX_FRICTION:
        return (Role.ONE,)
    return (Role.OWN, Role.ONE)


class FrictionPairs:
    """The collision groups and masks by which each pair of surfaces gets the lesser mu.

    Two surfaces collide if the group of each is in the mask of the other (PyBullet's mode 0).
    """

    def __init__(self) -> None:
        self._bits: dict[float, int] = {}  # of each mu that was added

    def add(self, mu: float) -> bool:
        """Register a mu; return whether that changes the masks of other surfaces."""
        if mu == 1.0 or mu in self._bits:
            return False
        if len(self._bits) < _CLASSES:
            bit = 1 << _FIRST + 2 * len(Kind) + len(self._bits)
        else:  # no bits left: share that of the nearest mu
            bit = self._bits[min(self._bits, key=lambda known: math.fabs(known - mu))]
        self._bits[mu] = bit
        return True

    def clear(self) -> None:
        """Forget all mu."""
        self._bits.clear()

    def group_and_mask(self, side: Side) -> tuple[int, int]:
        """Return the collision group and mask of a side whose mu has been added."""
        kind, role, mu = side
        met_as_one = sum(1 << _FIRST + other for other in _MEETS[kind])
        met_as_both = met_as_one << len(Kind)
        if role is Role.OWN:
            return self._bits[mu], met_as_one | (met_as_both if mu < 1.0 else 0)
        seen = 0 if kind is Kind.SLAB else _RAYS  # rays hit the plane instead
        smoother = 0
        for other, bit in self._bits.items():
            if other <= mu:
                smoother |= bit
        if role is Role.ONE:
            return 1 << _FIRST + kind, seen | smoother | (met_as_both if mu > 1.0 else 0)
        own = 1 << _FIRST + kind + len(Kind)
        return own, seen | smoother | met_as_one | met_as_both
