"""The physics engine: specs and names in, plain values out.

PyBullet's defaults (damping, a motor on each joint, a limit on joint speed) are switched off, so
that bodies follow rigid-body mechanics.
"""

from functools import partial
from itertools import repeat
from typing import Any, cast

from ...core import Pose, Vector
from ...description import ModelSpec, PhysicsSettings
from ...meshes import EngineFiles
from ..engine import Contact, PhysicsEngine, Wrench
from .body import Body
from .body_maker import BodyMaker
from .body_states import BodyStates
from .client import pybullet
from .compiler import BulletModel, compile_model
from .contact_stiffness import overlap_share
from .contacts import ContactQueries
from .friction_axes import can_slip
from .friction_slip import SlippingLinks
from .integral_action import PERIOD
from .snapshot import BulletSnapshot, Snapshots
from .springs import Springs
from .stop_reaction import is_at_stop, links_beyond, with_stop
from .tuning import Tuning

_MAX_BATCH = 20  # steps in one call, which is faster than a call for each, but for a few steps
_MIN_BATCH = 7
_TOUCHES = 1e-6  # [m] depth up to which models touch but do not overlap
# URDF and meshes of removed bodies [bytes], some 45 robots of the article. PyBullet leaks two or
# three times as much. A rebuild of the engine takes 5 ms for each robot in the world.
MAX_LEAKED = 1_500_000


class Engine(BodyStates):
    """One PyBullet world in this process, without a window or output."""

    def __init__(self, physics: PhysicsSettings, tuning: Tuning | None = None) -> None:
        """Open an empty world.

        Args:
            tuning: settings other than the defaults, for measurements.
        """
        self._meshes = EngineFiles()
        self._tuning = tuning or Tuning()
        super().__init__(pybullet.connect(pybullet.DIRECT))
        self._maker = BodyMaker(self._client, self._tuning)
        self._step = pybullet.stepSimulation
        self._until_look = PERIOD  # steps
        self._bodies: dict[Body, None] = {}  # in the order they were added
        self._springs = Springs(self._client)
        self._weightless: list[Body] = []  # bodies with links without gravity
        self._slipping = SlippingLinks(
            self._client, self._maker.scale_friction, self._friction_ratio
        )
        self._queries = ContactQueries(
            self._client, self.link_pose, partial(self._meshes.engine_file, exact=False)
        )
        self._snapshots = Snapshots(self._client)
        # Bytes that removed bodies were loaded from; PyBullet does not free all of its memory.
        self._leaked = 0
        self.apply(physics)

    def close(self) -> None:
        """Free the world and remove its mesh files; the engine cannot be used afterwards."""
        self._snapshots.clear()
        pybullet.disconnect(self._client)
        self._meshes.close()

    def apply(self, physics: PhysicsSettings) -> None:
        """Apply these settings from the next step on."""
        self._sleep.wake_all()
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
            collisionFilterMode=0,  # a pair collides if both masks allow it
            enableFileCaching=0,  # file names are reused with other contents
            minimumSolverIslandSize=1,  # islands converge independently
            numSolverIterations=max(1, round(physics.sor_pgs_iters * self._tuning.iterations)),
            solverResidualThreshold=self._tuning.residual,
            jointFeedbackMode=pybullet.JOINT_FEEDBACK_IN_JOINT_FRAME,
            physicsClientId=self._client,
        )
        self._physics = physics
        self._sleep.set_rest(self._tuning.rest / physics.step_size)
        self._batches = _exact_batches(physics.step_size, _MAX_BATCH)

    def _friction_ratio(self, direction: Vector) -> float:
        """Return the ratio of friction to mu N possible along a horizontal unit vector."""
        return 1.0 if self._cone else max(1.0, abs(direction[0]) + abs(direction[1]))

    @property
    def needs_rebuild(self) -> bool:
        """Whether removed bodies have leaked more than MAX_LEAKED."""
        return self._leaked > MAX_LEAKED

    def reset(self) -> None:
        """Remove everything; the same bodies added again move bit-identically."""
        self._snapshots.clear()
        self._maker.reset()
        pybullet.setPhysicsEngineParameter(
            deterministicOverlappingPairs=0, physicsClientId=self._client
        )
        self._bodies.clear()
        self._applied_forces.clear()
        self._sleep.clear()
        self._queries.clear()
        self._fast.clear()
        self._springs.clear()
        self._weightless.clear()
        self._driven.clear()
        self._until_look = PERIOD
        self._slipping.clear()
        self._joint_readings.clear()
        self._leaked = 0
        self.apply(self._physics)

    def step(self, steps: int) -> None:
        """Advance physics by whole steps; while everything sleeps, nothing changes in them."""
        fast, sleep = self._fast, self._sleep
        while steps > 0 and self._enabled and not sleep.is_complete:
            if not fast.until_check:
                fast.update()
            run = min(steps, self._until_look, fast.until_check, sleep.until_look)
            self._step_uniform(run)
            self.advances += 1
            self._joint_readings.clear()
            steps -= run
            fast.until_check -= run
            self._until_look -= run
            if not self._until_look:
                self._until_look = PERIOD
                self._correct_motors()
            sleep.until_look -= run
            if not sleep.until_look:
                sleep.look(
                    self._bodies,
                    {body for body, _, (_, slips) in self._slipping.links if any(slips)},
                )

    def _step_uniform(self, steps: int) -> None:
        """Advance by steps between two checks for fast bodies."""
        step, client, fast = self._step, self._client, self._fast
        is_sprung = bool(self._springs)
        if self._applied_forces and steps > 1:  # a push lasts for one call of PyBullet
            self._step_uniform(1)
            steps -= 1
        self._applied_forces.clear()
        one_by_one = is_sprung or self._springs.damped or self._weightless
        if not (fast or one_by_one or self._slipping.links):
            while steps >= _MIN_BATCH:
                batch = self._batches[min(steps, _MAX_BATCH)]
                self._step_batch(batch)
                steps -= batch
        for _ in repeat(None, steps):
            if self._weightless:
                self._cancel_weight()
            if is_sprung:
                self._springs.apply()
            for body, link, slip in self._slipping.links:
                self._update_slip(body, link, *slip)
            step(client)
            if fast:
                fast.after_step()

    def _step_batch(self, steps: int) -> None:
        """Advance by several steps in one call; motors are set at the size of a single step."""
        size, client = self._physics.step_size, self._client
        resize = pybullet.setPhysicsEngineParameter
        resize(fixedTimeStep=steps * size, numSubSteps=steps, physicsClientId=client)
        self._step(client)
        resize(fixedTimeStep=size, numSubSteps=0, physicsClientId=client)

    def enable(self, enabled: bool) -> None:
        """Enable or disable physics; see `PhysicsEngine`."""
        self._enabled = enabled

    def compile(self, spec: ModelSpec) -> BulletModel:
        """Compile a model, so that it can be added; may be called from any thread.

        Raises:
            ModelError: the engine cannot simulate it; the message says why.
        """
        return compile_model(spec, self._meshes)

    def add(self, model: BulletModel, pose: Pose) -> Body:
        """Add a model to the world with its frame at `pose` and all joints at zero."""
        self._sleep.wake_all()
        body, spec = Body(model.size), model.spec
        try:
            for tree in model.trees:
                self._maker.add_tree(body, tree, pose)
            self._maker.exclude_collisions_within(body, spec)
        except BaseException:
            self.remove(body)  # leave no partial model behind
            raise
        for joint in spec.joints:
            if joint.name in body.joints:
                self.set_joint_motor(body, joint.name, 0.0, joint.friction)
        if body.weightless:
            self._weightless.append(body)
        self._sleep.add(body.masses)
        self._fast.add(body.masses)
        self._springs.add(body.masses)
        self._slipping.add(body, spec)
        self._queries.add(body)
        self._bodies[body] = None
        self.placements += 1
        return body

    def remove(self, body: Body) -> None:
        """Remove a model from the world."""
        self.placements += 1
        self._sleep.wake_all()
        self._joint_readings.clear()
        if body in self._weightless:
            self._weightless.remove(body)
        self._slipping.remove(body)
        self._queries.remove(body)
        self._bodies.pop(body, None)
        self._driven.pop(body, None)
        self._sleep.remove(body.bodies)
        self._fast.remove(body.bodies)
        self._springs.remove(body.bodies)
        self._leaked += body.size
        self._maker.remove(body)

    def scale_mass(self, body: Body, factor: float) -> None:
        """Multiply the described masses and moments of inertia of a model by a factor."""
        if factor == body.mass_scale:
            return
        self._sleep.wake_all()
        body.mass_scale = factor
        scaled = {number: masses.scaled(factor) for number, masses in body.masses.items()}
        self._maker.set_masses(scaled)
        self._fast.add(scaled)
        self._fast.until_check = 0
        self._springs.add(scaled)

    def scale_friction(self, body: Body, link: str, factor: float) -> None:
        """Multiply the friction of each contact of a link by a factor."""
        if factor != body.friction_scales.get(link, 1.0):
            self._sleep.wake_all()
            self._maker.scale_link_friction(body, link, factor)

    def overlap(self, one: Body, other: Body) -> float:
        """Return the penetration depth of two models [m]; 0 if they do not overlap."""
        depth = max(
            (
                -point[8]
                for first in one.bodies
                for second in other.bodies
                for point in pybullet.getClosestPoints(
                    first, second, 0.0, physicsClientId=self._client
                )
            ),
            default=0.0,
        )
        return depth if depth > _TOUCHES else 0.0

    def can_slip(self, body: Body, link: str, axis: Vector) -> bool:
        """Tell whether a link can slip along a unit vector of its frame."""
        return can_slip(body, link, axis)

    def set_slip_compliance(
        self, body: Body, link: str, axis: Vector, compliances: tuple[float, float]
    ) -> None:
        """Set the slip compliance of a link; see `PhysicsEngine`."""
        self._sleep.wake_all()
        self._slipping.set(body, link, (axis, compliances))

    def _update_slip(self, body: Body, link: str, axle: Vector, slips: tuple[float, float]) -> None:
        state = self.link_state(body, link)
        self._slipping.update_friction(body, link, state, axle, slips, self._physics.step_size)

    def contacts(self, body: Body | None = None, link: str | None = None) -> list[Contact]:
        """Return all contacts, those of a model, or of one link, in the last step."""
        return self._queries.contacts(body, link)

    def extent(self, body: Body) -> float:
        """Return the longest side of a model's bounding box, along the world's axes [m]."""
        return self._queries.extent(body)

    def touching(self, body: Body) -> set[Body]:
        """Return the models that touched a model in the last step; not itself."""
        return self._queries.touching(body)

    def joint_reaction(self, body: Body, joint: str) -> Wrench:
        """Return the wrench of the parent on the child through a joint in the last step."""
        measured, (number, index) = super().joint_reaction(body, joint), body.joints[joint]
        axis, turns = body.joint_axes[joint]
        if not (turns and is_at_stop(self._client, number, index)):
            return measured
        beyond = links_beyond(self._client, number, index)
        names = {part.index: name for name, part in body.parts.items() if part.body == number}
        touches = [
            contact
            for link in beyond
            if link in names
            for contact in self.contacts(body, names[link])
        ]
        frame = self.link_pose(body, names[index])
        return with_stop(self._client, number, beyond, frame, axis, measured, touches)

    def snapshot(self) -> BulletSnapshot:
        """Return a snapshot of the whole state, between two steps."""
        idle = [
            body.joints[joint]
            for body in self._driven
            for joint, (_, effort) in body.motors.items()
            if not effort
        ]
        snapshot = self._snapshots.take([*self._bodies], idle, self._save_state)
        self._restore_state(snapshot.engine_state)
        return snapshot

    def restore(self, snapshot: BulletSnapshot) -> None:
        """Restore a snapshot.

        Raises:
            SimError: models were added, removed or changed since it was taken.
        """
        self._snapshots.require(snapshot, [*self._bodies])
        # First: what PyBullet restores is computed with these.
        for body, (mass, friction) in snapshot.engine_state[-1]:
            self.scale_mass(body, mass)
            for link in {**body.friction_scales, **friction}:
                self.scale_friction(body, link, friction.get(link, 1.0))
        self._restore_state(self._snapshots.restore(snapshot))

    def _save_state(self) -> tuple[Any, ...]:
        """Return all state that PyBullet does not hold or does not restore."""
        for body in self._bodies:
            for joint in body.joints:
                self._joint_reading(body, joint)  # PyBullet does not restore efforts
        return (
            self._physics,
            self._until_look,
            self._fast.save_state(),
            self._sleep.save_state(),
            self._slipping.save_state(),
            list(self._applied_forces),
            dict(self._joint_readings),
            [(body, dict(body.motors), dict(body.integrals)) for body in self._driven],
            [(body, (body.mass_scale, dict(body.friction_scales))) for body in self._bodies],
        )

    def _restore_state(self, saved: tuple[Any, ...]) -> None:
        """Restore noted state after PyBullet's own has been restored."""
        self.placements += 1
        physics, until_check, fast, sleep, slipping, applied, readings, motors, _ = saved
        if physics != self._physics:
            self.apply(physics)
        self._driven = dict.fromkeys(body for body, *_ in motors)
        for body, targets, integrals in motors:
            body.integrals = dict(integrals)
            for joint, target in targets.items():
                body.motors[joint] = target
                self._apply_motor(body, joint)
        self._applied_forces.clear()
        for call, arguments in applied:
            call(*arguments)
        self._joint_readings = dict(readings)
        self._until_look = until_check
        self._fast.restore_state(fast)
        self._slipping.restore_state(slipping)
        self._sleep.restore_state(sleep)

    def _cancel_weight(self) -> None:
        """Cancel the weight of links without gravity; PyBullet has one gravity for all links."""
        gx, gy, gz = self._gravity
        for body in self._weightless:
            for number, index, described in body.weightless:
                mass = body.mass_scale * described
                force = (-mass * gx, -mass * gy, -mass * gz)
                state = (
                    pybullet.getBasePositionAndOrientation(number, self._client)
                    if index < 0
                    else pybullet.getLinkState(number, index, 0, 1, self._client)
                )
                pybullet.applyExternalForce(
                    number, index, force, state[0], pybullet.WORLD_FRAME, self._client
                )


def _exact_batches(step_size: float, most: int) -> list[int]:
    """Return, for each number of steps up to `most`, how many PyBullet can make in one call.

    PyBullet computes size = duration / steps, then makes duration / size steps. Both quotients must
    be exact in floating point, as they are for powers of two.
    """
    found = [0, 1]
    for steps in range(2, most + 1):
        duration = steps * step_size
        exact = duration / steps == step_size and duration / step_size == steps
        found.append(steps if exact else found[-1])
    return found


def make_engine(physics: PhysicsSettings) -> PhysicsEngine:
    """Return an empty world."""
    return cast(PhysicsEngine, Engine(physics))  # it accepts only its own Body and BulletModel
