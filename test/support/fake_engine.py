"""A fake physics engine: motors reach their targets at once, joints turn, bodies do not move."""

import copy
import math
from types import SimpleNamespace

from rosbots_description.sim.core.errors import SimError
from rosbots_description.sim.core.transforms import Twist, compose
from rosbots_description.sim.physics.compiled_model import CompiledModel
from rosbots_description.sim.physics.engine import JointState, Motion, PhysicsEngine


class FakeEngine(PhysicsEngine):
    """Replaces the engine of a world; its only state is that of its bodies.

    A body has `spec`, `pose`, `twist`, and by joint name `state` (position and velocity), which
    tests may change. Forces have no effect, and there are no contacts. Other commands are the
    empty methods of the protocol.
    """

    needs_rebuild = False
    placements = advances = 0

    def __init__(self, physics):
        self.steps = []  # number of steps of each call of `step`
        self.slips = {}  # by link
        self.rigid = set()  # links that cannot slip
        self.bodies = []
        self.apply(physics)

    def apply(self, physics):
        self.step_size = physics.step_size

    def compile(self, spec):
        return CompiledModel(spec, (), 0)

    def add(self, model, pose):
        spec, root = model.spec, model.spec.links[0].name
        names = [joint.name for joint in spec.joints]
        self.bodies.append(
            SimpleNamespace(
                spec=spec,
                pose=pose,
                twist=Twist(),
                roots=[root],
                joints=set(names),
                mass_scale=1.0,
                friction_scales={},
                fixed_roots={root} if spec.static else set(),
                state={name: [0.0, 0.0] for name in names},
                motors=dict.fromkeys(names, (0.0, 0.0)),
            )
        )
        self.placements += 1
        return self.bodies[-1]

    def remove(self, body):
        self.bodies.remove(body)
        self.placements += 1

    def reset(self):
        self.bodies.clear()

    def step(self, steps):
        self.steps.append(steps)
        self.advances += 1
        for state in [state for body in self.bodies for state in body.state.values()]:
            for _ in range(steps):
                state[0] += state[1] * self.step_size

    def overlap(self, one, other):
        return 0.0

    def has_diverged(self, body):
        return not all(map(math.isfinite, (*body.pose.position, *body.twist.linear)))

    def motion(self, body):
        return Motion(
            {body.roots[0]: (body.pose, body.twist)},
            {name: tuple(state) for name, state in body.state.items()},
            body.motors,
        )

    def set_motion(self, body, motion):
        ((body.pose, body.twist),) = motion.roots.values()
        self.placements += 1
        body.state = {name: list(state) for name, state in motion.joints.items()}
        body.motors = dict(motion.motors)

    def link_pose(self, body, link):
        return compose(body.pose, body.spec.link(link).pose)

    def link_state(self, body, link):
        return self.link_pose(body, link), body.twist

    def link_states(self, body):
        return {link.name: self.link_state(body, link.name) for link in body.spec.links}

    def joint_state(self, body, joint):
        return JointState(*body.state[joint], body.motors[joint][1])

    def joint_states(self, body):
        return {name: self.joint_state(body, name) for name in body.joints}

    def set_root_poses(self, body, poses):
        self.placements += 1
        (body.pose,) = poses.values()

    def set_twist(self, body, twist):
        body.twist = twist

    def set_root_twist(self, body, link, twist):
        body.twist = twist

    def set_joint_position(self, body, joint, position, velocity=0.0):
        body.state[joint] = [position, velocity]
        self.placements += 1

    def motor(self, body, joint):
        return body.motors[joint]

    def set_joint_motor(self, body, joint, velocity, effort):
        body.motors[joint], body.state[joint][1] = (velocity, effort), velocity

    def can_slip(self, body, link, axis):
        return link not in self.rigid

    def set_slip_compliance(self, body, link, axis, compliances):
        self.slips[link] = compliances

    def snapshot(self):
        return [(body, copy.deepcopy(self.motion(body))) for body in self.bodies]

    def restore(self, snapshot):
        if [id(body) for body, _ in snapshot] != [id(body) for body in self.bodies]:
            raise SimError('the snapshot is of other models')
        for body, motion in snapshot:
            self.set_motion(body, motion)
