"""Shadow maps of the sun: one of still bodies, drawn seldom, and one of moving bodies.

The map of still bodies covers more than the camera's view, so that it need not be redrawn whenever
the camera moves. The map of moving bodies is small and drawn for each picture. Their positions
depend only on the camera and the shadow casters, so that pictures are reproducible, whatever was
drawn before.
"""

from collections.abc import Sequence
from functools import cached_property
from typing import Any, Protocol, cast

import moderngl
import numpy as np
from numpy.typing import NDArray

from .cameras import box_reaches, frustum_sphere, light_axes, shadow_view, view_corners
from .values import Lens

STILL_SIZE = 2048  # texels along an edge
MOVING_SIZES = 64, 128, 256, 512, 1024
_FINE = 0.003  # [m] texel of a map of moving bodies; smaller ones are not worth their time
_ROOM = 1.25  # size of the map of still bodies, relative to the view
_CELL = 2.0 * (_ROOM - 1.0) / 3.0**0.5  # relative edge of the cells that share a map
_MAX_MAPS = 4  # of still bodies, for cameras of different views
_MAX_SHADOW_DISTANCE = 30.0  # [m] from its caster
_CLOSE = 0.01  # [m] along the optical axis
_CORNERS = np.stack(np.meshgrid(*[(-1.0, 1.0)] * 3), axis=-1).reshape(8, 3)  # of a cube
_GRAZING = 1e-3  # sine of an angle between light and plane
_MOST_RECTANGLES = 16
_MARGIN = 8  # [texels] beyond what is seen: surfaces read the map up to 6 texels beside them

Rectangles = list[tuple[int, int, int, int]]  # parts of a picture: x, y, width, height [pixels]


def uniform(program: moderngl.Program, name: str) -> moderngl.Uniform:
    """Return a uniform of a program."""
    return cast(moderngl.Uniform, program[name])


class Caster(Protocol):
    """A shadow caster."""

    middle: NDArray[Any]
    radius: float

    @property
    def arms(self) -> NDArray[Any]:
        """Return the ways (3, 3) [m], as columns, from the middle to three sides of a box.

        The box holds the caster, with room for the blurred edges of its shadow.
        """

    def draw_shadow(self) -> None:
        """Draw it into the shadow map."""


class Sweeps:
    """Where the shadows of casters fall: boxes or spheres around them, swept along the light."""

    def __init__(self, casters: Sequence[Caster], light: NDArray[Any], low: float) -> None:
        """Take casters, the light's direction, and the height below which there is nothing [m]."""
        self.casters = casters
        self._middles = np.array([one.middle for one in casters]).reshape(-1, 3)
        self._radii = np.array([one.radius for one in casters])
        lengths = np.full(len(casters), _MAX_SHADOW_DISTANCE)
        if light[2] < 0.0:
            lengths = np.minimum(lengths, (self._middles[:, 2] + self._radii - low) / -light[2])
        self._lengths, self._light = lengths, light

    @cached_property
    def _arms(self) -> NDArray[Any]:
        return np.array([one.arms for one in self.casters]).reshape(-1, 3, 3)

    def seen(self, planes: NDArray[Any]) -> list[Caster]:
        """Return the casters whose shadows reach into a view frustum of planes (n, 4)."""
        begin = self._middles @ planes[:, :3].T + planes[:, 3]
        end = begin + self._lengths[:, None] * (planes[:, :3] @ self._light)
        reaches = box_reaches(self._arms, planes[:, :3])
        inside = (np.maximum(begin, end) > -reaches).all(axis=1)
        return [one for one, is_seen in zip(self.casters, inside, strict=True) if is_seen]

    def reach(self, middles: NDArray[Any], radii: NDArray[Any]) -> NDArray[np.bool_]:
        """Tell into which spheres, (n, 3) and (n,) [m], a shadow may fall."""
        way = middles[:, None] - self._middles
        along = np.clip(way @ self._light, 0.0, self._lengths)
        gaps = np.linalg.norm(way - along[:, :, None] * self._light, axis=2)
        met: NDArray[np.bool_] = (gaps < self._radii + radii[:, None]).any(axis=1)
        return met

    def rectangles(
        self, plane: tuple[NDArray[Any], NDArray[Any]], view: NDArray[Any], size: tuple[int, int]
    ) -> Rectangles:
        """Return parts of a picture that hold all shadows on a plane.

        Args:
            plane: a point and the normal.
            view: matrix (4, 4) from the world to the picture.
            size: of the picture.
        """
        point, normal = plane
        slant = float(self._light @ normal)
        if abs(slant) < _GRAZING or len(self.casters) > _MOST_RECTANGLES:
            return [(0, 0, *size)]
        corners = self._middles[:, None] + _CORNERS @ self._arms.transpose(0, 2, 1)  # (c, 8, 3)
        way = ((point - corners) @ normal) / slant
        shadow = (corners + way[:, :, None] * self._light) @ view[:, :3].T + view[:, 3]
        # Where an edge from one corner to another goes behind the camera, it ends there.
        depths = shadow[:, :, 3]
        before = depths > _CLOSE
        if not before.all():
            ends = before[:, :, None] & ~before[:, None, :]
            share = (depths[:, :, None] - _CLOSE) / np.where(
                ends, depths[:, :, None] - depths[:, None, :], 1.0
            )
            between = shadow[:, :, None] + share[..., None] * (shadow[:, None] - shadow[:, :, None])
            shadow = np.concatenate([shadow, between.reshape(len(corners), -1, 4)], axis=1)
            before = np.concatenate([before, ends.reshape(len(corners), -1)], axis=1)
        depths = np.where(before, shadow[:, :, 3], 1.0)
        pixels = (shadow[:, :, :2] / depths[:, :, None] + 1.0) / 2.0 * size
        low, high = (
            np.clip(np.where(before[:, :, None], pixels, outside), 0, size)
            for outside in (np.inf, -np.inf)
        )
        least, most = np.floor(low.min(axis=1)), np.ceil(high.max(axis=1))
        return [
            (x, y, right - x, top - y)
            for (x, y), (right, top) in zip(
                least.astype(int).tolist(), most.astype(int).tolist(), strict=True
            )
            if right > x and top > y
        ]


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

    def near(self, eye: NDArray[Any], lens: Lens, moving: Sequence[Caster]) -> list[Caster]:
        """Return the moving casters that are near enough to a camera."""
        middle, radius = frustum_sphere(eye, lens)
        return [one for one in moving if np.linalg.norm(one.middle - middle) < radius + one.radius]

    def draw(
        self, eye: NDArray[Any], lens: Lens, still: Sequence[Caster], near: Sequence[Caster]
    ) -> None:
        """Update the maps of casters for a camera's picture; without casters, there is no map."""
        self._used = {}
        if still:
            self._used['still'] = self._draw_still(eye, lens, still)
        if near:
            self._used['moving'] = self._draw_moving(eye, lens, near)

    def _draw_still(self, eye: NDArray[Any], lens: Lens, still: Sequence[Caster]) -> '_Map':
        middle, radius = frustum_sphere(eye, lens)
        if radius not in self._still:
            if len(self._still) == _MAX_MAPS:
                self._still.pop(next(iter(self._still))).release()
            self._still[radius] = _Map(self._context, STILL_SIZE)
        still_map = self._still[radius]
        cell = np.round(middle / (_CELL * radius))
        if still_map.place is None or (still_map.place != cell).any():
            still_map.place = cell
            still_map.draw(self._program, self._axes, cell * _CELL * radius, radius * _ROOM, still)
        return still_map

    def _draw_moving(self, eye: NDArray[Any], lens: Lens, near: Sequence[Caster]) -> '_Map':
        centre, reach = _bounding_sphere(near)
        size = next((size for size in MOVING_SIZES if 2.0 * reach < size * _FINE), MOVING_SIZES[-1])
        if size not in self._moving:
            self._moving[size] = _Map(self._context, size)
        self._moving[size].draw(
            self._program, self._axes, centre, reach, near, view_corners(eye, lens)
        )
        return self._moving[size]

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
        self,
        program: moderngl.Program,
        axes: NDArray[Any],
        middle: NDArray[Any],
        radius: float,
        casters: Sequence[Caster],
        seen: NDArray[Any] | None = None,
    ) -> None:
        """Draw the casters of shadows into a bounding sphere.

        Args:
            seen: points (n, 3) [m]; what is outside their bounding box in the map, which no
                picture can show, is not drawn. None: all is drawn.
        """
        self.texel = 2.0 * radius / self.size
        view = shadow_view(axes, middle, radius, self.texel)
        self.view = view.T.astype('f4').tobytes()
        low, high = np.zeros(2), np.full(2, float(self.size))
        if seen is not None:
            places = self._texels(view, seen)
            low = np.maximum(low, np.floor(places.min(axis=0)) - _MARGIN)
            high = np.minimum(high, np.ceil(places.max(axis=0)) + _MARGIN)
            if (low >= high).any():
                return
            middles = self._texels(view, np.array([one.middle for one in casters]))
            reach = np.array([one.radius for one in casters])[:, None] / self.texel
            within = ((middles + reach > low) & (middles - reach < high)).all(axis=1)
            casters = [one for one, is_within in zip(casters, within, strict=True) if is_within]
        x, y, right, top = np.concatenate([low, high]).astype(int).tolist()
        self._buffer.use()
        self._buffer.scissor = x, y, right - x, top - y
        self._buffer.clear(depth=1.0)
        self._context.enable_only(moderngl.DEPTH_TEST)
        uniform(program, 'view').write(self.view)
        for caster in casters:
            caster.draw_shadow()

    def _texels(self, view: NDArray[Any], points: NDArray[Any]) -> NDArray[Any]:
        """Return where points (n, 3) [m] are in the map (n, 2) [texels]."""
        return np.asarray((points @ view[:2, :3].T + view[:2, 3] + 1.0) * (self.size / 2.0))
