"""The physics engine: specs and names in, plain values out.

PyBullet's defaults (damping, motors on every joint, a cap on joint speed) are switched off, so that
bodies move as rigid-body mechanics has it.
"""

from functools import partial
from itertools import repeat
from typing import Any, cast

from ...core import Pose, Vector
from ...description import ModelSpec, PhysicsSettings
from ...meshes import EngineFiles
from ..engine import Contact, PhysicsEngine, Points, RayHits
from .body import Body
from .body_maker import BodyMaker
from .body_states import BodyStates
from .client import pybullet
from .compiler import BulletModel, compile_model
from .contact_stiffness import overlap_share
from .contacts import Surroundings
from .friction_axes import can_slip
from .friction_slip import Slipping
from .snapshot import BulletSnapshot, Snapshots
from .solver_iterations import CHECK, SolverEffort
from .springs import Springs
from .tuning import Tuning

_TOGETHER = 20  # steps in one call, which costs less than a call each
# Squared velocity [m^2/s^2] by which no contact or motor changes in the solver's last iteration.
# PyBullet's own 1e-7 leaves a robot that is parked on a slope 0.01 mm/s.
_CONVERGED = 1e-8
# What bodies that are gone were read from [bytes], some 45 of the article's robots. PyBullet keeps
# two or three times that. To build the engine anew takes 5 ms for each robot that stays.
MAX_LEAKED = 1_500_000


class Engine(BodyStates):
    """One PyBullet world in this process, without window and without chatter."""

    def __init__(self, physics: PhysicsSettings, tuning: Tuning | None = None) -> None:
        """Open an empty world.

        Args:
            tuning: other choices than the usual ones, to measure what they do.
        """
        self._meshes = EngineFiles()
        self._tuning = tuning or Tuning()
        super().__init__(pybullet.connect(pybullet.DIRECT))
        self._maker = BodyMaker(self._client, self._tuning)
        self._step = pybullet.stepSimulation
        self._effort = SolverEffort(self._set_iterations)
        self._until_look = CHECK  # steps
        self._bodies: dict[Body, None] = {}  # in the order they came
        self._springs = Springs(self._client)
        self._weightless: list[Body] = []  # those with links that feel no gravity
        self._slipping = Slipping(self._client, self._maker.scale_friction, self._reach)
        self._surroundings = Surroundings(self._client, self.link_pose,
                                          partial(self._meshes.engine_file, exact=False))
        self._snapshots = Snapshots(self._client)
        # Bytes that were read to make bodies that are gone; PyBullet keeps what it made of them.
        self._leaked = 0
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
        while steps > 0 and self._enabled:
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
        one_by_one = is_sprung or self._springs.has_dampers or self._weightless
        if not (fast or one_by_one or self._slipping.links):
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

    def enable(self, enabled: bool) -> None:
        """Let bodies move in steps from now on, or not; see `PhysicsEngine`."""
        self._enabled = enabled

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

    def contacts(self, body: Body, link: str | None = None) -> list[Contact]:
        """Return the contacts of a model, or of one link, in the last step."""
        return self._surroundings.contacts(body, link)

    def cast_rays(self, starts: Points, ends: Points, named: bool = False) -> RayHits:
        """Return what rays meet first."""
        return self._surroundings.cast_rays(starts, ends, named)

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

    def _note(self) -> tuple[Any, ...]:
        """Return all state that is not PyBullet's, or that PyBullet does not restore."""
        for body in self._bodies:
            for joint in body.joints:
                self._joint_reading(body, joint)  # its effort is of the last step
        return (
            self._physics, self._until_look, self._effort.note(), self._fast.note(),
            self._slipping.note(), list(self._pushes), dict(self._joint_readings),
            [(body, dict(body.motors)) for body in self._driven],
        )

    def _recall(self, notes: tuple[Any, ...]) -> None:
        """Go on as at the time of a note, PyBullet's part being restored."""
        physics, until_look, effort, fast, slipping, pushes, readings, motors = notes
        if physics != self._physics:
            self.apply(physics)
        self._driven = dict.fromkeys(body for body, _ in motors)
        for body, targets in motors:
            for joint, target in targets.items():
                self.set_joint_motor(body, joint, *target)
        self._pushes.clear()
        for call, arguments in pushes:
            call(*arguments)
        self._joint_readings = dict(readings)
        self._until_look = until_look
        self._effort.recall(effort)
        self._fast.recall(fast)
        self._slipping.recall(slipping)

    def _set_iterations(self, count: int) -> None:
        pybullet.setPhysicsEngineParameter(
            numSolverIterations=count, physicsClientId=self._client
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


def make_engine(physics: PhysicsSettings) -> PhysicsEngine:
    """Return an empty world."""
    return cast(PhysicsEngine, Engine(physics))  # it takes only what it has made itself
