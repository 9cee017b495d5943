"""The worlds that come with the simulator."""

from .pose import IDENTITY
from .spec import Collision, LinkSpec, Material, ModelSpec, Plane, Surface, Visual
from .world import World

GROUND_PLANE = ModelSpec(
    name='ground_plane',
    static=True,
    links=(
        LinkSpec(
            name='link',
            collisions=(Collision('collision', Plane(), surface=Surface(mu=100.0, mu2=50.0)),),
            visuals=(
                Visual('visual', Plane(), material=Material((0.5, 0.5, 0.5, 1.0), 'Gazebo/Grey')),
            ),
        ),
    ),
)


def add_empty_world(world: World) -> None:
    """Put in what Gazebo's empty world has: an endless ground at z = 0."""
    world.spawn(GROUND_PLANE, GROUND_PLANE.name, IDENTITY)
