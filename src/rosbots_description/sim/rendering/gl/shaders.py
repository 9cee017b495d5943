"""Shaders: the lighting of Gazebo's per-pixel shaders, and depth.

    colour = emissive + ambient * scene + sum of lights (diffuse * N.L + specular * (N.H)^shininess)

The contribution of a light is attenuated by distance and, for the sun, by shadows.
"""

from collections.abc import Sequence

from .values import DIRECTIONAL, POINT, SPOT

SURFACE_VERTEX = """
#version 330
uniform mat4 placement;
uniform mat3 normal_placement;
uniform mat4 view;
in vec3 position;
in vec3 normal;
in vec2 texcoord;
out vec3 world;
out vec3 world_normal;
out vec2 uv;
void main() {
    vec4 placed = placement * vec4(position, 1.0);
    world = placed.xyz;
    world_normal = normal_placement * normal;
    uv = texcoord;
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
uniform vec3 light_position[LIGHTS];
uniform vec3 light_direction[LIGHTS];
uniform vec3 light_diffuse[LIGHTS];
uniform vec3 light_specular[LIGHTS];
uniform vec4 light_attenuation[LIGHTS]; // constant, linear, quadratic; range
uniform vec3 light_spot[LIGHTS];        // cosine of inner and outer half cone; falloff
uniform sampler2DShadow still_shadows;
uniform mat4 still_view;
uniform float still_texel;              // its width in the world
uniform sampler2DShadow moving_shadows;
uniform mat4 moving_view;
uniform float moving_texel;
uniform sampler2D image;
in vec3 world;
in vec3 world_normal;
in vec2 uv;
out vec4 colour;
vec3 normal;
vec3 towards_eye;
vec3 reflected;
vec3 shine;

float share_of_light(sampler2DShadow map, mat4 map_view, float texel, float slant) {
    // Off the surface, the more so the more it is slanted, or it would be in its own shadow.
    vec4 off = vec4(world + normal * texel * (0.7 + 2.0 * slant), 1.0);
    vec3 point = 0.5 * (map_view * off).xyz + 0.5;
    float share = texture(map, point);  // of the four texels around the point
    return any(greaterThan(abs(point - 0.5), vec3(0.5))) ? 1.0 : share;
}

float sunshine(vec3 towards_light) {
    float slant = 1.0 - dot(normal, towards_light);
    return STILL_SHADOWS * MOVING_SHADOWS;
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
    reflected += share * facing * light_diffuse[i] * diffuse.rgb;
    float glance = max(dot(normal, normalize(towards_light + towards_eye)), 0.0);
    shine += share * (specular.a > 0.0 ? pow(glance, specular.a) : 1.0)
        * light_specular[i] * specular.rgb;
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
    shine_on({i}, -light_direction[{i}], {sunshine});""",
    POINT: """{{
    vec3 way = light_position[{i}] - world;
    shine_on({i}, normalize(way), strength_at(length(way), light_attenuation[{i}]));
    }}""",
    SPOT: """{{
    vec3 way = light_position[{i}] - world;
    shine_on({i}, normalize(way), strength_at(length(way), light_attenuation[{i}])
        * spot_share(-dot(normalize(way), light_direction[{i}]), light_spot[{i}]));
    }}""",
}


def surface_fragment(types: Sequence[int], sun: int | None, moves: bool, textured: bool) -> str:
    """Return the shader of surfaces.

    Args:
        types: of the lights.
        sun: index of the light that casts shadows.
        moves: whether there are moving shadows.
        textured: whether surfaces have images.
    """
    shine = ''.join(
        _SHINE[kind].format(
            i=i, sunshine=f'sunshine(-light_direction[{i}])' if i == sun else '1.0')
        for i, kind in enumerate(types))
    share = 'share_of_light({0}_shadows, {0}_view, {0}_texel, slant)'
    words = {
        'STILL_SHADOWS': share.format('still') if sun is not None else '1.0',
        'MOVING_SHADOWS': share.format('moving') if sun is not None and moves else '1.0',
        'SHINE': shine, 'IMAGE': 'texture(image, uv)' if textured else '1.0',
        'LIGHTS': str(max(1, len(types))),
    }
    text = _SURFACE_FRAGMENT
    for word, meaning in words.items():
        text = text.replace(word, meaning)
    return text


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
