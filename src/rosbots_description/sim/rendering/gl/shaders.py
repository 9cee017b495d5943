"""Shaders: the lighting of Gazebo's per-pixel shaders, and depth.

    colour = emissive + ambient * scene + sum of lights (diffuse * N.L + specular * (N.H)^shininess)

The contribution of a light is attenuated by distance and, for the sun, by shadows.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from .values import DIRECTIONAL, POINT, SPOT, Light

# All lights in one block of std140 layout. Its size is fixed, whereas compilers shorten arrays of
# uniforms to the elements that a shader reads, which differ by the types of the lights.
_LIGHT_BLOCK = """
struct Light {
    vec4 position;
    vec4 direction;
    vec4 diffuse;
    vec4 specular;
    vec4 attenuation;  // constant, linear, quadratic; range
    vec4 spot;         // cosine of inner and outer half cone; falloff
};
layout(std140) uniform Lights {
    Light lights[LIGHTS];
};
"""

_SURFACE_VERTEX = """
#version 330
uniform mat4 placement;
uniform mat3 normal_placement;
uniform mat4 view;
LIGHT_BLOCK
uniform mat4 still_view;
uniform float still_texel;              // its width in the world
uniform mat4 moving_view;
uniform float moving_texel;
in vec3 position;
in vec3 normal;
in vec2 texcoord;
out vec3 world;
out vec3 world_normal;
out vec2 uv;
out vec3 still_point;
out vec3 moving_point;

vec3 map_point(mat4 map_view, float texel) {
    // Off the surface, the more so the more it is slanted, or it would be in its own shadow.
    vec3 turned = world_normal / max(length(world_normal), 1e-9);
    float slant = 1.0 + dot(turned, lights[SUN].direction.xyz);
    float distance = texel * (0.7 + 2.0 * slant) + BLUR * sqrt(max(slant * (2.0 - slant), 0.0));
    return 0.5 * (map_view * vec4(world + turned * distance, 1.0)).xyz + 0.5;
}

void main() {
    vec4 placed = placement * vec4(position, 1.0);
    world = placed.xyz;
    world_normal = normal_placement * normal;
    uv = texcoord;
    POINTS
    gl_Position = view * placed;
}
"""

_SURFACE_FRAGMENT = """
#version 330
uniform vec3 eye;
uniform vec3 scene_ambient;
uniform vec3 ambient;
uniform vec4 diffuse;       // with alpha
uniform vec4 specular;      // with shininess
uniform vec3 emissive;
uniform float lit;          // 1, or 0 for what shows its diffuse colour whatever the light
LIGHT_BLOCK
uniform sampler2DShadow still_shadows;
uniform float still_texel;
uniform sampler2DShadow moving_shadows;
uniform float moving_texel;
uniform sampler2D image;
in vec3 world;
in vec3 world_normal;
in vec2 uv;
in vec3 still_point;
in vec3 moving_point;
out vec4 colour;
vec3 normal;
vec3 towards_eye;
vec3 reflected;
vec3 shine;

BLURRED
float share_of_light(sampler2DShadow map, vec3 point, float texel) {
    float share = SHARE;
    vec3 off = abs(point - 0.5);
    return max(max(off.x, off.y), off.z) > 0.5 ? 1.0 : share;
}

float strength_at(float distance, vec4 a) {
    return distance > a.w ? 0.0 : 1.0 / max(a.x + distance * (a.y + distance * a.z), 1e-6);
}

float spot_share(float along, vec3 spot) {
    float share = clamp((along - spot.y) / max(spot.x - spot.y, 1e-6), 0.0, 1.0);
    return share > 0.0 ? pow(share, spot.z) : 0.0;
}

void shine_on(int i, vec3 towards_light, float strength) {
    float facing = dot(normal, towards_light);
    float share = facing > 0.0 ? strength : 0.0;
    reflected += share * facing * lights[i].diffuse.rgb * diffuse.rgb;
    GLOSS
}

void main() {
    normal = normalize(world_normal);
    towards_eye = normalize(eye - world);
    reflected = emissive + scene_ambient * ambient;
    shine = vec3(0.0);
    SHINE
    colour = vec4(mix(diffuse.rgb, reflected, lit), diffuse.a) * IMAGE;
    colour.rgb += lit * shine;
}
"""

# Code for each light, by type. In a software renderer all branches of a shader cost time, so the
# shaders are generated for the lights of the scene.
_SHINE = {
    DIRECTIONAL: """
    shine_on({i}, -lights[{i}].direction.xyz, {sunshine});""",
    POINT: """{{
    vec3 way = lights[{i}].position.xyz - world;
    shine_on({i}, normalize(way), strength_at(length(way), lights[{i}].attenuation));
    }}""",
    SPOT: """{{
    vec3 way = lights[{i}].position.xyz - world;
    shine_on({i}, normalize(way), strength_at(length(way), lights[{i}].attenuation)
        * spot_share(-dot(normalize(way), lights[{i}].direction.xyz), lights[{i}].spot.xyz));
    }}""",
}


_BLUR = 0.02  # [m] on both sides of an edge of a shadow

# The share of the light by nine texture reads, each of the four texels around a point.
_BLURRED = """
float blurred(sampler2DShadow map, vec3 point, float texel) {
    vec2 apart = BLUR / (texel * vec2(textureSize(map, 0)));
    float sum = 0.0;
    for (int x = -1; x <= 1; ++x)
        for (int y = -1; y <= 1; ++y)
            sum += texture(map, point + vec3(float(x) * apart.x, float(y) * apart.y, 0.0));
    return sum / 9.0;
}
"""

_GLOSS = """
    float glance = max(dot(normal, normalize(towards_light + towards_eye)), 0.0);
    shine += share * (specular.a > 0.0 ? pow(glance, specular.a) : 1.0)
        * lights[i].specular.rgb * specular.rgb;"""


class ShaderVariant(NamedTuple):
    """What a program of surfaces computes."""

    textured: bool
    glossy: bool
    maps: tuple[str, ...]  # shadow maps that are read: 'still', 'moving'


def light_block(lights: Sequence[Light]) -> bytes:
    """Return the contents of the block `Lights`, for at least one light."""
    rows = [
        [
            *light.position,
            0.0,
            *light.direction,
            0.0,
            *light.diffuse,
            0.0,
            *light.specular,
            0.0,
            *light.attenuation,
            light.range,
            *light.spot,
            0.0,
        ]
        for light in lights
    ]
    return np.array(rows or np.zeros((1, 24)), 'f4').tobytes()


def surface_shaders(
    types: Sequence[int], sun: int | None, variant: ShaderVariant, soft: bool = False
) -> tuple[str, str]:
    """Return the vertex and fragment shaders of surfaces.

    Args:
        types: of the lights.
        sun: index of the light that casts shadows; without one `variant` has no maps.
        variant: what they compute.
        soft: whether the edges of shadows are blurred.
    """
    sunshine = (
        ' * '.join(
            f'share_of_light({name}_shadows, {name}_point, {name}_texel)' for name in variant.maps
        )
        or '1.0'
    )
    words = {
        'LIGHT_BLOCK': _LIGHT_BLOCK,
        'SHINE': ''.join(
            _SHINE[kind].format(i=i, sunshine=sunshine if i == sun else '1.0')
            for i, kind in enumerate(types)
        ),
        'POINTS': ' '.join(
            f'{name}_point = map_point({name}_view, {name}_texel);' for name in variant.maps
        ),
        'SHARE': 'blurred(map, point, texel)' if soft else 'texture(map, point)',
        'BLURRED': _BLURRED if soft else '',
        'BLUR': str(_BLUR if soft else 0.0),
        'GLOSS': _GLOSS if variant.glossy else '',
        'IMAGE': 'texture(image, uv)' if variant.textured else '1.0',
        'LIGHTS': str(max(1, len(types))),
        'SUN': str(sun or 0),
    }
    vertex, fragment = _SURFACE_VERTEX, _SURFACE_FRAGMENT
    for word, meaning in words.items():
        vertex, fragment = vertex.replace(word, meaning), fragment.replace(word, meaning)
    return vertex, fragment


DEPTH_FRAGMENT = """
#version 330
out float depth;
void main() {
    depth = 1.0 / gl_FragCoord.w;  // w of the clip space is the distance along the optical axis
}
"""

PLACED_VERTEX = """
#version 330
uniform mat4 placement;
uniform mat4 view;
in vec3 position;
void main() {
    gl_Position = view * (placement * vec4(position, 1.0));
}
"""

NOTHING_FRAGMENT = """
#version 330
void main() {
}
"""
