"""The <state> of a saved world: read it off a model, and apply it to one."""

import math
from collections.abc import Mapping

from ..core import IDENTITY, Pose, compose, relative
from ..description import FIXED, PRISMATIC, WORLD, JointSpec, ModelSpec, ModelState
from .model import Model

_SAME = 1e-6  # [rad or m] between a joint's position and that of its links, at most


def state_of(model: Model) -> ModelState:
    """Move a model by rounding errors, so that its poses can be restored, and return its state."""
    axes = model.engine.settle_poses(model.body)
    states = model.engine.link_states(model.body)
    links = {name: states[name] for name in model.links}
    anchors = _anchors(model)
    return ModelState(
        model.name,
        # The model's frame moves with its first link, which may hang on a joint to the world.
        states[anchors[0]][0] if anchors else model.pose,
        {name: pose for name, (pose, _) in links.items()},
        {} if model.static else {name: twist for name, (_, twist) in links.items()},
        {name: joint.state() for name, joint in model.joints.items()},
        {name: joint.motor for name, joint in model.joints.items()},
        {name: axes[name] for name in links if name in axes},
    )


def apply_state(model: Model, state: ModelState) -> None:
    """Set a model's root poses and joint positions from a saved world; velocities and motors, too.

    A state that Gazebo saved has no velocities and motors here. A reset still returns the model to
    its spawn pose, as in Gazebo.
    """
    engine, body = model.engine, model.body
    if state.pose is not None:
        model.set_pose(state.pose)
    anchored = {} if state.pose is None else dict.fromkeys(_anchors(model), state.pose)
    links = {**anchored, **state.links}
    roots = {name: links[name] for name in body.roots if name in links}
    if roots:
        engine.set_root_poses(body, roots)
    for name in roots:
        if name in state.twists:
            engine.set_root_twist(body, name, state.twists[name])
    for name, position in joint_positions(model.spec, state).items():
        if name in model.joints:
            model.joints[name].set_position(*_exact(position, state.joints.get(name)))
    for name, motor in state.motors.items():
        if name in model.joints:
            model.joints[name].set_motor(*motor)  # until a plugin sets it
    engine.match_poses(body, {**anchored, **state.axes}, links)


def _anchors(model: Model) -> list[str]:
    """Return the roots that are no links: they stand for the world, to which joints lead."""
    return [root for root in model.body.roots if root not in model.links]


def _exact(position: float, saved: tuple[float, float] | None) -> tuple[float, float]:
    """Return the position and velocity of a joint, given the position that its links have.

    The saved position has the full turns and the last bits; but links moved by an editor count.
    """
    if saved is None:
        return position, 0.0
    is_same = abs(math.remainder(saved[0] - position, 2.0 * math.pi)) < _SAME
    return (saved[0] if is_same else position), saved[1]


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
