"""The parts of a scene on the GPU, and the frame in which they are drawn."""

from functools import lru_cache
from typing import Any

import moderngl
import numpy as np
from numpy.typing import NDArray

from .shaders import DEPTH_FRAGMENT, NOTHING_FRAGMENT, PLACED_VERTEX, ShaderVariant
from .shadows import Sweeps, uniform
from .values import Appearance, Lens, ScenePart

_BLUR = 0.1  # [m] by which shadow maps may widen shadows
_CORNERS = np.stack(np.meshgrid(*[(-1.0, 1.0)] * 3), axis=-1).reshape(8, 3)  # of a cube
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
        self.shadows: dict[str, Sweeps] = {}  # by map
        self.prepared: set[ShaderVariant] = set()  # whose programs are set for this picture

    def may_see(self, drawable: 'Drawable') -> bool:
        """Tell whether a drawable's bounding sphere reaches into the view frustum."""
        return bool((self.planes[:, :3] @ drawable.middle + self.planes[:, 3]
                     > -drawable.radius).all())

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
        self.shadow = context.program(
            vertex_shader=PLACED_VERTEX, fragment_shader=NOTHING_FRAGMENT)


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

    def place(self, frame: Frame) -> None:
        """Update the placement for a picture."""
        body = frame.bodies[self.part.body]
        placement = body @ self._matrix
        self._turn = body[:3, :3]
        self.middle = placement[:3, :3] @ self._middle + placement[:3, 3]
        self.low = float(self.middle[2] - np.abs(placement[2, :3]) @ self._half)  # [m]
        self._placement = gl_matrix(placement)
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
            used = [name for name in LAYOUT if name in program]
            layout = ' '.join(f'{size}f' if name in used else f'{size}x4'
                              for name, size in LAYOUT.items())
            self._surfaces[variant] = (
                self._context.vertex_array(program, [(self._buffer, layout, *used)]),
                _uniforms(program, self.part.appearance))
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


def gl_matrix(matrix: NDArray[Any]) -> bytes:
    """Return a matrix for OpenGL: column-major, float32."""
    return matrix.T.astype('f4').tobytes()
