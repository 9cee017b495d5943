"""The built-in models of every world: ground_plane and sun."""

from ..core import Pose
from .materials import gazebo_material
from .model_spec import Collision, LinkSpec, ModelSpec, Plane, Surface, Visual
from .world_spec import DIRECTIONAL, LightSpec

GROUND_PLANE = ModelSpec(
    name='ground_plane',
    static=True,
    links=(
        LinkSpec(
            name='link',
            collisions=(Collision('collision', Plane(), surface=Surface(mu=100.0, mu2=50.0)),),
            visuals=(Visual('visual', Plane(), material=gazebo_material('Gazebo/Grey')),),
        ),
    ),
)

SUN = LightSpec(
    name='sun',
    type=DIRECTIONAL,
    pose=Pose((0.0, 0.0, 10.0)),
    diffuse=(0.8, 0.8, 0.8, 1.0),
    specular=(0.2, 0.2, 0.2, 1.0),
    range=1000.0,
    attenuation_constant=0.9,
    attenuation_linear=0.01,
    attenuation_quadratic=0.001,
    direction=(-0.5, 0.1, -0.9),
    cast_shadows=True,
)
