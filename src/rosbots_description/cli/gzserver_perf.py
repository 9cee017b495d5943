"""Front end of the executable perf: the server under a profiler."""

from __future__ import annotations

import cProfile
import pstats
import sys
from collections.abc import Sequence

from . import gzserver

LINES = 40  # of the table


def main(arguments: Sequence[str] | None = None) -> int:
    """Run gzserver, print where the simulating thread spent its time, return the exit code.

    The simulation is slower meanwhile. Threads that answer ROS are not in the table.
    """
    profile = cProfile.Profile()
    try:
        return profile.runcall(gzserver.main, arguments)
    finally:
        pstats.Stats(profile, stream=sys.stdout).sort_stats('tottime').print_stats(LINES)
        sys.stdout.flush()
