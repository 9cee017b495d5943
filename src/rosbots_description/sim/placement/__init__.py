"""Where a new model has room, and under which name."""

from .places import box_around, free_name, placed

__all__ = ['box_around', 'free_name', 'placed']
