"""The smallest physics engine: wheels roll at the speeds of their motors, and nothing falls.

A wheel is a link with a cylinder on a joint that turns. The body moves as its driven wheels roll:
without slip where they agree, else by least squares. `doc/howto_add_an_engine.md` explains it.
"""

import copy
import math

import numpy as np

from rosbots_description.sim.core import Pose, Twist, add, compose, cross, inverse, rotate, subtract
from rosbots_description.sim.description import FIXED, PRISMATIC, WORLD, Cylinder
from rosbots_description.sim.physics import CompiledModel, JointState

FORCES = {'apply_wrench', 'apply_joint_effort', 'scale_mass', 'scale_friction', 'measure_reaction'}


class KinematicBody:
    """A model: where its roots and joints are, and the targets of its motors."""

    mass_scale, friction_scales = 1.0, {}

    def __init__(self, spec, pose):
        self.links = {link.name: link for link in spec.links}
        self.parents = {one.child: one for one in spec.joints if one.parent != WORLD}
        self.joints = {one.name: one for one in self.parents.values() if one.type != FIXED}
        self.roots = [name for name in self.links if name not in self.parents]
        fixed = {one.child for one in spec.joints if one.parent == WORLD}
        self.fixed_roots = {root for root in self.roots if spec.static or root in fixed}
        self.poses = {name: compose(pose, self.links[name].pose) for name in self.roots}
        self.twists = dict.fromkeys(self.roots, Twist())
        self.positions = dict.fromkeys(self.joints, 0.0)
        self.motors = dict.fromkeys(self.joints, (0.0, 0.0))

    def speed(self, joint):
        """Return the velocity of a joint [rad/s or m/s]: that of its motor, at once."""
        return self.motors[joint][0] if self.motors[joint][1] > 0.0 else 0.0

    def root(self, link):
        """Return the link at the root of a link's tree."""
        return self.root(self.parents[link].parent) if link in self.parents else link

    def pose(self, link):
        """Return the pose of a link's frame in the world."""
        if link not in self.parents:
            return self.poses[link]
        joint = self.parents[link]
        at_zero = compose(inverse(self.links[joint.parent].pose), self.links[link].pose)
        moved = _moved(joint, self.positions.get(joint.name, 0.0))
        in_link = compose(compose(joint.pose, moved), inverse(joint.pose))
        return compose(self.pose(joint.parent), compose(at_zero, in_link))

    def rolled(self, root):
        """Return speed ahead [m/s] and yaw rate [rad/s] at which the wheels of a root roll."""
        rows, speeds = [], []
        for joint in self.joints.values():
            rim = next(
                (
                    shape
                    for shape in self.links[joint.child].collisions
                    if isinstance(shape.geometry, Cylinder)
                ),
                None,
            )
            if rim and self.motors[joint.name][1] > 0.0 and self.root(joint.child) == root:
                wheel = compose(inverse(self.poses[root]), self.pose(joint.child))
                along, across, _ = cross(rotate(wheel.orientation, joint.axis_in_child), (0, 0, 1))
                x, y, _ = compose(wheel, rim.pose).position
                rows.append((along, x * across - y * along))
                speeds.append(self.speed(joint.name) * rim.geometry.radius)
        return np.linalg.lstsq(rows, speeds, rcond=None)[0].tolist() if rows else (0.0, 0.0)

    def step(self, dt):
        """Advance by one step [s]."""
        for root in self.poses.keys() - self.fixed_roots:
            speed, rate = self.rolled(root)
            half, way = 0.5 * rate * dt, speed * dt
            arc = (way * math.cos(half), way * math.sin(half), 0.0)
            turn = (0.0, 0.0, math.sin(half), math.cos(half))
            self.poses[root] = pose = compose(self.poses[root], Pose(arc, turn))
            self.twists[root] = Twist(
                rotate(pose.orientation, (speed, 0.0, 0.0)),
                rotate(pose.orientation, (0.0, 0.0, rate)),
            )
        for joint in self.joints:
            self.positions[joint] += self.speed(joint) * dt


def _moved(joint, position):
    """Return the motion of a joint, in its frame."""
    if joint.type == PRISMATIC:
        return Pose(tuple(part * position for part in joint.axis))
    sine = math.sin(0.5 * position)
    return Pose(orientation=(*(part * sine for part in joint.axis), math.cos(0.5 * position)))


class KinematicEngine:
    """A `PhysicsEngine` for worlds that are driven through; forces have no effect."""

    needs_rebuild, placements, advances = False, 0, 0

    def __init__(self, physics):
        self.bodies = []
        self.apply(physics)

    def apply(self, physics):
        self.dt = physics.step_size

    def close(self):
        self.bodies.clear()

    def step(self, steps):
        self.advances += 1
        for body in self.bodies:
            for _ in range(steps):
                body.step(self.dt)

    def compile(self, spec):
        return CompiledModel(spec, files=(), size=0)

    def add(self, model, pose):
        self.placements += 1
        self.bodies.append(KinematicBody(model.spec, pose))
        return self.bodies[-1]

    def remove(self, body):
        self.placements += 1
        self.bodies.remove(body)

    def link_pose(self, body, link):
        return body.pose(link)

    def link_state(self, body, link):
        pose, root = body.pose(link), body.root(link)
        linear, angular = body.twists[root]
        arm = subtract(pose.position, body.poses[root].position)
        return pose, Twist(add(linear, cross(angular, arm)), angular)

    def joint_state(self, body, joint):
        return JointState(body.positions[joint], body.speed(joint), effort=0.0)

    def set_joint_motor(self, body, joint, velocity, effort):
        body.motors[joint] = velocity, effort

    def snapshot(self):
        return copy.deepcopy([vars(body) for body in self.bodies])

    def restore(self, snapshot):
        self.placements += 1
        for body, state in zip(self.bodies, copy.deepcopy(snapshot), strict=True):
            vars(body).update(state)

    def has_diverged(self, body):
        return not all(map(math.isfinite, body.positions.values()))

    def __getattr__(self, name):
        if name not in FORCES:
            raise AttributeError(f'the kinematic engine has no {name}')
        return lambda *_: None
