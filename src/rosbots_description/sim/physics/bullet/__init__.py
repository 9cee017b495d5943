"""The engine on PyBullet: generated bodies, contacts, friction, solver, and the crash sandbox."""

from .body import Body
from .client import pybullet
from .crash_sandbox import Trials
from .engine import Engine
from .friction_axes import can_slip
from .generated_urdf import mesh_needs
from .size_limits import MAX_JOINTS, excess
from .tuning import Tuning

__all__ = [
    'MAX_JOINTS', 'Body', 'Engine', 'Trials', 'Tuning', 'can_slip', 'excess', 'mesh_needs',
    'pybullet',
]
