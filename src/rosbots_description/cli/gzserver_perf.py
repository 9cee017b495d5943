"""Front end of the executable perf: gzserver under a profiler."""

from __future__ import annotations

import cProfile
import pstats
import sys
from collections.abc import Sequence

from . import gzserver

LINES = 40  # of the table


def main(arguments: Sequence[str] | None = None) -> int:
    """Run gzserver, print a profile of the simulation thread, return the exit code.

    Profiling slows the simulation down. ROS's threads are not included.
    """
    profile = cProfile.Profile()
    try:
        return profile.runcall(gzserver.main, arguments)
    finally:
        pstats.Stats(profile, stream=sys.stdout).sort_stats('tottime').print_stats(LINES)
        sys.stdout.flush()
