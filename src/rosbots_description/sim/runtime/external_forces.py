"""Timed external forces: wrenches on links and efforts on joints."""

from collections.abc import Callable
from dataclasses import dataclass

from ..core import SimClock
from .model import Joint, Link
from .scheduler import NEVER, Hook


@dataclass(frozen=True)
class ExternalForce:
    """Calls `apply()` in each step from `start_ns` to `end_ns` [ns, simulated]; None: no end."""

    target: Link | Joint
    apply: Callable[[], None]
    start_ns: int
    end_ns: int | None


class ExternalForces(Hook):
    """Applies timed forces. It runs before all other hooks."""

    def __init__(self, clock: SimClock) -> None:
        self._clock = clock
        self._forces: list[ExternalForce] = []

    def add(
        self,
        target: Link | Joint,
        apply: Callable[[], None],
        start_ns: int,
        duration_ns: int,
    ) -> None:
        """Call `apply()` in each step from `start_ns`, or now, for `duration_ns`.

        Args:
            target: the link or joint on which the force acts.
            apply: called once per step.
            start_ns: start time [ns, simulated]; a past time means now.
            duration_ns: duration [ns], both ends included; negative: no end. A force that starts
                now acts from the next step on, so zero means not at all, as in Gazebo.
        """
        start_ns = max(start_ns, self._clock.now_ns)
        end_ns = None if duration_ns < 0 else start_ns + duration_ns
        self._forces.append(ExternalForce(target, apply, start_ns, end_ns))
        self._set_due()

    @property
    def are_pending(self) -> bool:
        """Whether a force acts, or will."""
        return bool(self._forces)

    def cancel(self, chosen: Callable[[Link | Joint], bool]) -> None:
        """Cancel the forces on targets for which `chosen` is true."""
        self._forces = [force for force in self._forces if not chosen(force.target)]
        self._set_due()

    def before_step(self) -> None:
        """Apply the forces of this step, and drop those that have ended."""
        now_ns = self._clock.now_ns
        self._forces = [one for one in self._forces if one.end_ns is None or now_ns <= one.end_ns]
        for force in self._forces:
            if force.start_ns <= now_ns:
                force.apply()
        self._set_due()

    def _set_due(self) -> None:
        if not self._forces:
            self.due = NEVER
            return
        first_ns = min(force.start_ns for force in self._forces)
        soonest = self._clock.first_step_after(first_ns - 1)
        self.due = max(soonest, self._clock.steps + 1)
