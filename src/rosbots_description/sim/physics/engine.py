"""What a physics engine does for a world, its plugins and its sensors: the protocol, and values.

Units are SI. Poses and vectors are in the world's frame unless it says otherwise. Links, joints and
collisions go by the names that the `ModelSpec` gives them.
"""

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple, Protocol

from ..core import Pose, Twist, Vector
from ..core.arrays import FloatArray
from ..description import ModelSpec, PhysicsSettings
from .compiled_model import CompiledModel

Points = FloatArray | Sequence[Vector]  # (n, 3) [m]


class JointState(NamedTuple):
    """Position [rad or m], velocity [rad/s or m/s], and the motor's last effort [N m or N]."""

    position: float
    velocity: float
    effort: float


@dataclass(frozen=True)
class Motion:
    """Where a model is and how it moves.

    Attributes:
        roots: pose and twist of each root link.
        joints: position and velocity of each joint.
        motors: target velocity and greatest effort of each joint's motor.
    """

    roots: Mapping[str, tuple[Pose, Twist]]
    joints: Mapping[str, tuple[float, float]]
    motors: Mapping[str, tuple[float, float]]


class EngineBody(Protocol):
    """A model in an engine. To the rest of the simulator it is these names, and a handle."""

    @property
    def roots(self) -> Sequence[str]:
        """Links that no joint of the model carries."""

    @property
    def fixed_roots(self) -> Collection[str]:
        """Those of them that are fixed to the world."""

    @property
    def joints(self) -> Collection[str]:
        """Joints that can move."""


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
        depth: of the overlap [m]; negative where the engine holds them a hair apart.
        force: on `one`, friction included [N]; `other` feels the opposite.
    """

    one: CollisionName
    other: CollisionName
    position: Vector
    normal: Vector
    depth: float
    force: Vector


class RayHits(NamedTuple):
    """What rays met first.

    Attributes:
        distances: (n,) from the start of each ray [m]; inf where it met nothing.
        collisions: what each ray met, None for nothing; empty unless asked for.
    """

    distances: FloatArray
    collisions: Sequence[CollisionName | None]


class Wrench(NamedTuple):
    """A force [N] and a torque [N m]."""

    force: Vector
    torque: Vector


class Snapshot(Protocol):
    """All of an engine's state at one moment; only the engine that took it understands it."""


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
        """Whether so much of removed bodies is left behind that a `reset` would pay."""

    def step(self, steps: int) -> None:
        """Advance physics by whole steps."""

    def enable(self, enabled: bool) -> None:
        """Let bodies move in steps from now on, or not; pushes are lost while they do not."""

    def compile(self, spec: ModelSpec) -> CompiledModel:
        """Make a model ready to be added; any thread may ask.

        Raises:
            ModelError: the engine cannot take it; the sentence says why.
        """

    def add(self, model: CompiledModel, pose: Pose) -> EngineBody:
        """Put a model that this engine compiled into the world, all joints at zero.

        Args:
            pose: of its frame.
        """

    def remove(self, body: EngineBody) -> None:
        """Take a model out of the world."""

    def overlap(self, one: EngineBody, other: EngineBody) -> float:
        """Return how deep two models reach into each other [m]; 0 if they do not."""

    def has_diverged(self, body: EngineBody) -> bool:
        """Tell whether a model moves by numbers that are not finite, or too large for any world."""

    def motion(self, body: EngineBody) -> Motion:
        """Return where a model is and how it moves, all of it."""

    def set_motion(self, body: EngineBody, motion: Motion) -> None:
        """Let a model be where another one of the same links and joints was, moving as it did."""

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
        """Put root links at poses; what they carry comes along, velocities stay."""

    def set_root_twist(self, body: EngineBody, link: str, twist: Twist) -> None:
        """Let a root link move with this twist of its origin; joints go on, fixed roots stay."""

    def set_twist(self, body: EngineBody, twist: Twist) -> None:
        """Let all roots move with this twist of their origins, joints at rest."""

    def set_joint_position(
        self, body: EngineBody, joint: str, position: float, velocity: float = 0.0
    ) -> None:
        """Put a joint at `position` [rad or m], moving at `velocity` [rad/s or m/s]."""

    def motor(self, body: EngineBody, joint: str) -> tuple[float, float]:
        """Return the motor's target velocity [rad/s or m/s] and greatest effort [N m or N]."""

    def set_joint_motor(
        self, body: EngineBody, joint: str, velocity: float, effort: float
    ) -> None:
        """Drive a joint towards `velocity` [rad/s or m/s] with at most `effort` [N m or N]."""

    def push(
        self, body: EngineBody, link: str, force: Vector, torque: Vector,
        place: Vector | None = None,
    ) -> None:
        """Apply a force [N] and a torque [N m] to a link during the next step, beside others.

        Args:
            place: where the force acts [m], None for the centre of mass.
        """

    def push_joint(self, body: EngineBody, joint: str, effort: float) -> None:
        """Apply an effort [N m or N] to a joint during the next step, beside its motor."""

    def can_slip(self, body: EngineBody, link: str, axis: Vector) -> bool:
        """Tell whether a link can have a slip compliance along a unit vector of its frame."""

    def set_slip_compliance(
        self, body: EngineBody, link: str, axis: Vector, compliances: tuple[float, float]
    ) -> None:
        """Let what a link touches slide at v = compliance * friction force, from now on.

        Args:
            axis: unit vector in the link's frame, one that `can_slip`.
            compliances: along the axis, and across it [m/s per N].
        """

    def contacts(self, body: EngineBody, link: str | None = None) -> list[Contact]:
        """Return the contacts of a model, or of one link, in the last step; it is `one` in each.

        A contact within the model is there once, by its first link.
        """

    def cast_rays(
        self, starts: Points, ends: Points, named: bool = False
    ) -> RayHits:
        """Return what straight rays meet first; they see all collisions, the caster's too.

        Args:
            starts, ends: (n, 3) [m].
            named: whether to tell the collisions, too, which takes time.
        """

    def measure_reaction(self, body: EngineBody, joint: str, wanted: bool = True) -> None:
        """Begin or end to measure what a joint passes on, from the next step on."""

    def joint_reaction(self, body: EngineBody, joint: str) -> Wrench:
        """Return what the parent did to the child through a joint in the last step.

        The motor's effort is in it, pushes, springs and dampers of the joint are not. The torque is
        about the origin of the joint's frame; both are in the axes of the child link. Zero unless
        `measure_reaction` asked for it before that step.
        """

    def snapshot(self) -> Snapshot:
        """Return the state of everything, between two steps.

        From here on the world moves bit for bit as it does after each `restore` of it. To that end
        the state becomes what can be restored, which may differ in contacts and the last bits.
        """

    def restore(self, snapshot: Snapshot) -> None:
        """Go back to a snapshot.

        Raises:
            SimError: models were added, removed or respecified since.
        """


EngineFactory = Callable[[PhysicsSettings], PhysicsEngine]
