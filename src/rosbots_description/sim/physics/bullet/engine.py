"""The physics engine: specs and names in, plain values out.

PyBullet's habits end here: its poses are those of the centre of mass, ours those of the link
frame; its quaternions are (x, y, z, w) like ours; its defaults (damping, motors on every joint, a
cap on joint speed) are switched off, so that bodies move as rigid-body mechanics has it.
"""

import math
from collections.abc import Iterator, Sequence
from itertools import repeat

from ...core import LARGEST, Pose, Twist, Vector, add, compose, cross, rotate, subtract
from ...description import ModelSpec, PhysicsSettings
from ...meshes import MeshStore
from .body import Body, Motion, Part
from .body_maker import ANY_SPEED, BodyMaker
from .client import pybullet
from .compiler import BulletModel, compile_model
from .contact_slip import Slipping
from .fast_rotation import FastBodies
from .friction_axes import can_slip
from .solver_iterations import CHECK, Motor, SolverEffort
from .springs import Springs
from .surfaces import overlap_share
from .tuning import Tuning

# What is asked for beyond these comes out as these. Squares of greater numbers overflow, and then
# whatever a body touches is no number any more either, the ground first.
_ANY_FORCE = 1e15  # [N or N m]
_TOGETHER = 20  # steps in one call, which costs less than a call each
# Squared velocity [m^2/s^2] by which no contact or motor changes in the solver's last iteration.
# PyBullet's own 1e-7 leaves a robot that is parked on a slope 0.01 mm/s.
_CONVERGED = 1e-8


class Engine:
    """One PyBullet world in this process, without window and without chatter."""

    def __init__(self, physics: PhysicsSettings, tuning: Tuning | None = None) -> None:
        """Open an empty world.

        Args:
            tuning: other choices than the usual ones, to measure what they do.
        """
        self._meshes = MeshStore()
        self._tuning = tuning or Tuning()
        self._client = pybullet.connect(pybullet.DIRECT)
        self._maker = BodyMaker(self._client, self._tuning)
        self._step = pybullet.stepSimulation
        self._effort = SolverEffort(self._set_iterations)
        self._until_look = CHECK  # steps
        self._pushed = False  # since the last step
        self._driven: dict[Body, None] = {}  # those with motors, in the order they came
        self._fast = FastBodies(self._client)
        self._springs = Springs(self._client)
        self._weightless: list[Body] = []  # those with links that feel no gravity
        self._slipping = Slipping(self._client, self._maker.scale_friction, self._reach)
        # Bytes that were read to make bodies that are gone; PyBullet keeps what it made of them.
        self.waste = 0
        # What has been read since the last step, by PyBullet's body, in the order of Body.indices:
        # reading one joint costs as much as reading all of a body's.
        self._joint_readings: dict[int, Sequence[tuple]] = {}
        self.apply(physics)

    def close(self) -> None:
        """Free the world and remove its mesh files; the engine cannot be used afterwards."""
        pybullet.disconnect(self._client)
        self._meshes.close()

    def apply(self, physics: PhysicsSettings) -> None:
        """Use these settings from the next step on."""
        self._gravity = physics.gravity
        self._cone = physics.friction_cone or self._tuning.friction_cone
        self._maker.set_step_size(physics.step_size)
        self._fast.set(physics.step_size, physics.gravity)
        self._springs.set_step_size(physics.step_size)
        pybullet.setGravity(*physics.gravity, physicsClientId=self._client)
        pybullet.setPhysicsEngineParameter(
            fixedTimeStep=physics.step_size,
            numSubSteps=0,
            contactERP=overlap_share(physics.step_size, self._tuning.push_out),
            enableConeFriction=self._cone,
            collisionFilterMode=0,  # each of a pair must be willing to meet the other
            enableFileCaching=0,  # else a second model under a file name gets the first one's text
            minimumSolverIslandSize=1,  # what has converged waits for nobody else
            solverResidualThreshold=_CONVERGED,
            physicsClientId=self._client,
        )
        self._effort.start(max(1, round(physics.sor_pgs_iters * self._tuning.passes)))
        self._physics = physics
        self._together = _divisible(physics.step_size, _TOGETHER)

    def _reach(self, direction: Vector) -> float:
        """Return how many times its limit friction can hold in a level direction, a unit vector."""
        return 1.0 if self._cone else max(1.0, abs(direction[0]) + abs(direction[1]))

    def reset(self) -> None:
        """Remove everything; the same bodies added again then move bit for bit as before."""
        self._maker.reset()
        self._fast.clear()
        self._springs.clear()
        self._weightless.clear()
        self._driven.clear()
        self._until_look = CHECK
        self._slipping.clear()
        self._joint_readings.clear()
        self.waste = 0
        self.apply(self._physics)

    def step(self, steps: int) -> None:
        """Advance physics by whole steps."""
        fast = self._fast
        while steps > 0:
            if not fast.rest:
                fast.look()
            run = min(steps, self._until_look, fast.rest)
            self._step_alike(run)
            self._joint_readings.clear()
            steps -= run
            fast.rest -= run
            self._until_look -= run
            if not self._until_look:
                self._until_look = CHECK
                self._effort.look(self._motors())

    def _step_alike(self, steps: int) -> None:
        """Make steps in which the same bodies are fast."""
        step, client, fast = self._step, self._client, self._fast
        is_sprung = bool(self._springs)
        if self._pushed and steps > 1:  # a push lasts as long as a call of PyBullet
            self._step_alike(1)
            steps -= 1
        self._pushed = False
        if not (fast or is_sprung or self._weightless or self._slipping.links):
            while steps > 1:
                together = self._together[min(steps, _TOGETHER)]
                self._step_together(together)
                steps -= together
        for _ in repeat(None, steps):
            if self._weightless:
                self._lift_weightless()
            if is_sprung:
                self._springs.push()
            for body, link, slip in self._slipping.links:
                self.let_slip(body, link, *slip)
            step(client)
            if fast:
                fast.after_step()

    def _step_together(self, steps: int) -> None:
        """Make so many steps in one call; motors are to be set with the size of a single step."""
        size, client = self._physics.step_size, self._client
        resize = pybullet.setPhysicsEngineParameter
        resize(fixedTimeStep=steps * size, numSubSteps=steps, physicsClientId=client)
        self._step(client)
        resize(fixedTimeStep=size, numSubSteps=0, physicsClientId=client)

    def compile(self, spec: ModelSpec) -> BulletModel:
        """Make a model ready to be added; any thread may ask.

        Raises:
            ModelError: the engine cannot take it; the sentence says why.
        """
        return compile_model(spec, self._meshes)

    def add(self, model: BulletModel, pose: Pose) -> Body:
        """Put a model into the world, its frame at `pose`, all joints at zero."""
        body, spec = Body(model.size), model.spec
        try:
            for tree in model.trees:
                self._maker.add_tree(body, tree, pose)
            self._maker.exclude_collisions_within(body, spec)
        except BaseException:
            self.remove(body)  # nothing half made stays behind unseen
            raise
        for joint in spec.joints:
            if joint.name in body.joints:
                self.set_joint_motor(body, joint.name, 0.0, joint.friction)
        if body.weightless:
            self._weightless.append(body)
        self._fast.add(body.masses)
        self._springs.add(body.masses)
        self._slipping.add(body, spec)
        return body

    def remove(self, body: Body) -> None:
        """Take a model out of the world."""
        self._joint_readings.clear()
        if body in self._weightless:
            self._weightless.remove(body)
        self._slipping.remove(body)
        self._driven.pop(body, None)
        self._fast.forget(body.bodies)
        self._springs.forget(body.bodies)
        self.waste += body.size
        self._maker.remove(body)

    def overlap(self, one: Body, other: Body) -> float:
        """Return how deep two models reach into each other [m]; 0 if they do not."""
        return max((
            -point[8] for first in one.bodies for second in other.bodies
            for point in pybullet.getClosestPoints(first, second, 0.0, physicsClientId=self._client)
        ), default=0.0)

    def motion(self, body: Body) -> Motion:
        """Return where a model is and how it moves, all of it."""
        return Motion(
            {link: self.link_state(body, link) for link in body.roots},
            {name: self.joint_reading(body, name)[:2] for name in body.joints},
            dict(body.motors),
        )

    def set_motion(self, body: Body, motion: Motion) -> None:
        """Let a model be where another one of the same links and joints was, moving as it did."""
        self._joint_readings.clear()
        self.set_root_poses(body, {link: pose for link, (pose, _) in motion.roots.items()})
        for link, (_, twist) in motion.roots.items():
            self.set_root_twist(body, link, twist)
        for name, state in motion.joints.items():
            pybullet.resetJointState(*body.joints[name], *state, self._client)
            self.set_joint_motor(body, name, *motion.motors[name])

    def has_diverged(self, body: Body) -> bool:
        """Tell whether any link of a model moves by numbers that are not finite, or of no world."""
        # Also one that stands: what hits it with endless speed leaves it with a velocity of NaN.
        return not all(
            math.isfinite(number) and abs(number) < LARGEST for number in self._coordinates(body))

    def _coordinates(self, body: Body) -> Iterator[float]:
        """Yield all that says where the links of a model are and how fast: of roots, and joints."""
        for number in body.bodies:
            for numbers in pybullet.getBasePositionAndOrientation(number, self._client):
                yield from numbers
            for numbers in pybullet.getBaseVelocity(number, self._client):
                yield from numbers
            indices = body.indices.get(number)
            if indices:
                for state in pybullet.getJointStates(number, indices, self._client):
                    yield from state[:2]

    def link_pose(self, body: Body, link: str) -> Pose:
        """Return where the link's frame stands in the world."""
        part = body.parts[link]
        if part.index < 0:
            com = Pose(*pybullet.getBasePositionAndOrientation(part.body, self._client))
        else:
            com = Pose(*self._link_state(part, velocity=False)[:2])
        return compose(com, part.origin_in_com)

    def link_state(self, body: Body, link: str) -> tuple[Pose, Twist]:
        """Return the pose of the link's frame and the velocity of its origin, in world axes."""
        part = body.parts[link]
        if part.index < 0:
            com = Pose(*pybullet.getBasePositionAndOrientation(part.body, self._client))
            linear, angular = pybullet.getBaseVelocity(part.body, self._client)
        else:
            state = self._link_state(part, velocity=True)
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
            near = Pose(_at_most(pose.position, LARGEST), pose.orientation)
            com = compose(near, part.com_in_origin)
            velocity = pybullet.getBaseVelocity(part.body, self._client)
            for number in (part.body, *part.also):
                pybullet.resetBasePositionAndOrientation(number, *com, self._client)
                pybullet.resetBaseVelocity(number, *velocity, physicsClientId=self._client)
            self._fast.disturb(part.body)

    def set_twist(self, body: Body, twist: Twist) -> None:
        """Let all links move with this velocity of their root's origin, in world axes."""
        self._joint_readings.clear()
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
        angular = _at_most(twist.angular, ANY_SPEED)
        linear = add(_at_most(twist.linear, ANY_SPEED), cross(angular, com))
        pybullet.resetBaseVelocity(part.body, linear, angular, physicsClientId=self._client)
        self._fast.set_in_motion(part.body)

    def push(
        self, body: Body, link: str, force: Vector, torque: Vector, place: Vector | None = None
    ) -> None:
        """Push a link during the next step: force [N] and torque [N m], beside other pushes.

        Args:
            place: where the force acts [m], None for the centre of mass; all in world axes.
        """
        part = body.parts[link]
        if place is None:
            place = compose(self.link_pose(body, link), part.com_in_origin).position
        world, client = pybullet.WORLD_FRAME, self._client
        force, torque = _at_most(force, _ANY_FORCE), _at_most(torque, _ANY_FORCE)
        pybullet.applyExternalForce(part.body, part.index, force, place, world, client)
        pybullet.applyExternalTorque(part.body, part.index, torque, world, client)
        self._pushed = True
        self._fast.disturb(part.body)

    def push_joint(self, body: Body, joint: str, effort: float) -> None:
        """Push a joint during the next step by `effort` [N m or N], beside its motor."""
        effort = max(min(effort, _ANY_FORCE), -_ANY_FORCE)
        pybullet.setJointMotorControl2(
            *body.joints[joint], pybullet.TORQUE_CONTROL, force=effort, physicsClientId=self._client
        )
        self._pushed = True
        self._fast.disturb(body.joints[joint][0])

    def joint_reading(self, body: Body, joint: str) -> tuple:
        """Return PyBullet's state of a joint; all joints of a body are read in one call.

        It begins with position [rad or m] and velocity [rad/s or m/s]; the fourth is what the motor
        gave in the last step [N m or N].
        """
        number, index = body.joints[joint]
        readings, indices = self._joint_readings.get(number), body.indices[number]
        if readings is None:
            readings = pybullet.getJointStates(number, indices, self._client)
            self._joint_readings[number] = readings
        return readings[indices.index(index)]

    def can_slip(self, body: Body, link: str, axle: Vector) -> bool:
        """Tell whether a link can slip along an axis of its frame, a unit vector."""
        return can_slip(body, link, axle)

    def let_slip(self, body: Body, link: str, axle: Vector, slips: tuple[float, float]) -> None:
        """Let what a link touches slide in the next step as its slip compliance has it.

        Args:
            axle: unit vector in the link's frame, along which it can slip (`can_slip`).
            slips: compliance along the axle and ahead [m/s per N].
        """
        state = self.link_state(body, link)
        self._slipping.weaken(body, link, state, axle, slips, self._physics.step_size)

    def set_joint_position(self, body: Body, joint: str, position: float) -> None:
        """Put a joint at `position` [rad or m], at rest."""
        self._joint_readings.clear()
        number, index = body.joints[joint]
        pybullet.resetJointState(number, index, position, 0.0, self._client)
        self._fast.disturb(number)

    def set_joint_motor(self, body: Body, joint: str, velocity: float, effort: float) -> None:
        """Drive a joint towards `velocity` [rad/s or m/s] with at most `effort` [N m or N]."""
        if body.motors.get(joint) == (velocity, effort):
            return  # it does so already
        velocity = max(-ANY_SPEED, min(ANY_SPEED, velocity))
        body.motors[joint] = (velocity, effort)
        self._driven[body] = None
        pybullet.setJointMotorControl2(
            *body.joints[joint],
            pybullet.VELOCITY_CONTROL,
            targetVelocity=velocity,
            force=effort,
            physicsClientId=self._client,
        )

    def _motors(self) -> Iterator[Motor]:
        """Yield all motors: velocity and its target, effort and its limit."""
        for body in self._driven:
            for joint, (target, limit) in body.motors.items():
                if limit > 0.0:
                    _, velocity, _, effort = self.joint_reading(body, joint)
                    yield velocity, target, effort, limit

    def _set_iterations(self, count: int) -> None:
        pybullet.setPhysicsEngineParameter(
            numSolverIterations=count, physicsClientId=self._client
        )

    def _link_state(self, part: Part, velocity: bool) -> tuple:
        return pybullet.getLinkState(
            part.body,
            part.index,
            computeLinkVelocity=velocity,
            computeForwardKinematics=1,
            physicsClientId=self._client,
        )

    def _lift_weightless(self) -> None:
        """Hold up the links that feel no gravity; PyBullet knows only one gravity for all."""
        gx, gy, gz = self._gravity
        for body in self._weightless:
            for number, index, mass in body.weightless:
                force = (-mass * gx, -mass * gy, -mass * gz)
                state = (
                    pybullet.getBasePositionAndOrientation(number, self._client)
                    if index < 0
                    else pybullet.getLinkState(number, index, 0, 1, self._client)
                )
                pybullet.applyExternalForce(
                    number, index, force, state[0], pybullet.WORLD_FRAME, self._client
                )


def _at_most(vector: Vector, most: float) -> Vector:
    """Return a vector none of whose components is greater than `most`, to either side."""
    x, y, z = (max(min(component, most), -most) for component in vector)  # NaN stays
    return (x, y, z)


def _divisible(step_size: float, most: int) -> list[int]:
    """Return for each number of steps, up to `most`, as many of them as PyBullet makes in one call.

    It divides the duration of all by their number, and makes as many of that size as fit. So both
    quotients must be exact, as they are of powers of two.
    """
    found = [0, 1]
    for steps in range(2, most + 1):
        duration = steps * step_size
        exact = duration / steps == step_size and duration / step_size == steps
        found.append(steps if exact else found[-1])
    return found
