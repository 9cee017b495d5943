"""What a window on a world has to show, as plain values."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from ..core import IDENTITY, Pose, Vector
from .model_spec import Collision, Inertial, JointSpec, Visual
from .world_spec import LightSpec, SceneSpec


@dataclass(frozen=True)
class ShownSensor:
    """A sensor; `pose` is in its link's frame."""

    name: str
    type: str
    pose: Pose = IDENTITY


@dataclass(frozen=True)
class ShownLink:
    """A link with its pose in the world; no other link ever has its number."""

    number: int
    name: str
    pose: Pose
    visuals: tuple[Visual, ...] = ()
    collisions: tuple[Collision, ...] = ()
    inertial: Inertial | None = None
    gravity: bool = True
    sensors: tuple[ShownSensor, ...] = ()


@dataclass(frozen=True)
class ShownModel:
    """A model with all its links, the canonical one first, and its movable joints.

    `canonical_pose` is that link's in the model's frame, which moves with it.
    """

    name: str
    links: tuple[ShownLink, ...]
    joints: tuple[JointSpec, ...] = ()
    static: bool = False
    canonical_pose: Pose = IDENTITY


@dataclass(frozen=True)
class SceneChange:
    """What has changed in a world; after a `reset`, all that there is.

    `lights` and `scene` are always complete. `step_size` [s], `max_update_rate` [Hz], 0 for no
    limit.
    """

    reset: bool = False
    models: tuple[ShownModel, ...] = ()  # added, or with other links than before
    removed: tuple[str, ...] = ()
    lights: Mapping[str, LightSpec] = field(default_factory=dict)
    scene: SceneSpec = field(default_factory=SceneSpec)
    step_size: float = 0.001
    max_update_rate: float = 1000.0
    name: str = ''  # of the world; '' if unknown


@dataclass(frozen=True)
class ShownContact:
    """A point where two bodies touch [m], the normal, and the force on one of them [N]."""

    position: Vector
    normal: Vector
    force: Vector


@dataclass(frozen=True)
class ShownMotion:
    """The clock of a world, and where the links are that moved.

    `time` is simulated, `real_time` that of the simulator's wall clock [s]. `poses` are in the
    world, by the numbers of links.
    """

    time: float
    real_time: float
    iterations: int
    paused: bool
    poses: Mapping[int, Pose] = field(default_factory=dict)

    def after(self, earlier: 'ShownMotion') -> 'ShownMotion':
        """Return this motion with those of an earlier one that has not been shown."""
        return replace(self, poses={**earlier.poses, **self.poses})
