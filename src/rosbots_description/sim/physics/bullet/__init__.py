"""The engine on PyBullet: generated bodies, contacts, friction, solver, and the crash sandbox."""

from .body import Body
from .client import pybullet
from .crash_sandbox import CrashSandbox
from .engine import Engine, make_engine
from .tuning import Tuning

__all__ = ['Body', 'CrashSandbox', 'Engine', 'Tuning', 'make_engine', 'pybullet']
