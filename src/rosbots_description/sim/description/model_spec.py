"""A model as plain values: what every parser produces and the engine simulates.

A `ModelSpec` is complete (defaults filled in), reduced (fixed joints merged as Gazebo does),
validated (finite numbers, one tree per root, known files) and in SI units. Nothing here knows
URDF, SDF, PyBullet or ROS.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field

from ..core import IDENTITY, Pose, Vector, rotate
from .element import Element, PluginSpec
from .robot_control import RobotControl
from .sensor_spec import SensorSpec

Colour = tuple[float, float, float, float]  # red, green, blue, alpha in 0..1


@dataclass(frozen=True)
class Box:
    """A cuboid centred on its origin; `size` is its full extent along x, y, z [m]."""

    size: Vector


@dataclass(frozen=True)
class Sphere:
    """A sphere centred on its origin; radius [m]."""

    radius: float


@dataclass(frozen=True)
class Cylinder:
    """A cylinder about z, centred on its origin; radius and full length [m]."""

    radius: float
    length: float


@dataclass(frozen=True)
class Plane:
    """An infinite plane through its origin; unit vector `normal`; `size` [m] is visual only."""

    normal: Vector = (0.0, 0.0, 1.0)
    size: tuple[float, float] = (100.0, 100.0)


@dataclass(frozen=True)
class Mesh:
    """A triangle mesh read from `path` (an absolute file path) and scaled along its axes.

    `uri` is the address in the description, for messages, markers and saved worlds. `submesh` names
    the part of that file which `path` holds, '' for all; `is_centred`: it was moved to the origin.
    """

    path: str
    scale: Vector = (1.0, 1.0, 1.0)
    uri: str = ''
    submesh: str = ''
    is_centred: bool = False


Geometry = Box | Sphere | Cylinder | Plane | Mesh


@dataclass(frozen=True)
class Surface:
    """Contact properties of a collision; defaults are those of SDF (sdformat 9)."""

    mu: float = 1.0  # friction coefficient along the first direction
    mu2: float = 1.0  # along the second direction
    fdir1: Vector = (0.0, 0.0, 0.0)  # first friction direction; zeros: the engine's choice
    kp: float = 1e12  # contact stiffness [N/m]
    kd: float = 1.0  # contact damping [N s/m]
    max_vel: float = 0.01  # largest speed that corrects a penetration [m/s]
    min_depth: float = 0.0  # penetration that is left uncorrected [m]
    max_contacts: int = 10
    laser_retro: float = 0.0
    restitution: float = 0.0  # coefficient of restitution
    threshold: float = 1e5  # impact speed from which restitution applies [m/s]
    slip1: float = 0.0  # slip compliance along the first direction [m/s per N]
    slip2: float = 0.0  # along the second direction
    collide_bitmask: int = 0xFFFF  # of the categories that it collides with
    category_bitmask: int = 0xFFFF  # of its own categories

    def meets(self, other: 'Surface') -> bool:
        """Tell whether two collisions collide by their bitmasks, by SDF's rule."""
        return bool(
            self.category_bitmask & other.collide_bitmask
            | other.category_bitmask & self.collide_bitmask
        )

    @property
    def greatest_mu(self) -> float:
        """Return the friction coefficient along the direction in which it is greatest."""
        return max(self.mu, self.mu2)


@dataclass(frozen=True)
class Collision:
    """A collision shape, posed in its link's frame."""

    name: str
    geometry: Geometry
    pose: Pose = IDENTITY
    surface: Surface = Surface()


@dataclass(frozen=True)
class Reflection:
    """How a surface answers to light; defaults are those of Gazebo's renderer: white.

    Colours are red, green, blue in 0..1. What is not `lit` shows its diffuse colour whatever the
    light; of what has `both_sides` the inside is seen, too.
    """

    ambient: Vector = (1.0, 1.0, 1.0)
    diffuse: Vector = (1.0, 1.0, 1.0)
    specular: Vector = (0.0, 0.0, 0.0)
    shininess: float = 0.0
    emissive: Vector = (0.0, 0.0, 0.0)
    lit: bool = True
    both_sides: bool = False


@dataclass(frozen=True)
class Material:
    """How a visual looks.

    Cameras see the reflection and the alpha of `rgba` (red, green, blue, alpha in 0..1); windows
    that know no reflection show `rgba`. `script` is Gazebo's name for it, and `script_file` the
    path of the file that defines it, '' for those of Gazebo itself. `image` is the path of a
    texture, which only cameras see.
    """

    rgba: Colour = (0.7, 0.7, 0.7, 1.0)
    script: str = ''
    reflection: Reflection = Reflection()
    image: str = ''
    script_file: str = field(default='', compare=False)

    @classmethod
    def plain(cls, rgba: Colour) -> 'Material':
        """Return what has one colour in any light."""
        return cls(rgba, reflection=Reflection(rgba[:3], rgba[:3]))


@dataclass(frozen=True)
class Visual:
    """A visual shape, posed in its link's frame.

    A mesh keeps its own colours while `material` is None.
    """

    name: str
    geometry: Geometry
    pose: Pose = IDENTITY
    material: Material | None = None


@dataclass(frozen=True)
class Inertial:
    """Mass [kg], centre of mass in the link's frame, and the inertia tensor about it [kg m^2].

    The tensor's axes are those of `pose`.
    """

    mass: float
    pose: Pose = IDENTITY
    ixx: float = 0.0
    iyy: float = 0.0
    izz: float = 0.0
    ixy: float = 0.0
    ixz: float = 0.0
    iyz: float = 0.0


@dataclass(frozen=True)
class LinkSpec:
    """A rigid body; `pose` is its pose in the model frame with all joints at zero."""

    name: str
    pose: Pose = IDENTITY
    inertial: Inertial | None = None
    collisions: tuple[Collision, ...] = ()
    visuals: tuple[Visual, ...] = ()
    gravity: bool = True
    self_collide: bool = False
    kinematic: bool = False  # moved by commands only, not by forces and contacts
    linear_damping: float = 0.0
    angular_damping: float = 0.0
    sensors: tuple[SensorSpec, ...] = ()
    parts: tuple[Element, ...] = ()  # lights and projectors, which nothing here acts on

    @property
    def mass_properties(self) -> Inertial:
        """Return `inertial`; every moving link has one."""
        assert self.inertial is not None, f"link '{self.name}' has no mass"
        return self.inertial


REVOLUTE = 'revolute'  # includes continuous: a revolute joint without limits
PRISMATIC = 'prismatic'
FIXED = 'fixed'
WORLD = 'world'  # as the parent of a joint: it connects the child to the world


@dataclass(frozen=True)
class JointSpec:
    """A joint; its frame is at `pose` in the child link, `axis` is a unit vector in that frame.

    A limit is None if there is none: position [rad or m], effort [N m or N], velocity
    [rad/s or m/s]. Damping is [N m s/rad or N s/m], friction [N m or N], spring stiffness
    [N m/rad or N/m]; the spring pulls towards its reference [rad or m].
    """

    name: str
    type: str
    parent: str  # a link's name, or WORLD
    child: str
    pose: Pose = IDENTITY
    axis: Vector = (0.0, 0.0, 1.0)
    lower: float | None = None
    upper: float | None = None
    effort: float | None = None
    velocity: float | None = None
    damping: float = 0.0
    friction: float = 0.0
    stiffness: float = 0.0
    reference: float = 0.0

    @property
    def axis_in_child(self) -> Vector:
        """Return the axis in the frame of the child link."""
        return rotate(self.pose.orientation, self.axis)


@dataclass(frozen=True)
class ModelSpec:
    """A whole model, ready to be simulated.

    Links are in the order of the description after fixed joint reduction; the first is canonical.
    Joints connect them into one or more trees. Links and joints of a nested model are called
    `inner::name`.
    """

    name: str
    links: tuple[LinkSpec, ...]
    joints: tuple[JointSpec, ...] = ()
    plugins: tuple[PluginSpec, ...] = ()
    static: bool = False
    # Reduced link -> its parent after reduction, and its pose in that.
    reduced: Mapping[str, tuple[str, Pose]] = field(default_factory=dict)
    nested: Mapping[str, Pose] = field(default_factory=dict)  # nested model -> pose of its frame
    left_out: tuple[str, ...] = ()  # parts that were left out, each in a few words
    # What controllers need of a URDF; SDF has nothing of it.
    control: RobotControl | None = field(default=None, compare=False)
    # Location of its description, e.g. 'robot_description, line 1', to begin messages with.
    location: str = field(default='', compare=False)

    def link(self, name: str) -> LinkSpec | None:
        """Return the link of that name, or None."""
        return next((link for link in self.links if link.name == name), None)
