"""Plugins that report or set the state of a model; importing registers them."""

from .joint_pose_trajectory import JointPoseTrajectory
from .joint_state_publisher import JointStatePublisher
from .p3d import P3D

__all__ = ['P3D', 'JointPoseTrajectory', 'JointStatePublisher']
