"""Models and lights of the page's own."""

from ...sim.core import Pose, Vector
from ...sim.description import (
    Box,
    Collision,
    Cylinder,
    Geometry,
    Inertial,
    LightSpec,
    LinkSpec,
    Material,
    ModelSpec,
    Sphere,
    Visual,
)

KINDS = ('box', 'sphere', 'cylinder')
LIGHT_HEIGHT = 2.0  # [m] above the ground


def shape(kind: str, size: Vector, mass: float, rgb: Vector, static: bool) -> ModelSpec:
    """Return a solid body of uniform density.

    Args:
        kind: one of `KINDS`, and the name.
        size: along x, y and z [m]; x is the diameter of what is round, z the length of a cylinder.
        mass: [kg]
        rgb: colour, each part in 0..1.
    """
    x, y, z = size
    geometry: Geometry
    if kind == 'box':
        geometry = Box(size)
        moments = (y * y + z * z) / 12.0, (x * x + z * z) / 12.0, (x * x + y * y) / 12.0
    elif kind == 'sphere':
        geometry = Sphere(x / 2.0)
        moments = (x * x / 10.0,) * 3
    else:
        geometry = Cylinder(x / 2.0, z)
        across = x * x / 16.0 + z * z / 12.0
        moments = across, across, x * x / 8.0
    ixx, iyy, izz = (mass * moment for moment in moments)
    look = Material.plain((*rgb, 1.0))
    link = LinkSpec(
        'link',
        inertial=Inertial(mass, ixx=ixx, iyy=iyy, izz=izz),
        collisions=(Collision('collision', geometry),),
        visuals=(Visual('visual', geometry, material=look),),
    )
    return ModelSpec(kind, (link,), static=static)


def point_light(place: Vector, rgb: Vector) -> LightSpec:
    """Return a point light of a colour above a place on the ground [m]."""
    x, y, z = place
    return LightSpec(
        'light',
        pose=Pose((x, y, z + LIGHT_HEIGHT)),
        diffuse=(*rgb, 1.0),
        range=20.0,
        attenuation_constant=0.5,
        attenuation_linear=0.0,
        attenuation_quadratic=0.1,
    )
