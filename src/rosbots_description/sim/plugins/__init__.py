"""Model plugins, selected by library name in a description; importing registers them."""

from .base import ModelPlugin, PeriodicPlugin, offsets_in_gazebo
from .drive import (
    DiffDrive,
    Drive,
    ForceBasedMove,
    PlanarMove,
    RidgebackForceBasedMove,
    SkidSteerDrive,
    TricycleDrive,
)
from .force import Force, HandOfGod, WheelSlip
from .state import P3D, JointPoseTrajectory, JointStatePublisher

__all__ = [
    'P3D',
    'DiffDrive',
    'Drive',
    'Force',
    'ForceBasedMove',
    'HandOfGod',
    'JointPoseTrajectory',
    'JointStatePublisher',
    'ModelPlugin',
    'PeriodicPlugin',
    'PlanarMove',
    'RidgebackForceBasedMove',
    'SkidSteerDrive',
    'TricycleDrive',
    'WheelSlip',
    'offsets_in_gazebo',
]
