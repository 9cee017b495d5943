"""Pairs of PyBullet bodies that do not collide, for as long as both exist."""

from ...description import Surface
from .body import Place
from .client import pybullet


class CollisionFilter:
    """Pairs of parts that do not collide.

    PyBullet stores a pair by body number and keeps it when the body is removed. A new body that
    reuses the number would then fall through a floor.
    """

    def __init__(self, client: int) -> None:
        """Work in the world of that PyBullet client."""
        self._client = client
        self._pairs: dict[int, set[tuple[Place, Place]]] = {}  # by each body of a pair

    def add(self, one: Place, other: Place) -> None:
        """Disable collisions between two parts."""
        self._set(one, other, touching=False)
        for place in (one, other):
            self._pairs.setdefault(place.body, set()).add((one, other))

    def remove(self, body: int) -> None:
        """Drop the pairs of a removed body, whose number may be reused.

        Call this after the removal: for bodies that exist, PyBullet would search for collisions
        again, which is slow.
        """
        for pair in self._pairs.pop(body, ()):
            self._set(*pair, touching=True)
            for place in pair:
                self._pairs.get(place.body, set()).discard(pair)

    def clear(self) -> None:
        """Drop all pairs; PyBullet has been reset as well."""
        self._pairs.clear()

    def _set(self, one: Place, other: Place, touching: bool) -> None:
        pybullet.setCollisionFilterPair(
            one.body, other.body, one.link, other.link, int(touching), self._client
        )


class Bitmasks:
    """Pairs of parts that do not collide because of <collide_bitmask> and <category_bitmask>.

    PyBullet's own groups and masks assign the roles of friction_pairs.py.
    """

    def __init__(self, collision_filter: CollisionFilter) -> None:
        """Add the pairs to that filter, which drops them with their bodies."""
        self._filter = collision_filter
        self._surfaces: dict[Place, Surface] = {}
        self._special: dict[Place, Surface] = {}  # those with other bitmasks than the default

    def add(self, place: Place, surface: Surface) -> None:
        """Disable collisions of a new part with those that it does not meet."""
        plain = surface.collide_bitmask == surface.category_bitmask == Surface().collide_bitmask
        for other, theirs in (self._special if plain else self._surfaces).items():
            if not surface.meets(theirs):
                self._filter.add(place, other)
        self._surfaces[place] = surface
        if not plain:
            self._special[place] = surface

    def remove(self, place: Place) -> None:
        """Drop a part; its body is removed."""
        self._surfaces.pop(place, None)
        self._special.pop(place, None)

    def clear(self) -> None:
        """Drop all parts; PyBullet has been reset as well."""
        self._surfaces.clear()
        self._special.clear()
