"""The loop that owns the world, and what services, topics and adapters reach through it."""

from .loop import Loop, LoopError
from .server import Server
from .static_frames import STATIC_TOPIC, from_root

__all__ = ['STATIC_TOPIC', 'Loop', 'LoopError', 'Server', 'from_root']
