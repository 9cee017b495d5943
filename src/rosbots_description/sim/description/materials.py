"""Colours of the material scripts that come with Gazebo, by name (their diffuse part)."""

from .model_spec import Colour, Material

# The textured ones (wood, grass, ...) are given their texture's prevailing colour.
_COLOURS: dict[str, Colour] = {
    'Grey': (0.7, 0.7, 0.7, 1.0),
    'Gray': (0.7, 0.7, 0.7, 1.0),
    'LightGrey': (0.8, 0.8, 0.8, 1.0),
    'DarkGrey': (0.175, 0.175, 0.175, 1.0),
    'DarkGray': (0.175, 0.175, 0.175, 1.0),
    'White': (1.0, 1.0, 1.0, 1.0),
    'FlatBlack': (0.1, 0.1, 0.1, 1.0),
    'Black': (0.0, 0.0, 0.0, 1.0),
    'Red': (1.0, 0.0, 0.0, 1.0),
    'RedBright': (0.87, 0.26, 0.07, 1.0),
    'Green': (0.0, 1.0, 0.0, 1.0),
    'Blue': (0.0, 0.0, 1.0, 1.0),
    'SkyBlue': (0.13, 0.44, 0.7, 1.0),
    'Yellow': (1.0, 1.0, 0.0, 1.0),
    'ZincYellow': (0.9725, 0.9529, 0.2078, 1.0),
    'DarkYellow': (0.7, 0.7, 0.0, 1.0),
    'Purple': (1.0, 0.0, 1.0, 1.0),
    'Turquoise': (0.0, 1.0, 1.0, 1.0),
    'Orange': (1.0, 0.5088, 0.0468, 1.0),
    'Indigo': (0.33, 0.0, 0.5, 1.0),
    'Gold': (0.8, 0.64869, 0.12076, 1.0),
    'Chrome': (0.8, 0.8, 0.8, 1.0),
    'WhiteGlow': (1.0, 1.0, 1.0, 1.0),
    'RedGlow': (1.0, 0.0, 0.0, 1.0),
    'GreenGlow': (0.0, 1.0, 0.0, 1.0),
    'BlueGlow': (0.0, 0.0, 1.0, 1.0),
    'YellowGlow': (1.0, 1.0, 0.0, 1.0),
    'PurpleGlow': (1.0, 0.0, 1.0, 1.0),
    'TurquoiseGlow': (0.0, 1.0, 1.0, 1.0),
    'RedTransparent': (1.0, 0.0, 0.0, 0.5),
    'GreenTransparent': (0.0, 1.0, 0.0, 0.5),
    'BlueTransparent': (0.0, 0.0, 1.0, 0.5),
    'YellowTransparent': (1.0, 1.0, 0.0, 0.5),
    'OrangeTransparent': (1.0, 0.44, 0.0, 0.5),
    'DarkOrangeTransparent': (0.6, 0.3, 0.0, 0.5),
    'BlackTransparent': (0.0, 0.0, 0.0, 0.5),
    'GreyTransparent': (0.5, 0.5, 0.5, 0.5),
    'Wood': (0.58, 0.43, 0.27, 1.0),
    'WoodFloor': (0.6, 0.45, 0.3, 1.0),
    'WoodPallet': (0.62, 0.5, 0.34, 1.0),
    'Bricks': (0.6, 0.33, 0.26, 1.0),
    'Grass': (0.3, 0.42, 0.2, 1.0),
    'Road': (0.3, 0.3, 0.3, 1.0),
    'Asphalt': (0.3, 0.3, 0.3, 1.0),
}


def gazebo_material(script: str) -> Material | None:
    """Return the material of a script name such as 'Gazebo/Red', or None for an unknown name."""
    colour = _COLOURS.get(script.removeprefix('Gazebo/'))
    return None if colour is None else Material(colour, script)
