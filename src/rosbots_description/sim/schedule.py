"""What happens at which step: hooks say when they want to run next, the rest runs straight."""

import math
from fractions import Fraction

NEVER = 1 << 62  # a step count that no simulation reaches


class Hook:
    """Something that runs at certain steps, after time has advanced and before physics.

    `due` is the step count at which `update` is to run next. Set it in `update`, or from outside
    between two runs of the world, on the thread that owns the world.
    """

    due = NEVER

    def update(self) -> None:
        """Do the work of this step and set the next `due`."""
        raise NotImplementedError


class Schedule:
    """Hooks in the order they were added; they run in that order within a step."""

    def __init__(self) -> None:
        self._hooks: list[Hook] = []

    def add(self, hook: Hook) -> None:
        """Let `hook` run from now on, after those that were added before it."""
        self._hooks.append(hook)

    def remove(self, hook: Hook) -> None:
        """Let `hook` run no more."""
        self._hooks.remove(hook)

    def next_due(self) -> int:
        """Return the earliest step count at which a hook wants to run."""
        return min((hook.due for hook in self._hooks), default=NEVER)

    def run(self, step: int) -> None:
        """Run every hook that is due at `step` or was due before."""
        for hook in self._hooks:
            if hook.due <= step:
                hook.update()

    def change_step(self, now: int, ratio: Fraction) -> None:
        """Keep every hook due at its time, now that steps last `ratio` times as long.

        What falls between two steps of the new size happens at the later one.
        """
        for hook in self._hooks:
            if hook.due != NEVER:
                hook.due = now + max(1, math.ceil((hook.due - now) / ratio))
