"""Rendering: pictures without a display, and meshes for RViz and browsers."""

from .camera import EYE, OVERVIEW, TARGET, look_at
from .gl import BYTES, Lens, Wants
from .gltf import Look, visual_gltf
from .illustration import Figure, Illustrator
from .image_capture import ImageCapture, Picture
from .render_process import MAX_PENDING, NoRendererError, RenderError
from .sunlit_meshes import SunlitMeshes

__all__ = [
    'BYTES',
    'EYE',
    'MAX_PENDING',
    'OVERVIEW',
    'TARGET',
    'Figure',
    'Illustrator',
    'ImageCapture',
    'Lens',
    'Look',
    'NoRendererError',
    'Picture',
    'RenderError',
    'SunlitMeshes',
    'Wants',
    'look_at',
    'visual_gltf',
]
