"""Model plugins, selected by library name in a description; importing registers them."""

from .base import ModelPlugin, PeriodicPlugin, offsets_in_gazebo
from .drive import DiffDrive, Drive, PlanarMove, SkidSteerDrive, TricycleDrive
from .force import Force, HandOfGod, WheelSlip
from .state import P3D, JointPoseTrajectory, JointStatePublisher

__all__ = [
    'P3D', 'DiffDrive', 'Drive', 'Force', 'HandOfGod', 'JointPoseTrajectory', 'JointStatePublisher',
    'ModelPlugin', 'PeriodicPlugin', 'PlanarMove', 'SkidSteerDrive', 'TricycleDrive', 'WheelSlip',
    'offsets_in_gazebo',
]
