#!/usr/bin/env python3
"""The simulator with an engine that one kind of model crashes and another hangs, as bugs might.

Everything else is gzserver as it is. No description is known that gets past the checks and does it.
"""

import os
import signal
import sys
import time

from rosbots_description.cli.gzserver import main
from rosbots_description.sim.physics.bullet.engine import Engine

DOOM = 'doom'  # a model with a link of this name crashes the engine
SLUMBER = 'slumber'  # and one with a link of this name keeps it waiting


def add(engine, model, pose, _add=Engine.add):
    if model.spec.link(DOOM):
        os.kill(os.getpid(), signal.SIGSEGV)
    while model.spec.link(SLUMBER):
        time.sleep(0.4)
        end = time.process_time() + 0.02  # it counts as awake, and lasts for 40 s
        while time.process_time() < end:
            pass
    return _add(engine, model, pose)


if __name__ == '__main__':
    Engine.add = add
    sys.exit(main())
