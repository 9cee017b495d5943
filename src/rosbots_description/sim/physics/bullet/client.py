"""PyBullet, imported without its banner. No other module imports it."""

from .silence import silent

with silent():  # it prints its build time
    import pybullet

__all__ = ['pybullet']
