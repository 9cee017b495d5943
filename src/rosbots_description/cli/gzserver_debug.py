"""Front end of the executable debug: gzserver with faulthandler."""

from __future__ import annotations

import faulthandler
import signal
from collections.abc import Sequence

from . import gzserver


def main(arguments: Sequence[str] | None = None) -> int:
    """Run gzserver; show the stacks of all threads on a crash and on SIGUSR1.

    Returns:
        The server's exit code.
    """
    faulthandler.enable()
    faulthandler.register(signal.SIGUSR1)
    return gzserver.main(arguments)
