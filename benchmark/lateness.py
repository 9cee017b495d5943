"""How late the steps of a recorded server begin.

A step is on time if it begins when the wall clock says it should, the earliest of all steps being
the measure. The quietest of several windows counts: whatever else the machine does can only make
steps late. `report` tells, too, how late all of them were, and how late without the time in which
the loop was ready to go on and no processor was free.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import chain, pairwise

STEP = 0.001  # [s]
WINDOW = 2000  # steps

Begins = Sequence[tuple[float, float]]  # when steps begun, waited in all till then [s]


def report(steps: Begins) -> dict[str, float]:
    """Return how late steps were [s], by what it is of them."""
    windows = [steps[i : i + WINDOW] for i in range(0, len(steps) - WINDOW + 1, WINDOW)]
    late = [lateness(window) for window in windows]
    shares = {'p50': 0.5, 'p99': 0.99, 'p99.9': 0.999}
    found = {name: min(at(share, one) for one in late) for name, share in shares.items()}
    found['p99 of all windows'] = at(0.99, sorted(chain(*late)))
    found['max of all windows'] = max(one[-1] for one in late)
    own = sorted(chain(*map(lateness_of_its_own, windows)))
    found['p99 of all were a processor always free'] = at(0.99, own)
    return found


def lateness(steps: Begins) -> list[float]:
    """Return how late the steps were, in order [s]."""
    ahead = [begun - STEP * i for i, (begun, _) in enumerate(steps)]
    earliest = min(ahead)
    return sorted(begun - earliest for begun in ahead)


def lateness_of_its_own(steps: Begins) -> list[float]:
    """Return the same for a machine on which a processor is always free."""
    late, found = 0.0, []
    for (begun, waited), (begins, waits) in pairwise(steps):
        late = max(0.0, late + (begins - begun) - (waits - waited) - STEP)
        found.append(late)
    return sorted(found)


def at(share: float, late: list[float]) -> float:
    """Return how late that share of the steps was at most [s]."""
    return late[int(share * len(late))]
