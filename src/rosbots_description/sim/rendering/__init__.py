"""What the world looks like: pictures without a screen, and meshes for a window."""

from .camera import EYE, TARGET, View
from .sunlit_meshes import SunlitMeshes

__all__ = ['EYE', 'TARGET', 'SunlitMeshes', 'View']
