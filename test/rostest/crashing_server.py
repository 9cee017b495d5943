#!/usr/bin/env python3
"""The simulator with an engine that crashes on one kind of model and hangs on another.

Everything else is gzserver.
"""

import sys
import time
from pathlib import Path

from rosbots_description.cli.gzserver import main
from rosbots_description.sim.physics.bullet.engine import Engine

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from support.crashing import crash

HANGING = 'hanging'  # name of a link that hangs it


def add(engine, model, pose):
    while model.spec.link(HANGING):
        time.sleep(0.4)
        end = time.process_time() + 0.02  # uses processor time, and lasts for 40 s
        while time.process_time() < end:
            pass
    return crash(engine, model, pose)


if __name__ == '__main__':
    Engine.add = add
    sys.exit(main())
