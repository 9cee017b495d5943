"""The material scripts that come with Gazebo, by name: what cameras see of them.

Ambient and diffuse colours, alpha and specular light are those that Gazebo 11 shows. Of a script
with a texture (wood, bricks, ...) it is the texture's mean colour.
"""

from ..core import Vector
from .model_spec import Colour, Material, Reflection

_WHITE, _BLACK = (1.0, 1.0, 1.0), (0.0, 0.0, 0.0)
_DIM = (0.1, 0.1, 0.1)


def _material(
    rgb: Vector,
    specular: Vector = _BLACK,
    shininess: float = 0.0,
    *,
    alpha: float = 1.0,
    ambient: Vector | None = None,
    diffuse: Vector | None = None,
    emissive: Vector = _BLACK,
    lit: bool = True,
    both_sides: bool = False,
) -> Material:
    """Return a material of the colour `rgb`, which is also what is not given of its reflection."""
    return Material(
        (*rgb, alpha),
        '',
        Reflection(
            rgb if ambient is None else ambient,
            rgb if diffuse is None else diffuse,
            specular,
            shininess,
            emissive,
            lit,
            both_sides,
        ),
    )


def _glow(rgb: Vector, reflected: Vector = _WHITE) -> Material:
    return _material(rgb, ambient=reflected, diffuse=reflected, emissive=rgb)


def scale(colour: Vector, factor: float) -> Vector:
    """Return a colour as many times as bright."""
    red, green, blue = colour
    return factor * red, factor * green, factor * blue


def _textured(mean: Vector, ambient: float, diffuse: float, *specular: float) -> Material:
    grey, shininess = specular or (0.0, 0.0)
    return _material(
        mean,
        (grey, grey, grey),
        shininess,
        ambient=scale(mean, ambient),
        diffuse=scale(mean, diffuse),
    )


_GREY = _material((0.7, 0.7, 0.7), (0.01, 0.01, 0.01), 1.5, ambient=(0.3, 0.3, 0.3))
_DARK_GREY = _material((0.175, 0.175, 0.175), (0.175, 0.175, 0.175), 1.5)
_MATERIALS: dict[str, Material] = {
    'Grey': _GREY,
    'Gray': _GREY,
    'LightGrey': _material((0.8, 0.8, 0.8)),
    'DarkGrey': _DARK_GREY,
    'DarkGray': _DARK_GREY,
    'White': _material(_WHITE, _DIM, 128.0),
    'FlatBlack': _material(_DIM, (0.01, 0.01, 0.01), 1.0),
    'Black': _material(_BLACK, _DIM, 5.0),
    'Red': _material((1.0, 0.0, 0.0), _DIM, 1.0),
    'RedBright': _material((0.87, 0.26, 0.07), (0.87, 0.26, 0.07), 1.0),
    'Green': _material((0.0, 1.0, 0.0), _DIM, 1.0),
    'Blue': _material((0.0, 0.0, 1.0), _DIM, 1.0),
    'SkyBlue': _material((0.13, 0.44, 0.7), _DIM, 1.0, diffuse=(0.0, 0.0, 1.0)),
    'Yellow': _material((1.0, 1.0, 0.0)),
    'ZincYellow': _material((0.9725, 0.9529, 0.2078), (0.9725, 0.9529, 0.2078), 1.0),
    'DarkYellow': _material((0.7, 0.7, 0.0)),
    'Purple': _material((1.0, 0.0, 1.0), _DIM, 1.0),
    'Turquoise': _material((0.0, 1.0, 1.0), _DIM, 1.0),
    'Orange': _material((1.0, 0.5088, 0.0468), (0.5, 0.5, 0.5), 128.0),
    'Indigo': _material((0.33, 0.0, 0.5), _DIM, 1.0),
    'Gold': _material(
        (0.8, 0.64869, 0.12076), (0.4, 0.4, 0.4), 12.5, ambient=(0.4, 0.24869, 0.020759)
    ),
    'Chrome': _material((0.8, 0.8, 0.8), ambient=_WHITE, diffuse=_WHITE),
    'WhiteGlow': _glow(_WHITE),
    'RedGlow': _glow((1.0, 0.0, 0.0), (1.0, 0.0, 0.0)),
    'GreenGlow': _glow((0.0, 1.0, 0.0)),
    'BlueGlow': _glow((0.0, 0.0, 1.0)),
    'YellowGlow': _glow((1.0, 1.0, 0.0)),
    'PurpleGlow': _glow((1.0, 0.0, 1.0)),
    'TurquoiseGlow': _glow((0.0, 1.0, 1.0)),
    'LightOn': _glow((0.0, 1.0, 0.0), (0.0, 1.0, 0.0)),
    'LightOff': _glow((1.0, 0.0, 0.0), (1.0, 0.0, 0.0)),
    'RedTransparent': _material((1.0, 0.0, 0.0), alpha=0.5, lit=False),
    'GreenTransparent': _material((0.0, 1.0, 0.0), alpha=0.5),
    'BlueTransparent': _material((0.0, 0.0, 1.0), alpha=0.5),
    'YellowTransparent': _material((1.0, 1.0, 0.0), alpha=0.5),
    'OrangeTransparent': _material((1.0, 0.44, 0.0), alpha=0.4),
    'DarkOrangeTransparent': _material((0.6, 0.3, 0.0), ambient=_WHITE, diffuse=_WHITE),
    'DarkMagentaTransparent': _material((0.6, 0.0, 0.6), alpha=0.5),
    'BlackTransparent': _material(_BLACK, alpha=0.5),
    'GreyTransparent': _material((0.5, 0.5, 0.5), alpha=0.5),
    'BlueLaser': _material((0.0, 0.0, 1.0), alpha=0.4, both_sides=True),
    'Wood': _textured((0.77, 0.515, 0.274), 1.0, 1.0, 0.2, 12.5),
    'WoodFloor': _textured((0.493, 0.22, 0.023), 0.5, 1.0),
    'WoodPallet': _textured((0.62, 0.5, 0.34), 0.5, 1.0),
    'Bricks': _textured((0.613, 0.384, 0.36), 1.0, 1.0, 0.2, 12.5),
    'CeilingTiled': _textured((0.913, 0.913, 0.913), 0.5, 1.0),
    'PaintedWall': _textured((0.938, 0.877, 0.444), 1.0, 1.0),
    'Residential': _textured((0.488, 0.473, 0.43), 0.1, 0.8, 0.01, 2.0),
    'Grass': _textured((0.3, 0.42, 0.2), 1.0, 1.0),
    'Road': _textured((0.372, 0.37, 0.342), 0.1, 0.8, 0.01, 2.0),
    'Asphalt': _textured((0.3, 0.3, 0.3), 1.0, 1.0),
}


def gazebo_material(script: str) -> Material | None:
    """Return the material of a script name such as 'Gazebo/Red', or None for an unknown name."""
    found = _MATERIALS.get(script.removeprefix('Gazebo/'))
    return None if found is None else Material(found.rgba, script, found.reflection)


def material_of_colours(
    base: Material,
    ambient: Colour | None = None,
    diffuse: Colour | None = None,
    specular: Colour | None = None,
    emissive: Colour | None = None,
) -> Material:
    """Return a script's material with the colours that a description gives instead of its own.

    Gazebo shows `Material()`, white, where there is neither.
    """
    own = base.reflection
    shown = diffuse or ambient
    return Material(
        shown or base.rgba,
        base.script,
        Reflection(
            own.ambient if ambient is None else ambient[:3],
            own.diffuse if diffuse is None else diffuse[:3],
            own.specular if specular is None else specular[:3],
            own.shininess,
            own.emissive if emissive is None else emissive[:3],
            own.lit,
            own.both_sides,
        ),
        base.image,
        base.script_file,
    )
