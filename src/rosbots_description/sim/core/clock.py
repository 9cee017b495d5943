"""Simulated time: a whole number of steps, so that it never drifts and always repeats."""

NANOSECONDS = 1_000_000_000  # per second
END = 1 << 32  # [s] the 32 bits of a stamp's seconds overflow here, after some 136 years


class SimClock:
    """Counts steps; the time is `steps` times the step size since the last change of that size.

    Stamp and compare with `now_ns` [ns], which is exact; `now` [s] is for display.
    """

    def __init__(self, step_size: float) -> None:
        self.steps = 0
        self.step_ns = nanoseconds(step_size)
        self._origin_ns = 0  # time at which the current step size took effect
        self._origin_steps = 0

    def __repr__(self) -> str:
        """Return its time and step count."""
        return f'<{type(self).__name__} at {self.now} s, step {self.steps}>'

    @property
    def now_ns(self) -> int:
        """Return the simulated time [ns]."""
        return self.ns_at(self.steps)

    @property
    def now(self) -> float:
        """Return the simulated time [s]."""
        return self.now_ns / NANOSECONDS

    def ns_at(self, step: int) -> int:
        """Return the time [ns] of a step, past or future, since the last change of step size."""
        return self._origin_ns + (step - self._origin_steps) * self.step_ns

    def last_step(self) -> int:
        """Return the count of the last step that can be stamped."""
        return self.first_step_after(END * NANOSECONDS - 1) - 1

    def set_step_size(self, step_size: float) -> None:
        """Use `step_size` [s] for every step from now on."""
        self._origin_ns, self._origin_steps = self.now_ns, self.steps
        self.step_ns = nanoseconds(step_size)

    def first_step_after(self, time_ns: int) -> int:
        """Return the count of the first step whose time is later than `time_ns`."""
        return self._origin_steps + (time_ns - self._origin_ns) // self.step_ns + 1

    def reset(self) -> None:
        """Return to time zero."""
        self.steps = self._origin_ns = self._origin_steps = 0


def nanoseconds(seconds: float) -> int:
    """Return `seconds` as whole nanoseconds."""
    return round(seconds * NANOSECONDS)
