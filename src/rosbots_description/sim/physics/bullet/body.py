"""The engine's record of a model, as plain values."""

from dataclasses import dataclass
from typing import NamedTuple

from ...core import Pose, Quaternion, Vector
from ...description import Collision
from .integral_action import Integral


@dataclass(frozen=True)
class Part:
    """PyBullet's indices of a link, and the transform from its centre of mass to its frame.

    Index -1 is the base of the body. A static tree may consist of several coincident bodies.
    """

    body: int
    index: int
    origin_in_com: Pose
    com_in_origin: Pose
    also: tuple[int, ...] = ()  # the other coincident bodies


class Place(NamedTuple):
    """Address of a link in PyBullet: body id and link index, -1 for the base."""

    body: int
    link: int


class Mass(NamedTuple):
    """A link with mass: PyBullet's link index, mass [kg], principal moments [kg m^2]."""

    link: int
    mass: float
    moments: Vector
    has_weight: bool

    def scaled(self, factor: float) -> 'Mass':
        """Return this with mass and moments multiplied by a factor."""
        x, y, z = self.moments
        return self._replace(mass=factor * self.mass, moments=(factor * x, factor * y, factor * z))


class Masses(NamedTuple):
    """Inertial and joint parameters of a moving body."""

    parts: tuple[Mass, ...]
    joints: tuple[int, ...]  # all of them
    # One value per joint: damping [N m s/rad or N s/m], spring stiffness [N m/rad or N/m], spring
    # reference [rad or m], and acceleration per unit of effort (springs.py).
    damping: tuple[float, ...]
    stiffness: tuple[float, ...]
    reference: tuple[float, ...]
    compliance: tuple[float, ...]
    unbalanced: tuple[int, ...]  # joints whose motion moves a centre of mass
    is_fixed: bool

    def scaled(self, factor: float) -> 'Masses':
        """Return these with all masses and moments multiplied by a factor."""
        return self._replace(
            parts=tuple(part.scaled(factor) for part in self.parts),
            compliance=tuple(one / factor for one in self.compliance),
        )


class FrictionAxes(NamedTuple):
    """Anisotropic friction of a part, as PyBullet takes it.

    `turn` rotates the part's axes into the link's axes. `scales` are friction scales, 0 to 1, along
    the x, y and z axes of the part.
    """

    turn: Quaternion
    scales: tuple[float, float, float]


class Body:
    """A model in the engine. Links and joints are addressed by their names."""

    def __init__(self, size: int) -> None:
        self.size = size  # [bytes] of the URDF and meshes it was loaded from
        self.parts: dict[str, Part] = {}
        self.joints: dict[str, tuple[int, int]] = {}  # PyBullet's body and index
        # Axis in the child link's frame, and whether the joint is rotational.
        self.joint_axes: dict[str, tuple[Vector, bool]] = {}
        self.indices: dict[int, list[int]] = {}  # of all joints, by body
        self.rows: dict[str, tuple[int, int]] = {}  # of each joint: body, and row in its indices
        self.roots: list[str] = []  # links that the engine moves as bases
        self.fixed_roots: set[str] = set()  # roots that are fixed to the world
        self.bodies: list[int] = []
        # Links that feel no gravity: PyBullet's body and index, and the mass [kg].
        self.weightless: list[tuple[int, int, float]] = []
        self.motors: dict[str, tuple[float, float]] = {}  # target velocity, effort limit by joint
        self.integrals: dict[str, Integral] = {}  # of motors, by joint
        self.masses: dict[int, Masses] = {}  # of moving bodies, as described
        self.mass_scale = 1.0
        self.frictions: dict[Place, float] = {}  # of each contact part, as described
        self.friction_scales: dict[str, float] = {}  # by link, where they are not 1
        self.surfaces: dict[str, list[Place]] = {}  # contact parts of each link
        self.shapes: dict[Place, tuple[Collision, ...]] = {}  # in the frame of the link
        self.friction_axes: dict[Place, FrictionAxes] = {}  # of each contact part
