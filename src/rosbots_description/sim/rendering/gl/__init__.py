"""Draws a scene with OpenGL, in a separate process that imports nothing of the simulator.

To start fast, that process puts the parent folder on its path and imports this package by its bare
name. It exchanges plain tuples and arrays with the simulator.
"""

from .values import BYTES, Appearance, Lens, Light, Scene, ScenePart, Wants

__all__ = ['BYTES', 'Appearance', 'Lens', 'Light', 'Scene', 'ScenePart', 'Wants']
