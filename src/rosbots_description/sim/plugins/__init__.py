"""Model plugins, chosen by the library name that a description gives; importing registers them."""

from .base import ModelPlugin
from .drive import DiffDrive, PlanarMove, SkidSteerDrive, TricycleDrive
from .force import WheelSlip

__all__ = [
    'DiffDrive', 'ModelPlugin', 'PlanarMove', 'SkidSteerDrive', 'TricycleDrive', 'WheelSlip',
]
