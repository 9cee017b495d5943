"""Limits on the size of a model, so that adding it takes bounded time."""

from collections.abc import Sequence

from ...description import ModelSpec
from .generated_urdf import Tree
from .shape_groups import Groups

# A tree with more joints loads, but PyBullet fails at the first query of it.
MAX_JOINTS = 127

# Links of all trees after the reduction of fixed joints. The collision filter is set for each pair
# of links.
MAX_LINKS = 500

# Collisions and visuals. Each collision in contact costs time in every step, and each visual is a
# separate marker in RViz.
MAX_SHAPES = 5000


def excess_of_parts(spec: ModelSpec) -> str | None:
    """Return a sentence on the limit that a model exceeds; None if there is none."""
    if len(spec.links) > MAX_LINKS:
        return (
            f'the model has {len(spec.links)} links that fixed joints do not merge; '
            f'at most {MAX_LINKS} are accepted: spawn parts as models of their own'
        )
    shapes = sum(len(link.collisions) + len(link.visuals) for link in spec.links)
    if shapes > MAX_SHAPES:
        return (
            f'the model has {shapes} collisions and visuals; at most {MAX_SHAPES} are accepted: '
            'put more into one mesh'
        )
    return None


def excess_of_joints(tree: Tree, groups: Sequence[Groups]) -> str | None:
    """Return a sentence if a tree needs more joints than the engine holds, else None.

    Args:
        groups: of each link, from shape_groups.py.
    """
    joints = len(tree.links) - 1
    if joints > MAX_JOINTS:
        return (
            f'a kinematic tree of the model has more than {MAX_JOINTS} joints, the limit of the '
            'physics engine: split the model'
        )
    # Each further surface of a link needs an auxiliary link on a fixed joint.
    auxiliary = sum(len(of_link) - 1 for of_link in groups)
    if joints + auxiliary > MAX_JOINTS:
        return (
            f'a kinematic tree of the model has {auxiliary} collisions with surfaces of their own '
            f'and {joints} joints; the physics engine supports {MAX_JOINTS} of both: give the '
            'collisions of a link the same mu, kp and kd'
        )
    return None
