"""Shadow maps of the sun: one of still bodies, drawn seldom, and one of moving bodies.

The map of still bodies covers more than the camera's view, so that it need not be redrawn whenever
the camera moves. The map of moving bodies is small and drawn for each picture. Their positions
depend only on the camera and the shadow casters, so that pictures are reproducible, whatever was
drawn before.
"""

from collections.abc import Sequence
from typing import Any, Protocol, cast

import moderngl
import numpy as np
from numpy.typing import NDArray

from .cameras import frustum_sphere, light_axes, shadow_view
from .values import Lens

STILL_SIZE = 2048  # texels along an edge
MOVING_SIZES = 64, 128, 256, 512, 1024
_FINE = 0.003  # [m] texel of a map of moving bodies; smaller ones are not worth their time
_ROOM = 1.25  # size of the map of still bodies, relative to the view
_CELL = 2.0 * (_ROOM - 1.0) / 3.0**0.5  # relative edge of the cells that share a map
_MAX_MAPS = 4  # of still bodies, for cameras of different views
_MAX_SHADOW_DISTANCE = 30.0  # [m] from its caster
_CLOSE = 0.01  # [m] along the optical axis
_GRAZING = 1e-3  # sine of an angle between light and plane
_MOST_RECTANGLES = 16


def uniform(program: moderngl.Program, name: str) -> moderngl.Uniform:
    """Return a uniform of a program."""
    return cast(moderngl.Uniform, program[name])


class Caster(Protocol):
    """A shadow caster."""

    middle: NDArray[Any]
    radius: float

    @property
    def corners(self) -> NDArray[Any]:
        """Return those of a box around it and its blurred edges (8, 3) [m]."""

    def draw_shadow(self) -> None:
        """Draw it into the shadow map."""


class Sweeps:
    """Where the shadows of casters fall: their bounding spheres, swept along the light."""

    def __init__(self, casters: Sequence[Caster], light: NDArray[Any], low: float) -> None:
        """Take casters, the light's direction, and the height below which there is nothing [m]."""
        self.casters = casters
        self._middles = np.array([one.middle for one in casters]).reshape(-1, 3)
        self._radii = np.array([one.radius for one in casters])
        lengths = np.full(len(casters), _MAX_SHADOW_DISTANCE)
        if light[2] < 0.0:
            lengths = np.minimum(lengths, (self._middles[:, 2] + self._radii - low) / -light[2])
        self._lengths, self._light = lengths, light

    def seen(self, planes: NDArray[Any]) -> list[Caster]:
        """Return the casters whose shadows reach into a view frustum of planes (n, 4)."""
        begin = self._middles @ planes[:, :3].T + planes[:, 3]
        end = begin + self._lengths[:, None] * (planes[:, :3] @ self._light)
        inside = (np.maximum(begin, end) > -self._radii[:, None]).all(axis=1)
        return [one for one, is_seen in zip(self.casters, inside, strict=True) if is_seen]

    def reach(self, middle: NDArray[Any], radius: float) -> bool:
        """Tell whether a shadow may fall into a sphere."""
        way = middle - self._middles
        along = np.clip(way @ self._light, 0.0, self._lengths)
        gaps = np.linalg.norm(way - along[:, None] * self._light, axis=1)
        return bool((gaps < self._radii + radius).any())

    def rectangles(
        self, plane: tuple[NDArray[Any], NDArray[Any]], view: NDArray[Any], size: tuple[int, int]
    ) -> list[tuple[int, int, int, int]]:
        """Return parts of a picture that hold all shadows on a plane: x, y, width, height [pixels].

        Args:
            plane: a point and the normal.
            view: matrix (4, 4) from the world to the picture.
            size: of the picture.
        """
        point, normal = plane
        slant = float(self._light @ normal)
        if abs(slant) < _GRAZING or len(self.casters) > _MOST_RECTANGLES:
            return [(0, 0, *size)]
        found = []
        for corners in (one.corners for one in self.casters):
            way = ((point - corners) @ normal) / slant
            shadow = (corners + way[:, None] * self._light) @ view[:, :3].T + view[:, 3]
            # Where an edge from one corner to another goes behind the camera, it ends there.
            depths = shadow[:, 3]
            before = depths > _CLOSE
            begin, end = np.nonzero(before[:, None] & ~before)
            share = (depths[begin] - _CLOSE) / (depths[begin] - depths[end])
            seen = np.concatenate([
                shadow[before],
                shadow[begin] + share[:, None] * (shadow[end] - shadow[begin])])
            if len(seen):
                pixels = (seen[:, :2] / seen[:, 3:] + 1.0) / 2.0 * size
                low = np.clip(np.floor(pixels.min(axis=0)), 0, size).astype(int)
                high = np.clip(np.ceil(pixels.max(axis=0)), 0, size).astype(int)
                if (high > low).all():
                    found.append((*low.tolist(), *(high - low).tolist()))
        return found


class Shadows:
    """The shadow maps of one light."""

    def __init__(
        self, context: moderngl.Context, program: moderngl.Program, direction: NDArray[Any]
    ) -> None:
        self._context = context
        self._program = program
        self.direction = direction
        self._axes = light_axes(direction)
        self._moving: dict[int, _Map] = {}  # by size
        self._still: dict[float, _Map] = {}  # by the radius of the view's bounding sphere
        self._used: dict[str, _Map] = {}

    def release(self) -> None:
        """Free the maps."""
        for one in (*self._moving.values(), *self._still.values()):
            one.release()

    def forget(self) -> None:
        """Invalidate the maps of still bodies after one was moved."""
        for one in self._still.values():
            one.place = None

    def draw(
        self, eye: NDArray[Any], lens: Lens, still: Sequence[Caster], moving: Sequence[Caster]
    ) -> list[Caster]:
        """Update the maps for a camera's picture; return the moving casters that matter to it."""
        middle, radius = frustum_sphere(eye, lens)
        if radius not in self._still:
            if len(self._still) == _MAX_MAPS:
                self._still.pop(next(iter(self._still))).release()
            self._still[radius] = _Map(self._context, STILL_SIZE)
        still_map = self._still[radius]
        cell = np.round(middle / (_CELL * radius))
        if still_map.place is None or (still_map.place != cell).any():
            still_map.place = cell
            still_map.draw(
                self._program, self._axes, cell * _CELL * radius, radius * _ROOM, still)
        near = [one for one in moving
                if np.linalg.norm(one.middle - middle) < radius + one.radius]
        self._used = {'still': still_map}
        if near:
            centre, reach = _bounding_sphere(near)
            size = next((size for size in MOVING_SIZES if 2.0 * reach < size * _FINE),
                        MOVING_SIZES[-1])
            if size not in self._moving:
                self._moving[size] = _Map(self._context, size)
            self._moving[size].draw(self._program, self._axes, centre, reach, near)
            self._used['moving'] = self._moving[size]
        return near

    def use(self, program: moderngl.Program) -> None:
        """Bind the maps to a program."""
        for unit, (name, one) in enumerate(self._used.items(), 1):
            if f'{name}_shadows' in program:
                one.texture.use(unit)
                program[f'{name}_shadows'] = unit
                uniform(program, f'{name}_view').write(one.view)
                program[f'{name}_texel'] = one.texel


def _bounding_sphere(casters: Sequence[Caster]) -> tuple[NDArray[Any], float]:
    """Return centre and radius of the bounding sphere of casters [m]."""
    middles = np.array([one.middle for one in casters])
    reach = np.array([one.radius for one in casters])[:, None]
    low, high = (middles - reach).min(axis=0), (middles + reach).max(axis=0)
    return (low + high) / 2.0, float(np.linalg.norm(high - low) / 2.0) * 1.02


class _Map:
    """A depth map seen from the light."""

    def __init__(self, context: moderngl.Context, size: int) -> None:
        self._context = context
        self.size = size
        self.texel = 1.0  # [m]
        self.place: NDArray[Any] | None = None
        self.view = np.zeros((4, 4), 'f4').tobytes()
        self.texture = context.depth_texture((size, size))
        self.texture.compare_func = '<='
        self.texture.repeat_x = self.texture.repeat_y = False
        self._buffer = context.framebuffer(depth_attachment=self.texture)

    def release(self) -> None:
        self._buffer.release()
        self.texture.release()

    def draw(
        self, program: moderngl.Program, axes: NDArray[Any], middle: NDArray[Any], radius: float,
        casters: Sequence[Caster],
    ) -> None:
        """Draw the casters of shadows into a bounding sphere."""
        self.texel = 2.0 * radius / self.size
        view = shadow_view(axes, middle, radius, self.texel)
        self.view = view.T.astype('f4').tobytes()
        self._buffer.use()
        self._buffer.clear(depth=1.0)
        self._context.enable_only(moderngl.DEPTH_TEST)
        uniform(program, 'view').write(self.view)
        for caster in casters:
            caster.draw_shadow()
