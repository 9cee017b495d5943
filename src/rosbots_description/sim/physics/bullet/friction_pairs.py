"""How a pair of surfaces gets the lesser of their friction coefficients, as in Gazebo.

PyBullet gives a pair the product of one number per body. So a surface is there twice: once with its
own mu, which meets what is as rough or rougher, and once with 1, which meets what is as smooth or
smoother. Of each pair a mu and a 1 are left, and their product is the lesser mu. A surface with
mu 1 is both at once. PyBullet's collision filter sees to who meets whom.
"""

import math
from enum import Enum, IntEnum
from typing import NamedTuple

# PyBullet limits the friction of a pair to this; it holds on slopes of up to 84 degrees.
MAX_FRICTION = 10.0
# PyBullet's rays are of this group. They are to see each surface once.
_RAYS = 1
_FIRST = 1  # bit that is free for the kinds
# Distinct mu that a world can tell apart, besides 1; the bits of a filter are no more.
_CLASSES = 18


class Kind(IntEnum):
    """What a surface belongs to."""

    MOVING = 0
    OCCLUDED = 1  # it lies between others, no plane can touch it
    BOXES = 2  # a moving body that consists of boxes
    STATIC = 3
    PLANE = 4
    SLAB = 5  # what boxes meet instead of a plane


_MEETS = {
    Kind.MOVING: (Kind.MOVING, Kind.OCCLUDED, Kind.BOXES, Kind.STATIC, Kind.PLANE),
    Kind.OCCLUDED: (Kind.MOVING, Kind.OCCLUDED, Kind.BOXES, Kind.STATIC),
    Kind.BOXES: (Kind.MOVING, Kind.OCCLUDED, Kind.BOXES, Kind.STATIC, Kind.SLAB),
    Kind.STATIC: (Kind.MOVING, Kind.OCCLUDED, Kind.BOXES),
    Kind.PLANE: (Kind.MOVING,),
    Kind.SLAB: (Kind.BOXES,),
}


class Role(Enum):
    """Which friction a surface has: its own mu, 1, or both at once."""

    OWN = 'own'
    ONE = 'one'
    BOTH = 'both'


class Side(NamedTuple):
    """One of the two ways in which a surface of friction coefficient `mu` can be met."""

    kind: Kind
    role: Role
    mu: float


def coefficient(mu: float) -> float:
    """Return the friction coefficient that PyBullet can give to a pair of equal surfaces."""
    return min(max(mu, 0.0), MAX_FRICTION)


def roles(mu: float, is_static: bool) -> tuple[Role, ...]:
    """Return the roles in which a surface is needed; nothing is rougher than the roughest."""
    if mu == 1.0:
        return (Role.BOTH,)
    if is_static and mu == MAX_FRICTION:
        return (Role.ONE,)
    return (Role.OWN, Role.ONE)


class FrictionPairs:
    """The collision groups and masks by which each pair of surfaces gets its lesser mu.

    Two surfaces meet if the group of each is in the mask of the other (PyBullet's mode 0).
    """

    def __init__(self) -> None:
        self._bits: dict[float, int] = {}  # of each mu that has come

    def add(self, mu: float) -> bool:
        """Tell a mu apart from now on; return whether that changes the masks of others."""
        if mu == 1.0 or mu in self._bits:
            return False
        if len(self._bits) < _CLASSES:
            bit = 1 << _FIRST + 2 * len(Kind) + len(self._bits)
        else:  # it is taken for the nearest one, and holds between both
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
        seen = 0 if kind is Kind.SLAB else _RAYS  # the plane is seen instead
        smoother = 0
        for other, bit in self._bits.items():
            if other <= mu:
                smoother |= bit
        if role is Role.ONE:
            return 1 << _FIRST + kind, seen | smoother | (met_as_both if mu > 1.0 else 0)
        own = 1 << _FIRST + kind + len(Kind)
        return own, seen | smoother | met_as_one | met_as_both
