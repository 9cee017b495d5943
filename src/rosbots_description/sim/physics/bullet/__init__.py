"""The engine on PyBullet: generated bodies, contacts, friction and solver."""

from .body import Body
from .client import pybullet
from .engine import Engine, make_engine
from .tuning import Tuning

__all__ = ['Body', 'Engine', 'Tuning', 'make_engine', 'pybullet']
