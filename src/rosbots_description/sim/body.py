"""What the engine remembers of a model, and how a model moves, as plain values."""

from dataclasses import dataclass
from typing import NamedTuple

from .pose import Pose, Quaternion, Twist, Vector


@dataclass(frozen=True)
class Part:
    """Where a link lives in PyBullet, and the way from its centre of mass to its frame.

    An index of -1 is the base of the body.
    """

    body: int
    index: int
    origin_in_com: Pose
    com_in_origin: Pose


class Touching(NamedTuple):
    """A part of a link that touches: PyBullet's body and index, and which way its axes stand.

    `axes` turn the part's own axes into those of the link; `rigid` tells that nobody described how
    it gives way.
    """

    body: int
    index: int
    axes: Quaternion
    rigid: bool


class Contact(NamedTuple):
    """Where something was pressed in the last step [m], and what it was held with there [N].

    Both are given in the world; the friction may be that on either side.
    """

    place: Vector
    friction: Vector


class Hold(NamedTuple):
    """Which shares of its friction a surface holds: along an axle, and in the other directions."""

    sideways: float = 1.0
    ahead: float = 1.0

    def rounded(self) -> 'Hold':
        """Return it in hundredths: friction does not change with each bit that a robot turns by."""
        return Hold(*(round(share, 2) for share in self))


HOLDS_ALL = Hold()


class Body:
    """A model in the engine. Links and joints are addressed by their names."""

    def __init__(self) -> None:
        self.parts: dict[str, Part] = {}
        self.joints: dict[str, tuple[int, int]] = {}  # PyBullet's body and index
        self.indices: dict[int, list[int]] = {}  # those of all joints, by body
        self.roots: list[str] = []  # links that the engine moves as bases
        self.bolted: set[str] = set()  # roots that the world holds
        self.bodies: list[int] = []
        # Links that feel no gravity: PyBullet's body and index, and the mass [kg].
        self.weightless: list[tuple[int, int, float]] = []
        self.size = 0  # bytes that were read to make it
        self.motors: dict[str, tuple[float, float]] = {}  # last velocity and effort of each joint
        self.surfaces: dict[str, list[Touching]] = {}  # what each link touches with
        self.holds: dict[str, Hold] = {}  # last shares of each link's friction
        self.rolling: set[str] = set()  # links that roll without resistance
        self.sinking: set[str] = set()  # links that give way by a hair


@dataclass(frozen=True)
class Motion:
    """Where a model is and how it moves: roots, joints, and what its motors are asked for."""

    roots: dict[str, tuple[Pose, Twist]]
    joints: dict[str, tuple[float, float]]
    motors: dict[str, tuple[float, float]]
