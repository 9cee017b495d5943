"""A physics engine whose motors obey at once, whose joints turn, and whose bodies stay put."""

import math

from rosbots_description.sim.core.transforms import Twist, compose
from rosbots_description.sim.physics.bullet.body import Body
from rosbots_description.sim.physics.compiled_model import CompiledModel


class FakeEngine:
    """Takes the place of `Engine` in a world; all its state is that of the bodies it made.

    A body has `spec`, `pose`, `twist` and, by the name of a joint, `state`: position and velocity,
    which a test may change.
    """

    waste = 0

    def __init__(self, physics, *_):
        self.steps = []  # how many each call of `step` has made
        self.slips = {}  # by link
        self.rigid = set()  # links that cannot slip
        self.bodies = []
        self.apply(physics)

    def apply(self, physics):
        self.step_size = physics.step_size

    def compile(self, spec):
        return CompiledModel(spec, ())

    def add(self, model, pose):
        body, spec = Body(0), model.spec
        body.spec, body.pose, body.twist = spec, pose, Twist()
        body.roots = [spec.links[0].name]
        body.joints = {joint.name: (0, index) for index, joint in enumerate(spec.joints)}
        body.state = {name: [0.0, 0.0] for name in body.joints}
        body.motors = dict.fromkeys(body.joints, (0.0, 0.0))
        self.bodies.append(body)
        return body

    def remove(self, body):
        self.bodies.remove(body)

    def reset(self):
        self.bodies.clear()

    def close(self):
        self.reset()

    def step(self, steps):
        self.steps.append(steps)
        for body in self.bodies:
            for state in body.state.values():
                for _ in range(steps):
                    state[0] += state[1] * self.step_size

    def has_diverged(self, body):
        return not all(map(math.isfinite, (*body.pose.position, *body.twist.linear)))

    def link_pose(self, body, link):
        return compose(body.pose, body.spec.link(link).pose)

    def link_state(self, body, link):
        return self.link_pose(body, link), body.twist

    def set_root_poses(self, body, poses):
        (body.pose,) = poses.values()

    def set_twist(self, body, twist):
        body.twist = twist

    def joint_reading(self, body, joint):
        return (*body.state[joint], (), body.motors[joint][1])

    def set_joint_motor(self, body, joint, velocity, effort):
        body.motors[joint], body.state[joint][1] = (velocity, effort), velocity

    def set_joint_position(self, body, joint, position):
        body.state[joint] = [position, 0.0]

    def can_slip(self, _body, link, _axle):
        return link not in self.rigid

    def let_slip(self, _body, link, _axle, slips):
        self.slips[link] = slips
