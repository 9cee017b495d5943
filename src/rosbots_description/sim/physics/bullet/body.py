"""The engine's record of a model, as plain values."""

from dataclasses import dataclass
from typing import NamedTuple

from ...core import Pose, Quaternion, Vector
from ...description import Collision


@dataclass(frozen=True)
class Part:
    """PyBullet's indices of a link, and the transform from its centre of mass to its frame.

    Index -1 is the base of the body. A static tree may be several coincident bodies.
    """

    body: int
    index: int
    origin_in_com: Pose
    com_in_origin: Pose
    also: tuple[int, ...] = ()  # the other bodies


class Place(NamedTuple):
    """A part of a body: PyBullet's body id and link index, -1 for the base."""

    body: int
    link: int


class Mass(NamedTuple):
    """A part of a body with a mass: PyBullet's link, mass [kg], principal moments [kg m^2]."""

    link: int
    mass: float
    moments: Vector
    has_weight: bool


class Masses(NamedTuple):
    """A moving body: its parts with mass, and the joints that move them."""

    parts: tuple[Mass, ...]
    joints: tuple[int, ...]  # all of them
    # Of each joint: damping [N m s/rad or N s/m], stiffness of its spring [N m/rad or N/m], where
    # that pulls to [rad or m], and how much a unit of effort accelerates it (springs.py).
    damping: tuple[float, ...]
    stiffness: tuple[float, ...]
    reference: tuple[float, ...]
    compliance: tuple[float, ...]
    unbalanced: tuple[int, ...]
    is_fixed: bool


class FrictionAxes(NamedTuple):
    """Which way the axes stand along which PyBullet can weaken a part's friction, and by how much.

    `turn` turns the part's own axes into those of the link; each of `scales` is a share of the
    friction, along one axis of the part.
    """

    turn: Quaternion
    scales: tuple[float, float, float]


class Body:
    """A model in the engine. Links and joints are addressed by their names."""

    def __init__(self, size: int) -> None:
        self.size = size  # bytes that were read to make it
        self.parts: dict[str, Part] = {}
        self.joints: dict[str, tuple[int, int]] = {}  # PyBullet's body and index
        # Axis in the frame of the child link, and whether the joint turns about it.
        self.joint_axes: dict[str, tuple[Vector, bool]] = {}
        self.indices: dict[int, list[int]] = {}  # those of all joints, by body
        self.rows: dict[str, tuple[int, int]] = {}  # of joints: body, and place in its indices
        self.roots: list[str] = []  # links that the engine moves as bases
        self.fixed_roots: set[str] = set()  # roots that are fixed to the world
        self.bodies: list[int] = []
        # Links that feel no gravity: PyBullet's body and index, and the mass [kg].
        self.weightless: list[tuple[int, int, float]] = []
        self.motors: dict[str, tuple[float, float]] = {}  # last velocity and effort of each joint
        self.masses: dict[int, Masses] = {}  # what moves, by body
        self.surfaces: dict[str, list[Place]] = {}  # what each link touches with
        self.shapes: dict[Place, tuple[Collision, ...]] = {}  # in the frame of the link
        self.friction_axes: dict[Place, FrictionAxes] = {}  # of each of these
