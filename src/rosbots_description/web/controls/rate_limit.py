"""A limit on how often something may happen."""

import time


class RateLimit:
    """A token bucket: so many at once, and so many more in each second of wall time."""

    def __init__(self, at_once: float, rate: float) -> None:
        """Begin with all of them allowed.

        Args:
            at_once: how many, at most.
            rate: how many more in a second.
        """
        self._at_once, self._rate = at_once, rate
        self._left, self._counted = at_once, time.monotonic()

    def has_one(self) -> bool:
        """Tell whether one more is allowed now."""
        now = time.monotonic()
        self._left = min(self._at_once, self._left + self._rate * (now - self._counted))
        self._counted = now
        return self._left >= 1.0

    def take(self) -> float:
        """Count one; return how long to wait until it is allowed [s], 0 if it is now."""
        self.has_one()
        self._left -= 1.0
        return max(0.0, -self._left / self._rate)
