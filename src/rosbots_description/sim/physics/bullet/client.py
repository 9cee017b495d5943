"""PyBullet, imported without its chatter. No other module imports it."""

from .silence import silent

with silent():  # it announces its build time
    import pybullet

__all__ = ['pybullet']
