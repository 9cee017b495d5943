"""Draws the view of cameras of a scene."""

from typing import Any, cast

import moderngl
import numpy as np
from numpy.typing import NDArray

from .cameras import camera_view, matrices, projection
from .drawable import Drawable, Frame, PlacedPrograms, Placements, gl_matrix
from .render_target import RenderTarget
from .shaders import ShaderVariant, light_block, surface_shaders
from .shadows import Rectangles, Shadows, Sweeps, uniform
from .values import DIRECTIONAL, Lens, Scene

SAMPLES = 4  # per pixel, for antialiasing
MAX_SMOOTHED = 4_000_000  # pixels of a picture; larger ones have no antialiasing
MAX_LIGHTS = 8
_LIGHTS = 0  # binding point of the block of lights
_DULL = 0.5 / 255.0  # specular light that cannot be seen


class Renderer:
    """Meshes, images and one scene, drawn for cameras by `colours` and `depths`."""

    def __init__(self, context: moderngl.Context) -> None:
        self._context = context
        context.front_face = 'cw'  # pictures are drawn upside down, see `cameras`
        self._meshes: dict[str, tuple[moderngl.Buffer, NDArray[Any]]] = {}
        self._images: dict[str, moderngl.Texture] = {}
        self._targets: dict[tuple[int, int, str], RenderTarget] = {}
        self._placed = PlacedPrograms(context)
        self._shadows: Shadows | None = None
        self._light_block = context.buffer(light_block(()))
        self._drawables: list[Drawable] = []
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
        self._light_block.release()
        self._light_block = self._context.buffer(light_block(self._lights))
        casting = [
            number
            for number, light in enumerate(self._lights)
            if light.type == DIRECTIONAL and light.casts_shadow
        ]
        self._sun = casting[0] if scene.shadows and casting else None
        if self._shadows is not None:
            self._shadows.release()
        self._shadows = (
            None
            if self._sun is None
            else Shadows(
                self._context, self._placed.shadow, np.array(self._lights[self._sun].direction)
            )
        )
        for drawable in self._drawables:
            drawable.release()
        self._drop(self._meshes, {part.mesh for part in scene.parts})
        self._drop(self._images, {part.appearance.texture for part in scene.parts})
        self._drawables = [
            Drawable(
                self._context,
                part,
                *self._meshes[part.mesh],
                self._placed,
                self._images.get(part.appearance.texture),
            )
            for part in scene.parts
        ]
        self._placements = Placements(self._drawables)
        casters = [one for one in self._drawables if one.casts_shadow]
        self._still_casters = [one for one in casters if one.part.still]
        self._moving_casters = [one for one in casters if not one.part.still]
        self._static_bodies = sorted({part.body for part in scene.parts if part.still})
        self._stood: NDArray[Any] | None = None  # poses of still bodies in the last shadow map
        key = tuple(light.type for light in self._lights), self._sun, scene.soft
        if key != self._program_key:
            for program in self._programs.values():
                program.release()
            self._programs, self._program_key = {}, key

    def _program(self, variant: ShaderVariant, frame: Frame) -> moderngl.Program:
        """Return the program of surfaces, compiled when first used, set for a picture."""
        program = self._programs.get(variant)
        if program is None:
            types = [light.type for light in self._lights]
            program = self._programs[variant] = self._context.program(
                *surface_shaders(types, self._sun, variant, self._scene.soft)
            )
            if 'Lights' in program:
                cast(moderngl.UniformBlock, program['Lights']).binding = _LIGHTS
        if variant not in frame.prepared:
            frame.prepared.add(variant)
            self._set_frame(program, frame)
        return program

    def _draw_shadows(self, shadows: Shadows, frame: Frame, poses: NDArray[Any]) -> None:
        stands = poses[self._static_bodies]
        if self._stood is None or not np.array_equal(stands, self._stood):
            self._stood = stands
            shadows.forget()
        low = min((one.low for one in self._drawables), default=0.0)
        seen = [
            Sweeps(some, shadows.direction, low).seen(frame.planes)
            for some in (self._still_casters, self._moving_casters)
        ]
        near = shadows.near(frame.eye, frame.lens, seen[1])
        sweeps = {
            name: Sweeps(some, shadows.direction, low)
            for name, some in (('still', seen[0]), ('moving', near))
            if some
        }
        frame.shadowed = _shadowed(frame, sweeps)
        # A map that nothing in the picture reads is not drawn.
        read = {name for parts in frame.shadowed.values() for name in parts}
        shadows.draw(
            frame.eye,
            frame.lens,
            self._still_casters if 'still' in read else (),
            near if 'moving' in read else (),
        )

    def _drop(self, kept: dict[str, Any], used: set[str]) -> None:
        for key in [key for key in kept if key not in used]:
            resource = kept.pop(key)
            (resource[0] if isinstance(resource, tuple) else resource).release()

    def colours(self, lens: Lens, eye: NDArray[Any], poses: NDArray[Any]) -> NDArray[Any]:
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
        self._light_block.bind_to_uniform_block(_LIGHTS)
        self._draw_surfaces(frame)
        return target.read()

    def depths(self, lens: Lens, eye: NDArray[Any], poses: NDArray[Any]) -> NDArray[Any]:
        """Return depths (height, width) float32 along the optical axis [m]; inf: background."""
        frame = self._frame(lens, eye, poses)
        target = self._target(lens, 'depth', 0)
        target.use()
        self._context.clear(np.inf, 0.0, 0.0, 1.0, depth=1.0)
        self._context.enable_only(moderngl.DEPTH_TEST | moderngl.CULL_FACE)
        uniform(self._placed.depth, 'view').write(gl_matrix(frame.view))
        for drawable in frame.visible:
            self._cull(drawable)
            drawable.draw_depth()
        return target.read()

    def _frame(self, lens: Lens, eye: NDArray[Any], poses: NDArray[Any]) -> Frame:
        eye_matrix = matrices(np.asarray(eye, dtype=float)[None])[0]
        frame = Frame(lens, eye_matrix, projection(lens) @ camera_view(eye_matrix), matrices(poses))
        self._placements.place(frame)
        return frame

    def _target(self, lens: Lens, kind: str, samples: int) -> RenderTarget:
        key = lens.width, lens.height, kind
        if key not in self._targets:
            self._targets[key] = RenderTarget(self._context, *key, samples)
        return self._targets[key]

    def _set_frame(self, program: moderngl.Program, frame: Frame) -> None:
        uniform(program, 'view').write(gl_matrix(frame.view))
        _set(program, 'eye', tuple(frame.eye[:3, 3]))
        _set(program, 'scene_ambient', self._scene.ambient)
        if self._shadows is not None:
            self._shadows.use(program)

    def _draw_surfaces(self, frame: Frame) -> None:
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

    def _draw_surface(self, drawable: Drawable, frame: Frame) -> None:
        """Draw a surface; reading a shadow map costs time, so only where shadows may fall."""
        self._cull(drawable)
        parts = frame.shadowed.get(drawable, {})
        maps = tuple(parts)
        if drawable.plane is not None:
            # Rectangles with shadows first: depths keep what was drawn there.
            while maps:
                for rectangle in parts[maps[-1]]:
                    self._context.scissor = rectangle
                    self._draw_with(maps, drawable, frame)
                maps = maps[:-1]
            self._context.scissor = None
        self._draw_with(maps, drawable, frame)

    def _draw_with(self, maps: tuple[str, ...], drawable: Drawable, frame: Frame) -> None:
        appearance = drawable.part.appearance
        shine = max(appearance.specular) * sum(max(light.specular) for light in self._lights)
        variant = ShaderVariant(bool(appearance.texture), shine > _DULL, maps)
        drawable.draw(variant, self._program(variant, frame))

    def _cull(self, drawable: Drawable) -> None:
        if drawable.part.appearance.both_sides:
            self._context.disable(moderngl.CULL_FACE)
        else:
            self._context.enable(moderngl.CULL_FACE)
            self._context.front_face = 'ccw' if drawable.mirrored else 'cw'


def _shadowed(frame: Frame, sweeps: dict[str, Sweeps]) -> dict[Drawable, dict[str, Rectangles]]:
    """Return for each visible part the maps of the shadows that may fall on it, and where.

    Args:
        sweeps: of the casters of each map, by its name.
    """
    middles = np.array([one.middle for one in frame.visible]).reshape(-1, 3)
    radii = np.array([one.radius for one in frame.visible])
    reached = {name: some.reach(middles, radii) for name, some in sweeps.items()}
    size = frame.lens.width, frame.lens.height
    everywhere = [(0, 0, *size)]
    found = {}
    for number, one in enumerate(frame.visible):
        plane = one.plane
        parts = {
            name: sweeps[name].rectangles(plane, frame.view, size) if plane else everywhere
            for name, those in reached.items()
            if those[number]
        }
        found[one] = {name: some for name, some in parts.items() if some}
    return found


def _set(program: moderngl.Program, name: str, value: object) -> None:
    """Set a uniform, unless the compiler has removed it."""
    if name in program:
        uniform(program, name).write(np.array(value, 'f4').tobytes())
