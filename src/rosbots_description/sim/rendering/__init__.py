"""Rendering: camera images without a display, and meshes for RViz."""

from .camera import EYE, TARGET, View
from .gl import BYTES, Lens
from .render_process import NoRendererError, RenderError
from .studio import Picture, Shutter
from .sunlit_meshes import SunlitMeshes

__all__ = [
    'BYTES', 'EYE', 'TARGET', 'Lens', 'NoRendererError', 'Picture', 'RenderError', 'Shutter',
    'SunlitMeshes', 'View',
]
