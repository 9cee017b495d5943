"""Lights of a world as those of the browser's renderer.

That one is physical: light of intensity pi shows a white surface white. Gazebo's is not: there,
light of brightness 1 does.
"""

import math

import viser

from ...sim.core import Vector, rotate
from ...sim.description import DIRECTIONAL, POINT, LightSpec

SUN_DISTANCE = 100.0  # [m] of a directional light; it shines towards the origin


def add_light(scene: viser.SceneApi, name: str, light: LightSpec, shadows: bool) -> None:
    """Add a light to the scene, or replace that of the name."""
    brightness = max(light.diffuse[:3])
    colour = rgb_bytes(light.diffuse[:3], brightness)
    shadow = shadows and light.cast_shadows
    x, y, z = rotate(light.pose.orientation, light.direction)
    if light.type == DIRECTIONAL:
        back = -SUN_DISTANCE / (math.hypot(x, y, z) or 1.0)
        scene.add_light_directional(
            name,
            color=colour,
            intensity=math.pi * brightness,
            cast_shadow=shadow,
            position=(back * x, back * y, back * z),
        )
        return
    intensity, decay = _decay(light)
    intensity *= math.pi * brightness
    if light.type == POINT:
        scene.add_light_point(
            name,
            color=colour,
            intensity=intensity,
            distance=light.range,
            decay=decay,
            cast_shadow=shadow,
            position=light.pose.position,
        )
        return
    outer = max(light.spot_outer_angle, 1e-3)
    scene.add_light_spot(
        name,
        color=colour,
        intensity=intensity,
        distance=light.range,
        decay=decay,
        angle=min(outer, math.pi) / 2.0,
        penumbra=1.0 - min(light.spot_inner_angle / outer, 1.0),
        cast_shadow=shadow,
        direction=(x, y, z),
        position=light.pose.position,
    )


def rgb_bytes(colour: Vector, brightness: float = 1.0) -> tuple[int, int, int]:
    """Return a colour of 0..1, divided by the brightness, as bytes."""
    red, green, blue = (
        round(255.0 * min(max(part / (brightness or 1.0), 0.0), 1.0)) for part in colour
    )
    return red, green, blue


def _decay(light: LightSpec) -> tuple[float, float]:
    """Return factor and power of the distance, by the term of the attenuation that counts most."""
    terms = (light.attenuation_constant, light.attenuation_linear, light.attenuation_quadratic)
    reach = max(light.range, 1.0)
    shares = [term * reach**power for power, term in enumerate(terms)]
    power = max(range(3), key=lambda n: shares[n])
    return (1.0 / terms[power], float(power)) if terms[power] > 0.0 else (1.0, 0.0)
