"""Links and joints as a tree, before and after fixed joint reduction."""

from .fixed_joint_reduction import Reduction, reduce_fixed_joints, require_links
from .kinematic_tree import FREE, KinematicTree, LinkFlags, TreeJoint, TreeLink, build_tree

__all__ = [
    'FREE',
    'KinematicTree',
    'LinkFlags',
    'Reduction',
    'TreeJoint',
    'TreeLink',
    'build_tree',
    'reduce_fixed_joints',
    'require_links',
]
