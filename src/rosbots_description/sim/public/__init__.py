"""The public API: a world with its file formats, plugins and engine."""

from .world import World

__all__ = ['World']
