"""Which of PyBullet's bodies pass through each other, for as long as both of them are there."""

from .body import Place
from .client import pybullet


class CollisionFilter:
    """Pairs of parts that pass through each other.

    PyBullet notes such a pair by numbers, and goes on heeding it when a body has gone and its
    number is that of another one, which would then fall through a floor.
    """

    def __init__(self, client: int) -> None:
        """Work in the world of that PyBullet client."""
        self._client = client
        self._pairs: dict[int, set[tuple[Place, Place]]] = {}  # by each body of a pair

    def add(self, one: Place, other: Place) -> None:
        """Let two parts pass through each other."""
        self._set(one, other, touching=False)
        for place in (one, other):
            self._pairs.setdefault(place.body, set()).add((one, other))

    def forget(self, body: int) -> None:
        """Let what gets the number of a body that has gone touch all.

        Of bodies that are there PyBullet would look for collisions anew, which takes its time.
        """
        for pair in self._pairs.pop(body, ()):
            self._set(*pair, touching=True)
            for place in pair:
                self._pairs.get(place.body, set()).discard(pair)

    def clear(self) -> None:
        """Forget all; PyBullet has done so, too."""
        self._pairs.clear()

    def _set(self, one: Place, other: Place, touching: bool) -> None:
        pybullet.setCollisionFilterPair(
            one.body, other.body, one.link, other.link, int(touching), self._client
        )
