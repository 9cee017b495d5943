"""An engine that crashes on one kind of model; no known description has such an effect."""

import os
import signal

from rosbots_description.sim.physics.bullet.engine import Engine

CRASHING = 'crashing'  # name of a link that crashes the engine


def crash(engine, model, pose, _add=Engine.add):
    """Add a model as `Engine.add` does, unless it is of that kind."""
    if model.spec.link(CRASHING):
        os.kill(os.getpid(), signal.SIGSEGV)
    return _add(engine, model, pose)
