"""Draws the view of cameras of a scene."""

from functools import lru_cache
from typing import Any

import moderngl
import numpy as np
from numpy.typing import NDArray

from .cameras import camera_view, matrices, projection
from .shaders import (
    DEPTH_FRAGMENT,
    NOTHING_FRAGMENT,
    PLACED_VERTEX,
    ShaderVariant,
    surface_shaders,
)
from .shadows import Shadows, Sweeps, uniform
from .values import DIRECTIONAL, Appearance, Lens, Scene, ScenePart

SAMPLES = 4  # per pixel, for antialiasing
MAX_SMOOTHED = 4_000_000  # pixels of a picture; larger ones have no antialiasing
MAX_LIGHTS = 8
_BLUR = 0.1  # [m] by which shadow maps may widen shadows
_CORNERS = np.stack(np.meshgrid(*[(-1.0, 1.0)] * 3), axis=-1).reshape(8, 3)  # of a cube
_DULL = 0.5 / 255.0  # specular light that cannot be seen
_LAYOUT = {'position': 3, 'normal': 3, 'texcoord': 2}  # floats of a vertex


class Renderer:
    """Meshes, images and one scene, drawn for cameras by `colours` and `depths`."""

    def __init__(self, context: moderngl.Context) -> None:
        self._context = context
        context.front_face = 'cw'  # pictures are drawn upside down, see `cameras`
        self._meshes: dict[str, tuple[moderngl.Buffer, NDArray[Any]]] = {}
        self._images: dict[str, moderngl.Texture] = {}
        self._targets: dict[tuple[int, int, str], _Target] = {}
        self._placed = _PlacedPrograms(context)
        self._shadows: Shadows | None = None
        self._drawables: list[_Drawable] = []
        self._programs: dict[ShaderVariant, moderngl.Program] = {}
        self._program_key: tuple[object, ...] = ()  # of the lights for which they were written
        self.set_scene(Scene(()))

    def add_mesh(self, key: str, triangles: NDArray[Any]) -> None:
        """Add triangles: (3 n, 8) float32 of position [m], normal, texture coordinates."""
        corners = triangles[:, :3]
        bounds = np.stack([corners.min(0), corners.max(0)])
        self._meshes[key] = (self._context.buffer(np.ascontiguousarray(triangles, 'f4')), bounds)

    def add_image(self, key: str, pixels: NDArray[Any]) -> None:
        """Add an image (height, width, 3 or 4) uint8, top row first."""
        pixels = np.ascontiguousarray(pixels[::-1])
        height, width, channels = pixels.shape
        image = self._context.texture((width, height), channels, pixels.tobytes(), alignment=1)
        image.build_mipmaps()
        image.filter = (moderngl.LINEAR_MIPMAP_LINEAR, moderngl.LINEAR)
        self._images[key] = image

    def set_scene(self, scene: Scene) -> None:
        """Set the scene; meshes and images that it does not use are freed."""
        self._scene = scene
        self._lights = scene.lights[:MAX_LIGHTS]
        casting = [number for number, light in enumerate(self._lights)
                   if light.type == DIRECTIONAL and light.casts_shadow]
        self._sun = casting[0] if scene.shadows and casting else None
        if self._shadows is not None:
            self._shadows.release()
        self._shadows = None if self._sun is None else Shadows(
            self._context, self._placed.shadow, np.array(self._lights[self._sun].direction))
        for drawable in self._drawables:
            drawable.release()
        self._drop(self._meshes, {part.mesh for part in scene.parts})
        self._drop(self._images, {part.appearance.texture for part in scene.parts})
        self._drawables = [
            _Drawable(self._context, part, *self._meshes[part.mesh], self._placed,
                      self._images.get(part.appearance.texture))
            for part in scene.parts
        ]
        self._static_bodies = sorted({part.body for part in scene.parts if part.still})
        self._stood: NDArray[Any] | None = None  # poses of still bodies in the last shadow map
        key = tuple(light.type for light in self._lights), self._sun
        if key != self._program_key:
            for program in self._programs.values():
                program.release()
            self._programs, self._program_key = {}, key

    def _program(self, variant: ShaderVariant, frame: '_View') -> moderngl.Program:
        """Return the program of surfaces, compiled when first used, set for a picture."""
        program = self._programs.get(variant)
        if program is None:
            types = [light.type for light in self._lights]
            program = self._programs[variant] = self._context.program(
                *surface_shaders(types, self._sun, variant))
        if variant not in frame.prepared:
            frame.prepared.add(variant)
            self._set_frame(program, frame)
        return program

    def _draw_shadows(self, shadows: Shadows, frame: '_View', poses: NDArray[Any]) -> None:
        stands = poses[self._static_bodies]
        if self._stood is None or not np.array_equal(stands, self._stood):
            self._stood = stands
            shadows.forget()
        casters = [one for one in self._drawables if one.casts_shadow]
        low = min(one.low for one in self._drawables)
        still, moving = (
            [one for one in casters if one.part.still == is_still] for is_still in (True, False))
        seen = [Sweeps(some, shadows.direction, low).seen(frame.planes)
                for some in (still, moving)]
        near = shadows.draw(frame.eye, frame.lens, still, seen[1])
        frame.shadows = {name: Sweeps(some, shadows.direction, low)
                         for name, some in (('still', seen[0]), ('moving', near)) if some}

    def _drop(self, kept: dict[str, Any], used: set[str]) -> None:
        for key in [key for key in kept if key not in used]:
            resource = kept.pop(key)
            (resource[0] if isinstance(resource, tuple) else resource).release()

    def colours(
        self, lens: Lens, eye: NDArray[Any], poses: NDArray[Any]
    ) -> NDArray[Any]:
        """Return the picture (height, width, 4) uint8, without camera effects.

        Args:
            eye: the camera's pose (7,), position [m] and quaternion x, y, z, w.
            poses: of the bodies (n, 7).
        """
        frame = self._frame(lens, eye, poses)
        if self._shadows is not None:
            self._draw_shadows(self._shadows, frame, poses)
        samples = SAMPLES if lens.width * lens.height <= MAX_SMOOTHED else 0
        target = self._target(lens, 'colour', samples)
        target.use()
        self._context.clear(*self._scene.background, 1.0, depth=1.0)
        self._draw_surfaces(frame)
        return target.read()

    def depths(self, lens: Lens, eye: NDArray[Any], poses: NDArray[Any]) -> NDArray[Any]:
        """Return depths (height, width) float32 along the optical axis [m]; inf: background."""
        frame = self._frame(lens, eye, poses)
        target = self._target(lens, 'depth', 0)
        target.use()
        self._context.clear(np.inf, 0.0, 0.0, 1.0, depth=1.0)
        self._context.enable_only(moderngl.DEPTH_TEST | moderngl.CULL_FACE)
        uniform(self._placed.depth, 'view').write(_gl(frame.view))
        for drawable in frame.visible:
            self._cull(drawable)
            drawable.draw_depth()
        return target.read()

    def _frame(self, lens: Lens, eye: NDArray[Any], poses: NDArray[Any]) -> '_View':
        eye_matrix = matrices(np.asarray(eye, dtype=float)[None])[0]
        frame = _View(lens, eye_matrix, projection(lens) @ camera_view(eye_matrix),
                       matrices(poses))
        frame.visible = []
        for drawable in self._drawables:
            drawable.place(frame)
            if frame.may_see(drawable):
                frame.visible.append(drawable)
        return frame

    def _target(self, lens: Lens, kind: str, samples: int) -> '_Target':
        key = lens.width, lens.height, kind
        if key not in self._targets:
            self._targets[key] = _Target(self._context, *key, samples)
        return self._targets[key]

    def _set_frame(self, program: moderngl.Program, frame: '_View') -> None:
        uniform(program, 'view').write(_gl(frame.view))
        _set(program, 'eye', tuple(frame.eye[:3, 3]))
        _set(program, 'scene_ambient', self._scene.ambient)
        lights = self._lights
        if lights:
            _set(program, 'light_position', [light.position for light in lights])
            _set(program, 'light_direction', [light.direction for light in lights])
            _set(program, 'light_diffuse', [light.diffuse for light in lights])
            _set(program, 'light_specular', [light.specular for light in lights])
            _set(program, 'light_attenuation',
                 [(*light.attenuation, light.range) for light in lights])
            _set(program, 'light_spot', [light.spot for light in lights])
        if self._shadows is not None:
            self._shadows.use(program)

    def _draw_surfaces(self, frame: '_View') -> None:
        context = self._context
        context.enable_only(moderngl.DEPTH_TEST | moderngl.CULL_FACE)
        # Front to back: hidden surfaces need no lighting.
        ordered = sorted(frame.visible, key=frame.distance)
        for drawable in ordered:
            if not drawable.transparent:
                self._draw_surface(drawable, frame)
        seen_through = [one for one in reversed(ordered) if one.transparent]
        if seen_through:
            context.enable(moderngl.BLEND)
            context.blend_func = moderngl.SRC_ALPHA, moderngl.ONE_MINUS_SRC_ALPHA
            context.fbo.depth_mask = False
            for drawable in seen_through:
                self._draw_surface(drawable, frame)
            context.fbo.depth_mask = True

    def _draw_surface(self, drawable: '_Drawable', frame: '_View') -> None:
        """Draw a surface; reading a shadow map costs time, so only where shadows may fall."""
        self._cull(drawable)
        maps = tuple(name for name, sweeps in frame.shadows.items()
                     if sweeps.reach(drawable.middle, drawable.radius))
        plane = drawable.plane
        if plane is not None:
            # Rectangles with shadows first: depths keep what was drawn there.
            size = frame.lens.width, frame.lens.height
            while maps:
                for rectangle in frame.shadows[maps[-1]].rectangles(plane, frame.view, size):
                    self._context.scissor = rectangle
                    self._draw_with(maps, drawable, frame)
                maps = maps[:-1]
            self._context.scissor = None
        self._draw_with(maps, drawable, frame)

    def _draw_with(self, maps: tuple[str, ...], drawable: '_Drawable', frame: '_View') -> None:
        appearance = drawable.part.appearance
        shine = max(appearance.specular) * sum(max(light.specular) for light in self._lights)
        variant = ShaderVariant(bool(appearance.texture), shine > _DULL, maps)
        drawable.draw(variant, self._program(variant, frame))

    def _cull(self, drawable: '_Drawable') -> None:
        if drawable.part.appearance.both_sides:
            self._context.disable(moderngl.CULL_FACE)
        else:
            self._context.enable(moderngl.CULL_FACE)
            self._context.front_face = 'ccw' if drawable.mirrored else 'cw'


class _View:
    """View, lens and poses of one picture."""

    visible: list['_Drawable']

    def __init__(
        self, lens: Lens, eye: NDArray[Any], view: NDArray[Any], bodies: NDArray[Any]
    ) -> None:
        self.lens, self.eye, self.view, self.bodies = lens, eye, view, bodies
        rows = view[3] + np.array([view[0], -view[0], view[1], -view[1], view[2]])
        self.planes = rows / np.linalg.norm(rows[:, :3], axis=1, keepdims=True)
        self.shadows: dict[str, Sweeps] = {}  # by map
        self.prepared: set[ShaderVariant] = set()  # whose programs are set for this picture

    def may_see(self, drawable: '_Drawable') -> bool:
        """Tell whether a drawable's bounding sphere reaches into the view frustum."""
        return bool((self.planes[:, :3] @ drawable.middle + self.planes[:, 3]
                     > -drawable.radius).all())

    def distance(self, drawable: '_Drawable') -> float:
        """Return the distance of a drawable along the optical axis [m], for sorting."""
        if drawable.plane is not None:
            return np.inf  # behind all that stands on it
        way = drawable.middle - self.eye[:3, 3]
        return float(way @ self.eye[:3, 0]) - (0.0 if drawable.transparent else drawable.radius)


class _PlacedPrograms:
    """The shader programs that need only positions."""

    def __init__(self, context: moderngl.Context) -> None:
        self.depth = context.program(vertex_shader=PLACED_VERTEX, fragment_shader=DEPTH_FRAGMENT)
        self.shadow = context.program(
            vertex_shader=PLACED_VERTEX, fragment_shader=NOTHING_FRAGMENT)


class _Drawable:
    """A part of the scene on the GPU."""

    def __init__(
        self,
        context: moderngl.Context,
        part: ScenePart,
        buffer: moderngl.Buffer,
        bounds: NDArray[Any],
        placed: _PlacedPrograms,
        image: moderngl.Texture | None,
    ) -> None:
        self.part = part
        self._matrix = np.frombuffer(part.matrix).reshape(4, 4)
        self._middle = bounds.mean(axis=0)
        half = self._half = (bounds[1] - bounds[0]) / 2.0
        self.radius = float(np.linalg.norm(np.abs(self._matrix[:3, :3]) @ half))
        self.mirrored = bool(np.linalg.det(self._matrix[:3, :3]) < 0.0)
        self.transparent = part.appearance.alpha < 1.0
        self.casts_shadow = part.casts_shadow and not self.transparent
        self._depth, self._shadow = (
            context.vertex_array(program, [(buffer, '3f 5x4', 'position')])
            for program in (placed.depth, placed.shadow))
        self._image = image
        self._context, self._buffer = context, buffer
        self._surfaces: dict[ShaderVariant, tuple[moderngl.VertexArray, Any]] = {}  # with uniforms
        self._normals = np.linalg.inv(self._matrix[:3, :3]).T  # transform of normals

    def place(self, frame: _View) -> None:
        """Update the placement for a picture."""
        body = frame.bodies[self.part.body]
        placement = body @ self._matrix
        self._turn = body[:3, :3]
        self.middle = placement[:3, :3] @ self._middle + placement[:3, 3]
        self.low = float(self.middle[2] - np.abs(placement[2, :3]) @ self._half)  # [m]
        self._placement = _gl(placement)
        self._axes = placement[:3, :3]

    @property
    def plane(self) -> tuple[NDArray[Any], NDArray[Any]] | None:
        """Return a point and the normal, if it is ground: flat, opaque and without a shadow."""
        flat = int(np.argmin(self._half))
        if self.part.casts_shadow or self.transparent or self._half[flat] > 0.0:
            return None
        return self.middle, self._axes[:, flat] / np.linalg.norm(self._axes[:, flat])

    @property
    def corners(self) -> NDArray[Any]:
        """Return those of a box around it, with room for blurred shadows (8, 3) [m]."""
        lengths = np.linalg.norm(self._axes, axis=0)
        half = self._half + _BLUR / lengths
        return np.asarray(self.middle + (_CORNERS * half) @ self._axes.T)

    def draw(self, variant: ShaderVariant, program: moderngl.Program) -> None:
        """Draw the surface in its colours."""
        if variant not in self._surfaces:
            used = [name for name in _LAYOUT if name in program]
            layout = ' '.join(f'{size}f' if name in used else f'{size}x4'
                              for name, size in _LAYOUT.items())
            self._surfaces[variant] = (
                self._context.vertex_array(program, [(self._buffer, layout, *used)]),
                _uniforms(program, self.part.appearance))
        array, uniforms = self._surfaces[variant]
        uniform(program, 'placement').write(self._placement)
        if 'normal_placement' in program:
            uniform(program, 'normal_placement').write(_gl(self._turn @ self._normals))
        for place, value in uniforms:
            place.write(value)
        if self._image is not None:
            self._image.use(0)
        array.render()

    def draw_depth(self) -> None:
        """Draw its depth."""
        uniform(self._depth.program, 'placement').write(self._placement)
        self._depth.render()

    def draw_shadow(self) -> None:
        """Draw it into the shadow map."""
        uniform(self._shadow.program, 'placement').write(self._placement)
        self._shadow.render()

    def release(self) -> None:
        """Free its resources on the GPU."""
        for array in (*(array for array, _ in self._surfaces.values()), self._depth, self._shadow):
            array.release()


class _Target:
    """The framebuffers of a camera's picture."""

    def __init__(
        self, context: moderngl.Context, width: int, height: int, kind: str, samples: int
    ) -> None:
        size = width, height
        self._context, self._samples = context, samples
        self._form = ('f4', 1) if kind == 'depth' else ('f1', 4)
        dtype, channels = self._form
        self._plain = context.framebuffer(
            [context.renderbuffer(size, channels, dtype=dtype)],
            None if samples else context.depth_renderbuffer(size))
        self._drawn = context.framebuffer(
            [context.renderbuffer(size, channels, samples=samples)],
            context.depth_renderbuffer(size, samples=samples)) if samples else self._plain
        self._pixels = np.empty(
            (height, width) if channels == 1 else (height, width, channels),
            'f4' if dtype == 'f4' else 'u1')

    def use(self) -> None:
        """Bind it for drawing."""
        self._drawn.use()

    def read(self) -> NDArray[Any]:
        """Return what was drawn; it is overwritten by the next picture."""
        dtype, channels = self._form
        if self._samples:
            self._context.copy_framebuffer(self._plain, self._drawn)
        self._plain.read_into(self._pixels, components=channels, dtype=dtype)
        return self._pixels


@lru_cache(maxsize=4096)
def _appearance_values(appearance: Appearance) -> dict[str, bytes]:
    values = {
        'ambient': appearance.ambient, 'diffuse': (*appearance.diffuse, appearance.alpha),
        'specular': (*appearance.specular, appearance.shininess), 'emissive': appearance.emissive,
        'lit': (float(appearance.lit),),
    }
    return {name: np.array(value, 'f4').tobytes() for name, value in values.items()}


def _uniforms(
    program: moderngl.Program, appearance: Appearance
) -> list[tuple[moderngl.Uniform, bytes]]:
    values = _appearance_values(appearance)
    return [(uniform(program, name), value) for name, value in values.items() if name in program]


def _set(program: moderngl.Program, name: str, value: object) -> None:
    """Set a uniform, unless the compiler has removed it."""
    if name in program:
        uniform(program, name).write(np.array(value, 'f4').tobytes())


def _gl(matrix: NDArray[Any]) -> bytes:
    """Return a matrix for OpenGL: column-major, float32."""
    return matrix.T.astype('f4').tobytes()
