"""Lateness of the steps of a recorded server.

The schedule is one step per millisecond of wall time, fitted to the earliest step of a window. The
best of several windows counts, since other load can only delay steps. `report` also gives the
lateness over all windows, and that without the time in which the loop waited for a processor.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import chain, pairwise

STEP = 0.001  # [s]
WINDOW = 2000  # steps

Begins = Sequence[tuple[float, float]]  # start of each step, total waiting time until then [s]


def report(steps: Begins) -> dict[str, float]:
    """Return statistics of the lateness [s], by name."""
    windows = [steps[i : i + WINDOW] for i in range(0, len(steps) - WINDOW + 1, WINDOW)]
    late = [lateness(window) for window in windows]
    shares = {'p50': 0.5, 'p99': 0.99, 'p99.9': 0.999}
    found = {name: min(at(share, one) for one in late) for name, share in shares.items()}
    found['p99 of all windows'] = at(0.99, sorted(chain(*late)))
    found['max of all windows'] = max(one[-1] for one in late)
    own = sorted(chain(*map(lateness_of_its_own, windows)))
    found['p99 of all without waits for a processor'] = at(0.99, own)
    return found


def lateness(steps: Begins) -> list[float]:
    """Return the lateness of the steps, sorted [s]."""
    ahead = [begun - STEP * i for i, (begun, _) in enumerate(steps)]
    earliest = min(ahead)
    return sorted(begun - earliest for begun in ahead)


def lateness_of_its_own(steps: Begins) -> list[float]:
    """Return the lateness without waits for a processor, sorted [s]."""
    late, found = 0.0, []
    for (begun, waited), (begins, waits) in pairwise(steps):
        late = max(0.0, late + (begins - begun) - (waits - waited) - STEP)
        found.append(late)
    return sorted(found)


def at(share: float, late: list[float]) -> float:
    """Return the quantile of a sorted lateness [s]."""
    return late[int(share * len(late))]
