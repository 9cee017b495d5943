#!/usr/bin/env python3
"""The simulator with an engine that one kind of model really crashes, as if PyBullet had that bug.

Everything else is gzserver as it is. No description is known that gets past the checks and does it.
"""

import os
import signal
import sys

from rosbots_description.cli.gzserver import main
from rosbots_description.sim.engine import Engine

DOOM = 'doom'  # a model with a link of this name crashes the engine


def add(engine, spec, pose, _add=Engine.add):
    if spec.link(DOOM):
        os.kill(os.getpid(), signal.SIGSEGV)
    return _add(engine, spec, pose)


if __name__ == '__main__':
    Engine.add = add
    sys.exit(main())
