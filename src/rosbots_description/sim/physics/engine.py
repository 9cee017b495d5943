"""The protocol of a physics engine, for the world, its plugins and its sensors; and its values.

Units are SI. Poses and vectors are in the world's frame unless it says otherwise. Links, joints and
collisions go by the names that the `ModelSpec` gives them.
"""

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple, Protocol

from ..core import Pose, Twist, Vector
from ..description import ModelSpec, PhysicsSettings
from .compiled_model import CompiledModel


class JointState(NamedTuple):
    """Position [rad or m], velocity [rad/s or m/s], and the motor's last effort [N m or N]."""

    position: float
    velocity: float
    effort: float


@dataclass(frozen=True)
class Motion:
    """Pose and velocity of a whole model.

    Attributes:
        roots: pose and twist of each root link.
        joints: position and velocity of each joint.
        motors: target velocity and greatest effort of each joint's motor.
    """

    roots: Mapping[str, tuple[Pose, Twist]]
    joints: Mapping[str, tuple[float, float]]
    motors: Mapping[str, tuple[float, float]]


class EngineBody(Protocol):
    """A model in an engine: a handle, and the names of its parts."""

    @property
    def roots(self) -> Sequence[str]:
        """Links that are not the child of any joint."""

    @property
    def fixed_roots(self) -> Collection[str]:
        """Root links that are fixed to the world."""

    @property
    def joints(self) -> Collection[str]:
        """Joints that can move."""

    @property
    def mass_scale(self) -> float:
        """Factor on the described masses and moments of inertia."""

    @property
    def friction_scales(self) -> Mapping[str, float]:
        """Factors on the friction of links, where they are not 1."""


class CollisionName(NamedTuple):
    """A <collision> of a model in an engine."""

    body: EngineBody
    link: str
    collision: str


class Contact(NamedTuple):
    """A point where two collisions touched in the last step.

    Attributes:
        position: on the surface of `one` [m].
        normal: unit vector from `other` to `one`.
        depth: penetration [m]; negative if the engine keeps a small gap.
        force: on `one`, including friction [N]; the opposite acts on `other`.
    """

    one: CollisionName
    other: CollisionName
    position: Vector
    normal: Vector
    depth: float
    force: Vector


class Wrench(NamedTuple):
    """A force [N] and a torque [N m]."""

    force: Vector
    torque: Vector


class Snapshot(Protocol):
    """The complete state of an engine at one time; opaque to all but that engine."""


class PhysicsEngine(Protocol):
    """One world of bodies. Only the thread that made it may call it, except for `compile`."""

    def close(self) -> None:
        """Free the world; the engine cannot be used afterwards."""

    def apply(self, physics: PhysicsSettings) -> None:
        """Use these settings from the next step on."""

    def reset(self) -> None:
        """Remove everything; the same bodies added again then move bit for bit as before."""

    @property
    def needs_rebuild(self) -> bool:
        """Whether removed bodies have leaked so much memory that a `reset` pays off."""

    @property
    def placements(self) -> int:
        """How often something was added, removed, placed or restored; else only `step` moves."""

    @property
    def advances(self) -> int:
        """How often `step` may have moved bodies; scans read no poses until it has changed."""

    def step(self, steps: int) -> None:
        """Advance physics by whole steps; what rests may sleep until something acts on it."""

    def enable(self, enabled: bool) -> None:
        """Enable or disable the motion of bodies; forces are lost while it is disabled."""

    def compile(self, spec: ModelSpec) -> CompiledModel:
        """Make a model ready to be added; any thread may ask.

        Raises:
            ModelError: the engine cannot simulate it; the message says why.
        """

    def add(self, model: CompiledModel, pose: Pose) -> EngineBody:
        """Add a model that this engine compiled to the world, all joints at zero.

        Args:
            pose: of its frame.
        """

    def remove(self, body: EngineBody) -> None:
        """Remove a model from the world."""

    def overlap(self, one: EngineBody, other: EngineBody) -> float:
        """Return the penetration depth of two models [m]; 0 if they do not overlap."""

    def has_diverged(self, body: EngineBody) -> bool:
        """Tell whether a pose or velocity of a model is not finite, or beyond all limits."""

    def motion(self, body: EngineBody) -> Motion:
        """Return pose and velocity of a whole model."""

    def set_motion(self, body: EngineBody, motion: Motion) -> None:
        """Give a model the motion of another one with the same links and joints."""

    def link_pose(self, body: EngineBody, link: str) -> Pose:
        """Return the pose of a link's frame."""

    def link_state(self, body: EngineBody, link: str) -> tuple[Pose, Twist]:
        """Return the pose of a link's frame and the twist of its origin."""

    def link_states(self, body: EngineBody) -> Mapping[str, tuple[Pose, Twist]]:
        """Return pose and twist of all links, as `link_state`, in one read."""

    def joint_state(self, body: EngineBody, joint: str) -> JointState:
        """Return the state of a joint."""

    def joint_states(self, body: EngineBody) -> Mapping[str, JointState]:
        """Return the states of all joints, in one read."""

    def set_root_poses(self, body: EngineBody, poses: Mapping[str, Pose]) -> None:
        """Set the poses of root links; their descendants move along, velocities stay."""

    def settle_poses(self, body: EngineBody) -> Mapping[str, Pose]:
        """Move a model by rounding errors to poses that `match_poses` restores to the last bit.

        World files need both.

        Returns:
            the poses of the principal axes of inertia of root links, which it needs to that end.
        """

    def match_poses(
        self, body: EngineBody, axes: Mapping[str, Pose], links: Mapping[str, Pose]
    ) -> None:
        """Move roots by rounding errors, so that they and the links are exactly where they were.

        Roots and joints must have been set; velocities stay. Nothing is moved any further than
        that, if the links are elsewhere now.

        Args:
            axes: what `settle_poses` returned.
            links: the poses of the links since then.
        """

    def set_root_twist(self, body: EngineBody, link: str, twist: Twist) -> None:
        """Set the twist of a root link's origin; joint velocities and fixed roots stay."""

    def set_twist(self, body: EngineBody, twist: Twist) -> None:
        """Set the twist of all roots' origins; joint velocities become zero."""

    def set_joint_position(
        self, body: EngineBody, joint: str, position: float, velocity: float = 0.0
    ) -> None:
        """Set a joint's `position` [rad or m] and `velocity` [rad/s or m/s]."""

    def motor(self, body: EngineBody, joint: str) -> tuple[float, float]:
        """Return the motor's target velocity [rad/s or m/s] and greatest effort [N m or N]."""

    def set_joint_motor(self, body: EngineBody, joint: str, velocity: float, effort: float) -> None:
        """Drive a joint towards `velocity` [rad/s or m/s] with at most `effort` [N m or N]."""

    def apply_wrench(
        self,
        body: EngineBody,
        link: str,
        force: Vector,
        torque: Vector,
        place: Vector | None = None,
    ) -> None:
        """Apply a force [N] and a torque [N m] to a link during the next step, added to others.

        Args:
            place: point at which the force acts [m], None for the centre of mass.
        """

    def apply_joint_effort(self, body: EngineBody, joint: str, effort: float) -> None:
        """Apply an effort [N m or N] to a joint during the next step, added to its motor's."""

    def scale_mass(self, body: EngineBody, factor: float) -> None:
        """Multiply the described masses and moments of inertia of a model by a factor."""

    def scale_friction(self, body: EngineBody, link: str, factor: float) -> None:
        """Multiply the friction of each contact of a link by a factor."""

    def can_slip(self, body: EngineBody, link: str, axis: Vector) -> bool:
        """Tell whether a link can have a slip compliance along a unit vector of its frame.

        The wheel slip plugin asks it, to leave out a wheel with an error.
        """

    def set_slip_compliance(
        self, body: EngineBody, link: str, axis: Vector, compliances: tuple[float, float]
    ) -> None:
        """Set the slip compliance of a link: v = compliance * friction force, from now on.

        Args:
            axis: unit vector in the link's frame for which `can_slip` holds.
            compliances: along the axis, and across it [m/s per N].
        """

    def contacts(self, body: EngineBody | None = None, link: str | None = None) -> list[Contact]:
        """Return the contacts in the last step; of a model, or of one link, as `one` of each.

        Each contact is listed once, one within the model with its first link as `one`.
        """

    def extent(self, body: EngineBody) -> float:
        """Return the longest side of a model's bounding box, along the world's axes [m].

        It is that of all collision shapes; infinite with a plane, 0 without shapes.
        """

    def touching(self, body: EngineBody) -> Collection[EngineBody]:
        """Return the models that touched a model in the last step; not itself."""

    def measure_reaction(self, body: EngineBody, joint: str, wanted: bool = True) -> None:
        """Start or stop measuring a joint's reaction wrench, from the next step on."""

    def joint_reaction(self, body: EngineBody, joint: str) -> Wrench:
        """Return the wrench of the parent on the child through a joint in the last step.

        About its axis it is what acts in the joint: motor, applied effort, spring, damper and stop.
        The torque is about the origin of the joint's frame; both are in the axes of the child link.
        Zero unless `measure_reaction` was called before that step.
        """

    def snapshot(self) -> Snapshot:
        """Return the state of everything, between two steps.

        From here on the world moves bit for bit as after each `restore` of it. To that end the
        state is set to what can be restored, which may differ in contacts and the last bits.
        """

    def restore(self, snapshot: Snapshot) -> None:
        """Go back to a snapshot.

        Raises:
            SimError: models were added, removed or respecified since.
        """


EngineFactory = Callable[[PhysicsSettings], PhysicsEngine]
