"""Mechanics of the recorded drives: the friction law solved to convergence.

Where no closed form exists, this is the other end of the interval in which a motion must be. The
engine runs with 1,000 solver iterations at 0.1 ms. Plugins still act at each step of 1 ms, because
ramps depend on it. Results are in test/data/mechanics.json, written by benchmark/mechanics.py.
"""

import json
from contextlib import AbstractContextManager
from dataclasses import replace
from functools import cache

from rosbots_description.sim.description.physics_settings import PhysicsSettings
from rosbots_description.sim.physics.bullet.engine import Engine
from rosbots_description.sim.physics.bullet.tuning import Tuning
from rosbots_description.sim.runtime.world import World

from . import ROOT, empty_world

FILE = ROOT / 'test' / 'data' / 'mechanics.json'
PARTS = 10  # steps of the engine in a step of the world
CONVERGED = Tuning(iterations=20.0, residual=1e-16)  # 1,000 iterations; [m^2/s^2]


class ConvergedEngine(Engine):
    """The engine with smaller steps than the world."""

    def apply(self, physics: PhysicsSettings) -> None:
        """Apply settings; the step size is that of the world."""
        super().apply(replace(physics, step_size=physics.step_size / PARTS))

    def step(self, steps: int) -> None:
        """Advance physics by whole steps of the world."""
        super().step(PARTS * steps)


def converged_world(_: Tuning | None = None) -> AbstractContextManager[World]:
    """Return an empty world whose engine solves to convergence."""
    return empty_world(CONVERGED, ConvergedEngine)


@cache
def mechanics() -> dict:
    """Return quantities and trace of each recorded drive, by scene; see support/motion.py."""
    return json.loads(FILE.read_text(encoding='utf-8'))
