"""Values exchanged with the rendering process; colours are red, green, blue in 0..1."""

import math
from typing import NamedTuple

Colour = tuple[float, float, float]

RGB, BGR, RGB16, GREY8, GREY16 = 'rgb8', 'bgr8', 'rgb16', 'mono8', 'mono16'
# The channel kept in each pixel of a 2 by 2 block, row by row.
BAYER = {
    'bayer_rggb8': (0, 1, 1, 2),
    'bayer_bggr8': (2, 1, 1, 0),
    'bayer_gbrg8': (1, 2, 0, 1),
    'bayer_grbg8': (1, 0, 2, 1),
}
BYTES = {RGB: 3, BGR: 3, RGB16: 6, GREY8: 1, GREY16: 2, **dict.fromkeys(BAYER, 1)}  # of a pixel

DIRECTIONAL, POINT, SPOT = range(3)


class Appearance(NamedTuple):
    """Material of a surface, as in fixed-function OpenGL."""

    ambient: Colour = (1.0, 1.0, 1.0)
    diffuse: Colour = (1.0, 1.0, 1.0)
    specular: Colour = (0.0, 0.0, 0.0)
    shininess: float = 0.0
    emissive: Colour = (0.0, 0.0, 0.0)
    alpha: float = 1.0
    lit: bool = True  # False: the diffuse colour without lighting
    both_sides: bool = False
    texture: str = ''  # key of an image, which multiplies all but the specular light


class ScenePart(NamedTuple):
    """A surface that moves with a body."""

    mesh: str  # key of its triangles
    body: int  # row of the poses that come with each request
    matrix: bytes  # (4, 4) float64, row-major: from the mesh to the body, scale included
    appearance: Appearance
    casts_shadow: bool = True
    still: bool = False  # it seldom moves


class Light(NamedTuple):
    """A light in the world [m]. `spot`: cosines of the inner and outer half cone angle, falloff."""

    type: int
    position: tuple[float, float, float]
    direction: tuple[float, float, float]  # unit vector
    diffuse: Colour
    specular: Colour
    range: float
    attenuation: tuple[float, float, float]  # constant, linear [1/m], quadratic [1/m^2]
    spot: tuple[float, float, float]
    casts_shadow: bool


class Scene(NamedTuple):
    """Everything that is drawn, without poses."""

    parts: tuple[ScenePart, ...]
    lights: tuple[Light, ...] = ()
    ambient: Colour = (0.4, 0.4, 0.4)
    background: Colour = (0.7, 0.7, 0.7)
    shadows: bool = True
    soft: bool = False  # whether the edges of shadows are blurred


class Wants(NamedTuple):
    """What is requested of a picture."""

    pixels: bool = True
    depths: bool = False
    jpeg: bool = False  # the pixels as a JPEG file


class Lens(NamedTuple):
    """A camera that looks along x, with y to the left and z up.

    The picture's centre is on the optical axis. Distortion is Brown's model (k1, k2, k3, p1, p2)
    about `centre`, relative to the picture's size. `crop` enlarges the picture to remove empty
    borders.
    """

    width: int  # [pixels]
    height: int
    field_of_view: float  # horizontal [rad]
    near: float  # [m] along the optical axis
    far: float
    encoding: str = RGB
    distortion: tuple[float, float, float, float, float] = (0.0, 0.0, 0.0, 0.0, 0.0)
    centre: tuple[float, float] = (0.5, 0.5)
    crop: bool = True
    noise_mean: float = 0.0  # relative to white, 1.0
    noise_stddev: float = 0.0

    @property
    def focal_length(self) -> float:
        """Return the focal length in pixels."""
        return self.width / (2.0 * math.tan(self.field_of_view / 2.0))

    @property
    def colour_bytes(self) -> int:
        """Return the size of a picture."""
        return self.width * self.height * BYTES[self.encoding]

    @property
    def depth_bytes(self) -> int:
        """Return the size of a depth image of float32."""
        return self.width * self.height * 4

    @property
    def jpeg_bytes(self) -> int:
        """Return the room for a JPEG file: white noise takes half of it, a header some 600."""
        return self.width * self.height * 3 + 4096
