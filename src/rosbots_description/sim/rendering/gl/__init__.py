"""Draw a scene with OpenGL. It runs in a process of its own and imports nothing of the simulator.

That process is small and starts fast: it puts the folder above this one on its path and imports
this package by its bare name. What crosses its border are plain tuples and arrays.
"""

from .values import BYTES, Lens, Light, Look, Scene, ScenePart

__all__ = ['BYTES', 'Lens', 'Light', 'Look', 'Scene', 'ScenePart']
