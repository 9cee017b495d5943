"""Plugins that drive a model by velocity commands; importing registers them."""

from . import diff_drive, planar_move, skid_steer_drive, tricycle_drive  # noqa: F401
from .base import Drive
from .diff_drive import DiffDrive
from .planar_move import PlanarMove
from .skid_steer_drive import SkidSteerDrive
from .tricycle_drive import TricycleDrive

__all__ = ['DiffDrive', 'Drive', 'PlanarMove', 'SkidSteerDrive', 'TricycleDrive']
