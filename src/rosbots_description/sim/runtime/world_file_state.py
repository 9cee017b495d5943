"""Apply the <state> of a saved world: derive joint positions from link poses."""

import math
from collections.abc import Mapping

from ..core import IDENTITY, Pose, compose, relative
from ..description import FIXED, PRISMATIC, WORLD, JointSpec, ModelSpec, ModelState
from .model import Model


def apply_state(model: Model, state: ModelState) -> None:
    """Set a model's root poses and joint positions from a saved world.

    A reset still returns it to its spawn pose, as in Gazebo.
    """
    if state.pose is not None:
        model.set_pose(state.pose)
    roots = {name: state.links[name] for name in model.body.roots if name in state.links}
    if roots:
        model.engine.set_root_poses(model.body, roots)
    for name, position in joint_positions(model.spec, state).items():
        if name in model.joints:
            model.joints[name].set_position(position)


def joint_positions(spec: ModelSpec, state: ModelState) -> dict[str, float]:
    """Return the positions [rad or m] of the joints between links with known poses."""
    placed: Mapping[str, Pose] = state.links
    if state.pose is not None:
        placed = {WORLD: state.pose, **state.links}
    zero = {WORLD: IDENTITY, **{link.name: link.pose for link in spec.links}}
    return {
        joint.name: _position(joint, zero, placed)
        for joint in spec.joints
        if joint.type != FIXED and joint.parent in placed and joint.child in placed
    }


def _position(joint: JointSpec, zero: Mapping[str, Pose], placed: Mapping[str, Pose]) -> float:
    """Return the joint position [rad or m], relative to the pose at position zero."""
    at_zero = relative(compose(zero[joint.child], joint.pose), zero[joint.parent])
    now = relative(compose(placed[joint.child], joint.pose), placed[joint.parent])
    moved = relative(now, at_zero)
    axis = joint.axis
    if joint.type == PRISMATIC:
        return sum(a * b for a, b in zip(axis, moved.position, strict=True))
    x, y, z, w = moved.orientation
    half = math.atan2(axis[0] * x + axis[1] * y + axis[2] * z, w)
    return math.remainder(2.0 * half, 2.0 * math.pi)
