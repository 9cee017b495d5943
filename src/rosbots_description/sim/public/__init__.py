"""The public face: a world with its file formats, plugins and engine, as a script wants it."""

from .world import World

__all__ = ['World']
