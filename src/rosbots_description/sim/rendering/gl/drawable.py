"""The parts of a scene on the GPU, and the frame in which they are drawn."""

from collections.abc import Sequence
from functools import lru_cache
from typing import Any

import moderngl
import numpy as np
from numpy.typing import NDArray

from .cameras import box_reaches
from .shaders import DEPTH_FRAGMENT, NOTHING_FRAGMENT, PLACED_VERTEX, ShaderVariant
from .shadows import Rectangles, uniform
from .values import Appearance, Lens, ScenePart

_TOUCHING = 1e-5  # [m] the GPU's positions have seven digits
_BLUR = 0.1  # [m] by which shadow maps may widen shadows
LAYOUT = {'position': 3, 'normal': 3, 'texcoord': 2}  # floats of a vertex


class Frame:
    """View, lens and poses of one picture."""

    visible: list['Drawable']

    def __init__(
        self, lens: Lens, eye: NDArray[Any], view: NDArray[Any], bodies: NDArray[Any]
    ) -> None:
        self.lens, self.eye, self.view, self.bodies = lens, eye, view, bodies
        rows = view[3] + np.array([view[0], -view[0], view[1], -view[1], view[2]])
        self.planes = rows / np.linalg.norm(rows[:, :3], axis=1, keepdims=True)
        self.shadowed: dict[Drawable, dict[str, Rectangles]] = {}  # by maps of what falls on it
        self.prepared: set[ShaderVariant] = set()  # whose programs are set for this picture

    def sees(self, middles: NDArray[Any], arms: NDArray[Any]) -> NDArray[np.bool_]:
        """Tell which boxes reach into the view frustum.

        Args:
            middles: of the boxes (n, 3) [m].
            arms: from there to three of their sides, as columns (n, 3, 3) [m].
        """
        heights = middles @ self.planes[:, :3].T + self.planes[:, 3]
        reaches = box_reaches(arms, self.planes[:, :3])
        seen: NDArray[np.bool_] = (heights > -_TOUCHING - reaches).all(axis=1)
        return seen

    def distance(self, drawable: 'Drawable') -> float:
        """Return the distance of a drawable along the optical axis [m], for sorting."""
        if drawable.plane is not None:
            return np.inf  # behind all that stands on it
        way = drawable.middle - self.eye[:3, 3]
        return float(way @ self.eye[:3, 0]) - (0.0 if drawable.transparent else drawable.radius)


class PlacedPrograms:
    """The shader programs that need only positions."""

    def __init__(self, context: moderngl.Context) -> None:
        self.depth = context.program(vertex_shader=PLACED_VERTEX, fragment_shader=DEPTH_FRAGMENT)
        self.shadow = context.program(vertex_shader=PLACED_VERTEX, fragment_shader=NOTHING_FRAGMENT)


class Drawable:
    """A part of the scene on the GPU."""

    def __init__(
        self,
        context: moderngl.Context,
        part: ScenePart,
        buffer: moderngl.Buffer,
        bounds: NDArray[Any],
        placed: PlacedPrograms,
        image: moderngl.Texture | None,
    ) -> None:
        self.part = part
        self.matrix = np.frombuffer(part.matrix).reshape(4, 4)  # from its mesh to its body
        self.own_middle = bounds.mean(axis=0)  # of the mesh's bounding box
        half = self.half = (bounds[1] - bounds[0]) / 2.0
        self.radius = float(np.linalg.norm(np.abs(self.matrix[:3, :3]) @ half))
        self.mirrored = bool(np.linalg.det(self.matrix[:3, :3]) < 0.0)
        self.transparent = part.appearance.alpha < 1.0
        self.casts_shadow = part.casts_shadow and not self.transparent
        self._depth, self._shadow = (
            context.vertex_array(program, [(buffer, '3f 5x4', 'position')])
            for program in (placed.depth, placed.shadow)
        )
        self._image = image
        self._context, self._buffer = context, buffer
        self._surfaces: dict[ShaderVariant, tuple[moderngl.VertexArray, Any]] = {}  # with uniforms
        self._normals = np.linalg.inv(self.matrix[:3, :3]).T  # transform of normals

    def place(
        self, placement: NDArray[Any], turn: NDArray[Any], middle: NDArray[Any], low: float
    ) -> None:
        """Update the placement for a picture; see `Placements`.

        Args:
            placement: transform (4, 4) to the world.
            turn: rotation (3, 3) of its body.
            middle: of its bounding box, in the world [m].
            low: height of its lowest point [m].
        """
        self._turn, self.middle, self.low = turn, middle, low
        self._axes = placement[:3, :3]
        self._placed: NDArray[Any] | bytes = placement

    @property
    def _placement(self) -> bytes:
        if not isinstance(self._placed, bytes):
            self._placed = gl_matrix(self._placed)
        return self._placed

    @property
    def plane(self) -> tuple[NDArray[Any], NDArray[Any]] | None:
        """Return a point and the normal, if it is ground: flat, opaque and without a shadow."""
        flat = int(np.argmin(self.half))
        if self.part.casts_shadow or self.transparent or self.half[flat] > 0.0:
            return None
        return self.middle, self._axes[:, flat] / np.linalg.norm(self._axes[:, flat])

    @property
    def arms(self) -> NDArray[Any]:
        """Return the ways (3, 3) [m] from its middle to three sides of a box; see `Caster`."""
        return np.asarray(self._axes * (self.half + _BLUR / np.linalg.norm(self._axes, axis=0)))

    def draw(self, variant: ShaderVariant, program: moderngl.Program) -> None:
        """Draw the surface in its colours."""
        if variant not in self._surfaces:
            used = [name for name in LAYOUT if name in program]
            layout = ' '.join(
                f'{size}f' if name in used else f'{size}x4' for name, size in LAYOUT.items()
            )
            self._surfaces[variant] = (
                self._context.vertex_array(program, [(self._buffer, layout, *used)]),
                _uniforms(program, self.part.appearance),
            )
        array, uniforms = self._surfaces[variant]
        uniform(program, 'placement').write(self._placement)
        if 'normal_placement' in program:
            uniform(program, 'normal_placement').write(gl_matrix(self._turn @ self._normals))
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


class Placements:
    """The drawables of a scene, which are placed all at once for each picture."""

    def __init__(self, drawables: Sequence[Drawable]) -> None:
        self.drawables = drawables
        self._bodies = [one.part.body for one in drawables]
        self._matrices = np.array([one.matrix for one in drawables]).reshape(-1, 4, 4)
        self._middles = np.array([one.own_middle for one in drawables]).reshape(-1, 3, 1)
        self._halves = np.array([one.half for one in drawables]).reshape(-1, 1, 3)

    def place(self, frame: Frame) -> None:
        """Place the drawables for a picture, and find those that it may see."""
        bodies = frame.bodies[self._bodies]
        placed = bodies @ self._matrices
        middles = (placed[:, :3, :3] @ self._middles)[:, :, 0] + placed[:, :3, 3]
        arms = placed[:, :3, :3] * self._halves
        lows = middles[:, 2] - np.abs(arms[:, 2]).sum(axis=1)
        for one, *where in zip(
            self.drawables, placed, bodies[:, :3, :3], middles, lows.tolist(), strict=True
        ):
            one.place(*where)
        seen = np.flatnonzero(frame.sees(middles, arms))
        frame.visible = [self.drawables[number] for number in seen.tolist()]


@lru_cache(maxsize=4096)
def _appearance_values(appearance: Appearance) -> dict[str, bytes]:
    values = {
        'ambient': appearance.ambient,
        'diffuse': (*appearance.diffuse, appearance.alpha),
        'specular': (*appearance.specular, appearance.shininess),
        'emissive': appearance.emissive,
        'lit': (float(appearance.lit),),
    }
    return {name: np.array(value, 'f4').tobytes() for name, value in values.items()}


def _uniforms(
    program: moderngl.Program, appearance: Appearance
) -> list[tuple[moderngl.Uniform, bytes]]:
    values = _appearance_values(appearance)
    return [(uniform(program, name), value) for name, value in values.items() if name in program]


def gl_matrix(matrix: NDArray[Any]) -> bytes:
    """Return a matrix for OpenGL: column-major, float32."""
    return matrix.T.astype('f4').tobytes()
