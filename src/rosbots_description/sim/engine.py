"""The physics engine: specs and names in, plain values out.

This module and canvas.py alone know PyBullet, and only this one imports it.

PyBullet's habits end here: its poses are those of the centre of mass, ours those of the link
frame; its quaternions are (x, y, z, w) like ours; its defaults (damping, motors on every joint, a
cap on joint speed) are switched off, so that bodies move as rigid-body mechanics has it.
"""

import os

from .body import Body, Motion, Part
from .bullet_description import (
    RIDER_MASS,
    MeshFile,
    Tree,
    describe_tree,
    friction,
    kinematic_trees,
    rider_surfaces,
)
from .inertia import principal_axes
from .physics import PhysicsSettings
from .pose import Pose, Twist, Vector, add, compose, cross, inverse, rotate, subtract
from .silence import silent
from .spec import FIXED, Collision, Cylinder, Inertial, JointSpec, LinkSpec, ModelSpec

# PyBullet solves in joint coordinates and comes as near with fewer passes than ODE. 20 for ODE's 50
# cost a third less per step than 50 and change steady speeds by less than 0.5 % (doc/physics.md).
_ITERATIONS = 0.4
# A wheel touches along a line and scrubs when it turns on the spot. Its torque per normal force is
# this share of the wheel's width: 1/4 if the line is pressed evenly, 0 if only one edge touches.
_SCRUB = 1 / 8
# Rate at which overlapping bodies are pushed apart [1/s]. PyBullet's own 200 (at 1 ms) shoots a box
# that is spawned half sunk 20 m high, this 0.1 m; Gazebo limits the speed, which PyBullet cannot.
_PUSH_OUT = 10.0
_MASSLESS = Inertial(0.0)
_ANY_SPEED = 1e6  # [rad/s or m/s] PyBullet would stop every joint at 100
_STIFFEST = 1e12  # [N/m] the stiffness that SDF gives to contacts nobody described


with silent():  # it announces its build time
    import pybullet


class Engine:
    """One PyBullet world in this process, without window and without chatter."""

    def __init__(
        self, physics: PhysicsSettings, mesh_file: MeshFile, surface_file: MeshFile
    ) -> None:
        """Open an empty world.

        Args:
            mesh_file: gives the file of a mesh's convex hull, for bodies that move.
            surface_file: gives the file of a mesh's exact surface, for bodies that stand.
        """
        self._mesh_file = mesh_file
        self._surface_file = surface_file
        self._client = pybullet.connect(pybullet.DIRECT)
        self._step = pybullet.stepSimulation
        self._weightless: dict[int, list[tuple[int, float]]] = {}  # body -> (index, mass)
        self.apply(physics)

    def close(self) -> None:
        """Free the world; the engine cannot be used afterwards."""
        pybullet.disconnect(self._client)

    def apply(self, physics: PhysicsSettings) -> None:
        """Use these settings from the next step on."""
        self._gravity = physics.gravity
        pybullet.setGravity(*physics.gravity, physicsClientId=self._client)
        pybullet.setPhysicsEngineParameter(
            fixedTimeStep=physics.step_size,
            numSolverIterations=max(1, round(physics.sor_pgs_iters * _ITERATIONS)),
            numSubSteps=0,
            contactERP=_overlap_share(physics.step_size),
            enableFileCaching=0,  # else a second model under a file name gets the first one's text
            physicsClientId=self._client,
        )
        self._physics = physics

    def reset(self) -> None:
        """Remove everything; the same bodies added again then move bit for bit as before."""
        pybullet.resetSimulation(physicsClientId=self._client)
        self._weightless.clear()
        self.apply(self._physics)

    def step(self, steps: int) -> None:
        """Advance physics by whole steps."""
        step, client = self._step, self._client
        for _ in range(steps):
            if self._weightless:
                self._lift_weightless()
            step(client)

    def add(self, spec: ModelSpec, pose: Pose) -> Body:
        """Put a model into the world, its frame at `pose`, all joints at zero."""
        body = Body()
        try:
            for tree in kinematic_trees(spec):
                self._add_tree(body, tree, pose)
            self._exclude_collisions_within(body, spec)
        except BaseException:
            self.remove(body)  # nothing half made stays behind unseen
            raise
        return body

    def remove(self, body: Body) -> None:
        """Take a model out of the world."""
        for number in body.bodies:
            self._weightless.pop(number, None)
            pybullet.removeBody(number, self._client)

    def motion(self, body: Body) -> Motion:
        """Return where a model is and how it moves, all of it."""
        return Motion(
            {link: self.link_state(body, link) for link in body.roots},
            {name: self.joint_state(body, name) for name in body.joints},
            dict(body.motors),
        )

    def set_motion(self, body: Body, motion: Motion) -> None:
        """Let a model be where another one of the same links and joints was, moving as it did."""
        self.set_root_poses(body, {link: pose for link, (pose, _) in motion.roots.items()})
        for link, (_, twist) in motion.roots.items():
            self.set_root_twist(body, link, twist)
        for name, state in motion.joints.items():
            pybullet.resetJointState(*body.joints[name], *state, self._client)
            self.set_joint_motor(body, name, *motion.motors[name])

    def link_pose(self, body: Body, link: str) -> Pose:
        """Return where the link's frame stands in the world."""
        part = body.parts[link]
        if part.index < 0:
            com = Pose(*pybullet.getBasePositionAndOrientation(part.body, self._client))
        else:
            com = Pose(*self._link_state(part)[:2])
        return compose(com, part.origin_in_com)

    def link_state(self, body: Body, link: str) -> tuple[Pose, Twist]:
        """Return the pose of the link's frame and the velocity of its origin, in world axes."""
        part = body.parts[link]
        if part.index < 0:
            com = Pose(*pybullet.getBasePositionAndOrientation(part.body, self._client))
            linear, angular = pybullet.getBaseVelocity(part.body, self._client)
        else:
            state = self._link_state(part)
            com, linear, angular = Pose(*state[:2]), state[6], state[7]
        pose = compose(com, part.origin_in_com)
        arm = subtract(pose.position, com.position)
        return pose, Twist(add(linear, cross(angular, arm)), angular)

    def set_root_poses(self, body: Body, poses: dict[str, Pose]) -> None:
        """Put the frames of root links at these poses; the links they carry come along.

        Velocities stay; PyBullet would zero them.
        """
        for link, pose in poses.items():
            part = body.parts[link]
            com = compose(pose, part.com_in_origin)
            velocity = pybullet.getBaseVelocity(part.body, self._client)
            pybullet.resetBasePositionAndOrientation(part.body, *com, self._client)
            pybullet.resetBaseVelocity(part.body, *velocity, physicsClientId=self._client)

    def set_twist(self, body: Body, twist: Twist) -> None:
        """Let all links move with this velocity of their root's origin, in world axes."""
        for link in body.roots:
            self.set_root_twist(body, link, twist)
        for number, index in body.joints.values():
            position = pybullet.getJointState(number, index, self._client)[0]
            pybullet.resetJointState(number, index, position, 0.0, self._client)

    def set_root_twist(self, body: Body, link: str, twist: Twist) -> None:
        """Let a root link move with this velocity of its origin, in world axes; joints go on.

        A root that the world holds stays at rest.
        """
        if link in body.bolted:
            return
        part = body.parts[link]
        com = rotate(self.link_pose(body, link).orientation, part.com_in_origin.position)
        linear = add(twist.linear, cross(twist.angular, com))
        pybullet.resetBaseVelocity(part.body, linear, twist.angular, physicsClientId=self._client)

    def push(self, body: Body, link: str, force: Vector, torque: Vector) -> None:
        """Push a link during the next step: force [N] at its centre of mass and torque [N m].

        Both are given in world axes and add to other pushes.
        """
        part = body.parts[link]
        com = compose(self.link_pose(body, link), part.com_in_origin).position
        world, client = pybullet.WORLD_FRAME, self._client
        pybullet.applyExternalForce(part.body, part.index, force, com, world, client)
        pybullet.applyExternalTorque(part.body, part.index, torque, world, client)

    def push_joint(self, body: Body, joint: str, effort: float) -> None:
        """Push a joint during the next step by `effort` [N m or N], beside its motor."""
        pybullet.setJointMotorControl2(
            *body.joints[joint], pybullet.TORQUE_CONTROL, force=effort, physicsClientId=self._client
        )

    def joint_state(self, body: Body, joint: str) -> tuple[float, float]:
        """Return position [rad or m] and velocity [rad/s or m/s] of a joint."""
        number, index = body.joints[joint]
        return pybullet.getJointState(number, index, self._client)[:2]

    def joint_effort(self, body: Body, joint: str) -> float:
        """Return what the joint's motor gave in the last step [N m or N]."""
        number, index = body.joints[joint]
        return pybullet.getJointState(number, index, self._client)[3]

    def normal_force(self, body: Body, link: str) -> float:
        """Return the sum of the normal forces on a link in the last step [N]."""
        part = body.parts[link]
        contacts = pybullet.getContactPoints(
            bodyA=part.body, linkIndexA=part.index, physicsClientId=self._client
        )
        return sum(contact[9] for contact in contacts)

    def set_joint_position(self, body: Body, joint: str, position: float) -> None:
        """Put a joint at `position` [rad or m], at rest."""
        number, index = body.joints[joint]
        pybullet.resetJointState(number, index, position, 0.0, self._client)

    def set_joint_motor(self, body: Body, joint: str, velocity: float, effort: float) -> None:
        """Drive a joint towards `velocity` [rad/s or m/s] with at most `effort` [N m or N]."""
        velocity = max(-_ANY_SPEED, min(_ANY_SPEED, velocity))
        body.motors[joint] = (velocity, effort)
        pybullet.setJointMotorControl2(
            *body.joints[joint],
            pybullet.VELOCITY_CONTROL,
            targetVelocity=velocity,
            force=effort,
            physicsClientId=self._client,
        )

    def _link_state(self, part: Part) -> tuple:
        return pybullet.getLinkState(
            part.body,
            part.index,
            computeLinkVelocity=1,
            computeForwardKinematics=1,
            physicsClientId=self._client,
        )

    def _lift_weightless(self) -> None:
        """Hold up the links that feel no gravity; PyBullet knows only one gravity for all."""
        gx, gy, gz = self._gravity
        for number, links in self._weightless.items():
            for index, mass in links:
                force = (-mass * gx, -mass * gy, -mass * gz)
                state = (
                    pybullet.getBasePositionAndOrientation(number, self._client)
                    if index < 0
                    else pybullet.getLinkState(number, index, 0, 1, self._client)
                )
                pybullet.applyExternalForce(
                    number, index, force, state[0], pybullet.WORLD_FRAME, self._client
                )

    def _add_tree(self, body: Body, tree: Tree, model_pose: Pose) -> None:
        inertials = [link.inertial or _MASSLESS for link in tree.links]
        moments, axes = zip(*(principal_axes(inertial) for inertial in inertials), strict=True)
        coms = [
            Pose(inertial.pose.position, orientation)
            for inertial, orientation in zip(inertials, axes, strict=True)
        ]
        text = describe_tree(tree, coms, self._surface_file if tree.stands else self._mesh_file)
        number = self._load_urdf(text, tree, compose(model_pose, tree.links[0].pose))
        body.bodies.append(number)
        body.roots.append(tree.links[0].name)
        if tree.fixed_base:
            body.bolted.add(tree.links[0].name)
        index_of = self._indices(number)
        # In a call of its own: together with an inertia PyBullet gives that inertia to the base.
        pybullet.changeDynamics(
            number,
            -1,
            linearDamping=tree.links[0].linear_damping,
            angularDamping=tree.links[0].angular_damping,
            maxJointVelocity=_ANY_SPEED,
            physicsClientId=self._client,
        )
        for i, (link, joint) in enumerate(zip(tree.links, tree.joints, strict=True)):
            part = Part(number, index_of[f'l{i}'], inverse(coms[i]), coms[i])
            body.parts[link.name] = part
            self._set_dynamics(part, index_of, i, link, moments[i], joint)
            if joint is not None and joint.type != FIXED:
                body.joints[joint.name] = (number, part.index)
                self.set_joint_motor(body, joint.name, 0.0, joint.friction)
            if not link.gravity and not (tree.fixed_base and i == 0):
                self._weightless.setdefault(number, []).append((part.index, inertials[i].mass))

    def _load_urdf(self, text: str, tree: Tree, pose: Pose) -> int:
        flags = pybullet.URDF_USE_IMPLICIT_CYLINDER | pybullet.URDF_USE_INERTIA_FROM_FILE
        if sum(link.self_collide for link in tree.links) > 1:
            # Quadruples the cost of a step, so only where asked for.
            flags |= pybullet.URDF_USE_SELF_COLLISION
        # A file that lives in memory only: no disk to fill, nothing left behind.
        descriptor = os.memfd_create('model')
        try:
            os.write(descriptor, text.encode())
            return pybullet.loadURDF(
                f'/proc/self/fd/{descriptor}',
                *pose,
                useFixedBase=tree.fixed_base,
                flags=flags,
                physicsClientId=self._client,
            )
        finally:
            os.close(descriptor)

    def _indices(self, number: int) -> dict[str, int]:
        """Return PyBullet's index of every link of a body; the root `l0` is the base, -1."""
        indices = {'l0': -1}
        for index in range(pybullet.getNumJoints(number, self._client)):
            indices[pybullet.getJointInfo(number, index, self._client)[12].decode()] = index
        return indices

    def _set_dynamics(
        self,
        part: Part,
        index_of: dict[str, int],
        i: int,
        link: LinkSpec,
        inertia: Vector,
        joint: JointSpec | None,
    ) -> None:
        pybullet.changeDynamics(
            part.body,
            part.index,
            localInertiaDiagonal=inertia,
            jointDamping=joint.damping if joint else 0.0,
            physicsClientId=self._client,
        )
        for k, collision in enumerate(rider_surfaces(link)):
            index = part.index
            if k > 0:
                index = index_of[f'l{i}r{k}']
                pybullet.changeDynamics(
                    part.body,
                    index,
                    localInertiaDiagonal=(RIDER_MASS,) * 3,
                    physicsClientId=self._client,
                )
            self._set_surface(part.body, index, collision)

    def _exclude_collisions_within(self, body: Body, spec: ModelSpec) -> None:
        """Let two links of a model touch only if both ask for it and no joint connects them."""
        if len(body.bodies) == 1 and not any(link.self_collide for link in spec.links):
            return  # one body without the self-collision flag never touches itself
        joined = {frozenset((joint.parent, joint.child)) for joint in spec.joints}
        for i, a in enumerate(spec.links):
            for b in spec.links[i + 1 :]:
                if a.self_collide and b.self_collide and {a.name, b.name} not in joined:
                    continue
                part_a, part_b = body.parts[a.name], body.parts[b.name]
                pybullet.setCollisionFilterPair(
                    part_a.body, part_b.body, part_a.index, part_b.index, 0, self._client
                )

    def _set_surface(self, number: int, index: int, collision: Collision) -> None:
        surface, shape = collision.surface, collision.geometry
        pybullet.changeDynamics(
            number,
            index,
            lateralFriction=friction(surface),
            spinningFriction=shape.length * _SCRUB if isinstance(shape, Cylinder) else 0.0,
            rollingFriction=0.0,
            restitution=0.0,
            physicsClientId=self._client,
        )
        if surface.kp < _STIFFEST:
            # As a spring that gives way by force / kp at rest, and is damped so much that it parts
            # bodies no faster than other contacts do; a kd of a user's could shoot them away.
            step = self._physics.step_size
            least = step * surface.kp * (1.0 / _overlap_share(step) - 1.0)
            pybullet.changeDynamics(
                number,
                index,
                contactStiffness=surface.kp,
                contactDamping=max(surface.kd, least),
                physicsClientId=self._client,
            )


def _overlap_share(step_size: float) -> float:
    """Return the share of an overlap that contacts take away in a step of that size [s]."""
    return min(0.2, _PUSH_OUT * step_size)
