"""What ros_control reads from a URDF: transmissions, joints with their limits, and mimic joints."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

from ..core import ZERO, Vector

CONTINUOUS = 'continuous'  # a URDF's revolute joint without position limits


@dataclass(frozen=True)
class Transmission:
    """A <transmission>: its type, and the hardware interfaces of each of its joints, as written."""

    name: str
    type: str
    joints: Mapping[str, tuple[str, ...]]


@dataclass(frozen=True)
class CommandTopic:
    """A topic of commands to a controller: one number, or a value for each of some joints.

    `are_positions` tells that these values are positions [rad or m].
    """

    name: str
    joints: tuple[str, ...] = ()
    are_positions: bool = False


@dataclass(frozen=True)
class SoftLimits:
    """A <safety_controller>: soft position limits [rad or m], and the gains that keep to them.

    `k_position` is [1/s], `k_velocity` [N m s/rad or N s/m].
    """

    lower: float
    upper: float
    k_position: float
    k_velocity: float


@dataclass(frozen=True)
class Mimic:
    """A <mimic>: position = multiplier * position of `joint` + offset [rad or m]."""

    joint: str
    multiplier: float = 1.0
    offset: float = 0.0


@dataclass(frozen=True)
class ControlledJoint:
    """A joint as ros_control sees it.

    Attributes:
        type: as written, e.g. 'continuous'.
        lower, upper: position limits [rad or m]; infinite for a continuous joint, and all limits
            without a <limit>.
        velocity: velocity limit [rad/s or m/s].
        effort: effort limit [N m or N].
        origin: of the joint in its parent link [m].
    """

    type: str
    lower: float = -math.inf
    upper: float = math.inf
    velocity: float = math.inf
    effort: float = math.inf
    soft: SoftLimits | None = None
    mimic: Mimic | None = None
    origin: Vector = ZERO


@dataclass(frozen=True)
class RobotControl:
    """The part of a robot's description that controllers need.

    `faults` holds upstream's errors about transmissions that were skipped.
    """

    transmissions: tuple[Transmission, ...] = ()
    joints: Mapping[str, ControlledJoint] = field(default_factory=dict)
    faults: tuple[str, ...] = ()
