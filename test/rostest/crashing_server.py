#!/usr/bin/env python3
"""The simulator with an engine that crashes on one kind of model and hangs on another.

Everything else is gzserver. No known description passes the checks and has such an effect.
"""

import os
import signal
import sys
import time

from rosbots_description.cli.gzserver import main
from rosbots_description.sim.physics.bullet.engine import Engine

CRASHING = 'crashing'  # name of a link that crashes the engine
HANGING = 'hanging'  # name of a link that hangs it


def add(engine, model, pose, _add=Engine.add):
    if model.spec.link(CRASHING):
        os.kill(os.getpid(), signal.SIGSEGV)
    while model.spec.link(HANGING):
        time.sleep(0.4)
        end = time.process_time() + 0.02  # uses processor time, and lasts for 40 s
        while time.process_time() < end:
            pass
    return _add(engine, model, pose)


if __name__ == '__main__':
    Engine.add = add
    sys.exit(main())
