"""The physics engine: specs and names in, plain values out.

PyBullet's habits end here: its poses are those of the centre of mass, ours those of the link
frame; its quaternions are (x, y, z, w) like ours; its defaults (damping, motors on every joint, a
cap on joint speed) are switched off, so that bodies move as rigid-body mechanics has it.
"""

import math
from collections.abc import Iterator, Mapping, Sequence
from functools import partial
from itertools import repeat

from numpy.typing import ArrayLike

from ...core import LARGEST, Pose, Twist, Vector, add, compose, cross, rotate, subtract
from ...description import ModelSpec, PhysicsSettings
from ...meshes import MeshStore
from ..engine import Contact, EngineFactory, JointState, Motion, RayHits, Wrench
from .body import Body, Part
from .body_maker import ANY_SPEED, BodyMaker
from .client import pybullet
from .compiler import BulletModel, compile_model
from .contact_slip import Slipping
from .contacts import Surroundings
from .fast_rotation import FastBodies
from .friction_axes import can_slip
from .snapshot import BulletSnapshot, Snapshots
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
# What bodies that are gone were read from [bytes], some 45 of the article's robots. PyBullet keeps
# two or three times that. To build the engine anew takes 5 ms for each robot that stays.
MAX_LEAKED = 1_500_000


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
        self._bodies: dict[Body, None] = {}  # in the order they came
        self._pushes: list[tuple] = []  # since the last step, with what to call for each
        self._driven: dict[Body, None] = {}  # those with motors, in the order they came
        self._fast = FastBodies(self._client)
        self._springs = Springs(self._client)
        self._weightless: list[Body] = []  # those with links that feel no gravity
        self._slipping = Slipping(self._client, self._maker.scale_friction, self._reach)
        self._surroundings = Surroundings(self._client, self.link_pose,
                                          partial(self._meshes.engine_file, exact=False))
        self._snapshots = Snapshots(self._client)
        # Bytes that were read to make bodies that are gone; PyBullet keeps what it made of them.
        self._leaked = 0
        # What has been read since the last step, by PyBullet's body, in the order of Body.indices:
        # reading one joint costs as much as reading all of a body's.
        self._joint_readings: dict[int, Sequence[tuple]] = {}
        self.apply(physics)

    def close(self) -> None:
        """Free the world and remove its mesh files; the engine cannot be used afterwards."""
        self._snapshots.clear()
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
            jointFeedbackMode=pybullet.JOINT_FEEDBACK_IN_JOINT_FRAME,
            physicsClientId=self._client,
        )
        self._effort.start(max(1, round(physics.sor_pgs_iters * self._tuning.iterations)))
        self._physics = physics
        self._together = _divisible(physics.step_size, _TOGETHER)

    def _reach(self, direction: Vector) -> float:
        """Return how many times its limit friction can hold in a level direction, a unit vector."""
        return 1.0 if self._cone else max(1.0, abs(direction[0]) + abs(direction[1]))

    @property
    def needs_rebuild(self) -> bool:
        """Whether removed bodies have left much behind."""
        return self._leaked > MAX_LEAKED

    def reset(self) -> None:
        """Remove everything; the same bodies added again then move bit for bit as before."""
        self._snapshots.clear()
        self._maker.reset()
        pybullet.setPhysicsEngineParameter(
            deterministicOverlappingPairs=0, physicsClientId=self._client)
        self._bodies.clear()
        self._pushes.clear()
        self._surroundings.clear()
        self._fast.clear()
        self._springs.clear()
        self._weightless.clear()
        self._driven.clear()
        self._until_look = CHECK
        self._slipping.clear()
        self._joint_readings.clear()
        self._leaked = 0
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
        if self._pushes and steps > 1:  # a push lasts as long as a call of PyBullet
            self._step_alike(1)
            steps -= 1
        self._pushes.clear()
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
                self._let_slip(body, link, *slip)
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
        self._surroundings.add(body)
        self._bodies[body] = None
        return body

    def remove(self, body: Body) -> None:
        """Take a model out of the world."""
        self._joint_readings.clear()
        if body in self._weightless:
            self._weightless.remove(body)
        self._slipping.remove(body)
        self._surroundings.remove(body)
        self._bodies.pop(body, None)
        self._driven.pop(body, None)
        self._fast.forget(body.bodies)
        self._springs.forget(body.bodies)
        self._leaked += body.size
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
            {name: state[:2] for name, state in self.joint_states(body).items()},
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
        # Also a static one: what hits it with endless speed leaves it with a velocity of NaN.
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
        """Return the pose of the link's frame in the world."""
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
        return _state_of_frame(part, com, linear, angular)

    def link_states(self, body: Body) -> dict[str, tuple[Pose, Twist]]:
        """Return pose and twist of all links."""
        states = {}
        for number in {part.body: None for part in body.parts.values()}:
            mine = [(name, part) for name, part in body.parts.items() if part.body == number]
            indices = [part.index for _, part in mine if part.index >= 0]
            rows = iter(pybullet.getLinkStates(number, indices, 1, 1, self._client)
                        if indices else ())
            for name, part in mine:
                if part.index < 0:
                    states[name] = self.link_state(body, name)
                    continue
                row = next(rows)
                states[name] = _state_of_frame(part, Pose(*row[:2]), row[6], row[7])
        return states

    def set_root_poses(self, body: Body, poses: Mapping[str, Pose]) -> None:
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

        A root that is fixed to the world stays at rest.
        """
        if link in body.fixed_roots:
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
        self._pushes.append((self.push, body, link, force, torque, place))
        self._fast.disturb(part.body)

    def push_joint(self, body: Body, joint: str, effort: float) -> None:
        """Push a joint during the next step by `effort` [N m or N], beside its motor."""
        effort = max(min(effort, _ANY_FORCE), -_ANY_FORCE)
        pybullet.setJointMotorControl2(
            *body.joints[joint], pybullet.TORQUE_CONTROL, force=effort, physicsClientId=self._client
        )
        self._pushes.append((self.push_joint, body, joint, effort))
        self._fast.disturb(body.joints[joint][0])

    def joint_state(self, body: Body, joint: str) -> JointState:
        """Return the state of a joint."""
        position, velocity, _, effort = self._joint_reading(body, joint)
        # Of a motor without effort PyBullet tells what it gave when it had some.
        return JointState(position, velocity, effort if body.motors[joint][1] else 0.0)

    def joint_states(self, body: Body) -> dict[str, JointState]:
        """Return the states of all joints."""
        return {name: self.joint_state(body, name) for name in body.joints}

    def _joint_reading(self, body: Body, joint: str) -> tuple:
        """Return PyBullet's state of a joint; all joints of a body are read in one call."""
        number, index = body.joints[joint]
        readings, indices = self._joint_readings.get(number), body.indices[number]
        if readings is None:
            readings = pybullet.getJointStates(number, indices, self._client)
            self._joint_readings[number] = readings
        return readings[indices.index(index)]

    def can_slip(self, body: Body, link: str, axis: Vector) -> bool:
        """Tell whether a link can slip along a unit vector of its frame."""
        return can_slip(body, link, axis)

    def set_slip_compliance(
        self, body: Body, link: str, axis: Vector, compliances: tuple[float, float]
    ) -> None:
        """Let a link slip so from now on; see `PhysicsEngine`."""
        self._slipping.set(body, link, (axis, compliances))

    def _let_slip(self, body: Body, link: str, axle: Vector, slips: tuple[float, float]) -> None:
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

    def motor(self, body: Body, joint: str) -> tuple[float, float]:
        """Return the motor's target velocity and greatest effort."""
        return body.motors[joint]

    def contacts(self, body: Body, link: str | None = None) -> list[Contact]:
        """Return the contacts of a model, or of one link, in the last step."""
        return self._surroundings.contacts(body, link)

    def cast_rays(self, starts: ArrayLike, ends: ArrayLike, named: bool = False) -> RayHits:
        """Return what rays meet first."""
        return self._surroundings.cast_rays(starts, ends, named)

    def measure_reaction(self, body: Body, joint: str, wanted: bool = True) -> None:
        """Begin or end to measure what a joint passes on."""
        self._joint_readings.clear()
        pybullet.enableJointForceTorqueSensor(*body.joints[joint], int(wanted), self._client)

    def joint_reaction(self, body: Body, joint: str) -> Wrench:
        """Return what the parent did to the child through a joint in the last step."""
        # PyBullet tells it in the principal axes of the child, without what the motor does.
        values = self._joint_reading(body, joint)[2]
        turn = next(part.com_in_origin.orientation for part in body.parts.values()
                    if (part.body, part.index) == body.joints[joint])
        force, torque = rotate(turn, values[:3]), rotate(turn, values[3:])
        if not any(values):
            return Wrench(force, torque)
        axis, turns = body.joint_axes[joint]
        effort = self.joint_state(body, joint).effort
        driven = tuple(effort * component for component in axis)
        return Wrench(force, add(torque, driven)) if turns else Wrench(add(force, driven), torque)

    def snapshot(self) -> BulletSnapshot:
        """Return the state of everything, between two steps."""
        idle = [body.joints[joint] for body in self._driven
                for joint, (_, effort) in body.motors.items() if not effort]
        snapshot = self._snapshots.take([*self._bodies], self._moving(), idle, self._note)
        self._recall(snapshot.notes)
        return snapshot

    def restore(self, snapshot: BulletSnapshot) -> None:
        """Go back to a snapshot.

        Raises:
            SimError: models were added, removed or respecified since.
        """
        self._recall(self._snapshots.put_back(snapshot, [*self._bodies], self._moving()))

    def _moving(self) -> list[int]:
        """Return PyBullet's numbers of what it moves."""
        return [number for body in self._bodies for number in body.masses]

    def _note(self) -> tuple:
        """Return all state that is not PyBullet's, or that PyBullet does not restore."""
        for body in self._bodies:
            for joint in body.joints:
                self._joint_reading(body, joint)  # its effort is of the last step
        return (
            self._physics, self._until_look, self._effort.note(), self._fast.note(),
            self._slipping.note(), list(self._pushes), dict(self._joint_readings),
            [(body, dict(body.motors)) for body in self._driven],
        )

    def _recall(self, notes: tuple) -> None:
        """Go on as at the time of a note, PyBullet's part being restored."""
        physics, until_look, effort, fast, slipping, pushes, readings, motors = notes
        if physics != self._physics:
            self.apply(physics)
        self._driven = dict.fromkeys(body for body, _ in motors)
        for body, targets in motors:
            for joint, target in targets.items():
                self.set_joint_motor(body, joint, *target)
        self._pushes.clear()
        for call, *arguments in pushes:
            call(*arguments)
        self._joint_readings = dict(readings)
        self._until_look = until_look
        self._effort.recall(effort)
        self._fast.recall(fast)
        self._slipping.recall(slipping)

    def _motors(self) -> Iterator[Motor]:
        """Yield all motors: velocity and its target, effort and its limit."""
        for body in self._driven:
            for joint, (target, limit) in body.motors.items():
                if limit > 0.0:
                    _, velocity, _, effort = self._joint_reading(body, joint)
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


def _state_of_frame(part: Part, com: Pose, linear: Vector, angular: Vector) -> tuple[Pose, Twist]:
    """Return pose and twist of a link's frame, by those of its centre of mass."""
    pose = compose(com, part.origin_in_com)
    arm = subtract(pose.position, com.position)
    return pose, Twist(add(linear, cross(angular, arm)), angular)


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


make_engine: EngineFactory = Engine
