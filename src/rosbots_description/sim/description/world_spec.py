"""A world as plain values: what a world file says, complete and checked, in SI units."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from ..core import IDENTITY, Pose, Twist, Vector
from .element import Element, PluginSpec
from .model_spec import Colour, ModelSpec
from .physics_settings import PhysicsSettings

POINT, DIRECTIONAL, SPOT = 'point', 'directional', 'spot'


@dataclass(frozen=True)
class LightSpec:
    """A light; defaults are those of SDF. Colours are red, green, blue, alpha in 0..1."""

    name: str
    type: str = POINT
    pose: Pose = IDENTITY
    diffuse: Colour = (1.0, 1.0, 1.0, 1.0)
    specular: Colour = (0.1, 0.1, 0.1, 1.0)
    range: float = 10.0  # [m]
    attenuation_constant: float = 1.0
    attenuation_linear: float = 1.0  # [1/m]
    attenuation_quadratic: float = 0.0  # [1/m^2]
    direction: Vector = (0.0, 0.0, -1.0)
    cast_shadows: bool = False
    spot_inner_angle: float = 0.0  # [rad]
    spot_outer_angle: float = 0.0  # [rad]
    spot_falloff: float = 0.0


@dataclass(frozen=True)
class SceneSpec:
    """Ambient light, background colour and shadows.

    `user_camera`: where a window begins to look from, x forward, in the world; None: it chooses.
    """

    ambient: Colour = (0.4, 0.4, 0.4, 1.0)
    background: Colour = (0.7, 0.7, 0.7, 1.0)
    shadows: bool = True
    user_camera: Pose | None = None


@dataclass(frozen=True)
class ModelState:
    """Poses of a model and its links in a saved world, in the world frame.

    In a world that this simulator saved there are also the `twists` of links, in the world frame;
    position [rad or m] and velocity [rad/s or m/s] of `joints`; target velocity [rad/s or m/s] and
    greatest effort [N m or N] of their `motors`; and `axes`, the poses of the principal axes of
    root links in the world. All are by name.
    """

    name: str
    pose: Pose | None = None
    links: Mapping[str, Pose] = field(default_factory=dict)
    twists: Mapping[str, Twist] = field(default_factory=dict)
    joints: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    motors: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    axes: Mapping[str, Pose] = field(default_factory=dict)


@dataclass(frozen=True)
class WorldSpec:
    """A whole world. Models are in the order of the file, each with the pose it resets to.

    `states` and `time` [s] are those of a saved world's <state>. `parts` are elements that nothing
    here acts on, as they were written; of <scene> what is not in `scene`. `faults` are sentences:
    which models and other parts were left out, and why.
    """

    name: str = 'default'
    models: tuple[tuple[ModelSpec, Pose], ...] = ()
    physics: PhysicsSettings = field(default_factory=PhysicsSettings)
    lights: tuple[LightSpec, ...] = ()
    scene: SceneSpec = SceneSpec()
    plugins: tuple[PluginSpec, ...] = ()
    states: tuple[ModelState, ...] = ()
    time: float = 0.0
    parts: tuple[Element, ...] = ()
    faults: tuple[str, ...] = ()
