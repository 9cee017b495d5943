"""Plugins that drive a model by velocity commands; importing registers them."""

from .base import Drive
from .diff_drive import DiffDrive
from .force_based_move import ForceBasedMove, RidgebackForceBasedMove
from .planar_move import PlanarMove
from .skid_steer_drive import SkidSteerDrive
from .tricycle_drive import TricycleDrive

__all__ = [
    'DiffDrive',
    'Drive',
    'ForceBasedMove',
    'PlanarMove',
    'RidgebackForceBasedMove',
    'SkidSteerDrive',
    'TricycleDrive',
]
