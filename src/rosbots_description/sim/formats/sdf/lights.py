"""Lights of SDF."""

from lxml import etree

from ...core import Pose, fault
from ...description import DIRECTIONAL, POINT, SPOT, LightSpec
from ..xml import required_name
from .document import SdfDocument
from .values import boolean_of, colour_of, number_of, vector_of

_TYPES = (POINT, DIRECTIONAL, SPOT)


def read_light(document: SdfDocument, element: etree._Element, pose: Pose) -> LightSpec:
    """Return a <light> at `pose` in the world.

    Raises:
        ModelError: a number is wrong, or the type is unknown.
    """
    document.notes.check(
        element,
        ('pose', 'cast_shadows', 'diffuse', 'specular', 'attenuation', 'direction', 'spot'),
        ('intensity', 'visualize', 'light_on'),
    )
    kind = element.get('type', POINT)
    if kind not in _TYPES:
        raise fault(element, f"light type '{kind}' is unknown; there are {', '.join(_TYPES)}")
    name = required_name(element)
    plain = LightSpec(name)
    return LightSpec(
        name,
        kind,
        pose,
        diffuse=colour_of(element, 'diffuse') or plain.diffuse,
        specular=colour_of(element, 'specular') or plain.specular,
        range=number_of(element, 'attenuation/range', plain.range),
        attenuation_constant=number_of(element, 'attenuation/constant', 1.0),
        attenuation_linear=number_of(element, 'attenuation/linear', 1.0),
        attenuation_quadratic=number_of(element, 'attenuation/quadratic', 0.0),
        direction=vector_of(element, 'direction', plain.direction),
        cast_shadows=boolean_of(element, 'cast_shadows'),
        spot_inner_angle=number_of(element, 'spot/inner_angle', 0.0),
        spot_outer_angle=number_of(element, 'spot/outer_angle', 0.0),
        spot_falloff=number_of(element, 'spot/falloff', 0.0),
    )
