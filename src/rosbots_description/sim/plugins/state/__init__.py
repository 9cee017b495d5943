"""Plugins that report or set the state of a model; importing registers them."""

from . import joint_pose_trajectory, joint_state_publisher, p3d  # noqa: F401
from .joint_pose_trajectory import JointPoseTrajectory
from .joint_state_publisher import JointStatePublisher
from .p3d import P3D

__all__ = ['P3D', 'JointPoseTrajectory', 'JointStatePublisher']
