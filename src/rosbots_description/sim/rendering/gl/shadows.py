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

STILL_SIZE, MOVING_SIZE = 2048, 1024  # texels along an edge
_ROOM = 1.25  # size of the map of still bodies, relative to the view
_CELL = 2.0 * (_ROOM - 1.0) / 3.0**0.5  # relative edge of the cells that share a map
_MAX_MAPS = 4  # of still bodies, for cameras of different views


def uniform(program: moderngl.Program, name: str) -> moderngl.Uniform:
    """Return a uniform of a program."""
    return cast(moderngl.Uniform, program[name])


class Caster(Protocol):
    """A shadow caster."""

    middle: NDArray[Any]
    radius: float

    def draw_shadow(self) -> None:
        """Draw it into the shadow map."""


class Shadows:
    """The shadow maps of one light."""

    def __init__(
        self, context: moderngl.Context, program: moderngl.Program, direction: NDArray[Any]
    ) -> None:
        self._context = context
        self._program = program
        self.direction = direction
        self._axes = light_axes(direction)
        self._moving = _Map(context, MOVING_SIZE)
        self._still: dict[float, _Map] = {}  # by the radius of the view's bounding sphere
        self.move = False  # whether a moving shadow may be visible
        self._used: tuple[_Map, _Map] = self._moving, self._moving

    def release(self) -> None:
        """Free the maps."""
        for one in (self._moving, *self._still.values()):
            one.release()

    def forget(self) -> None:
        """Invalidate the maps of still bodies after one was moved."""
        for one in self._still.values():
            one.place = None

    def draw(
        self, eye: NDArray[Any], lens: Lens, still: Sequence[Caster], moving: Sequence[Caster]
    ) -> None:
        """Update the maps for a camera's picture."""
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
        self.move = bool(near)
        if near:
            self._moving.draw(self._program, self._axes, *_bounding_sphere(near), near)
        self._used = still_map, self._moving

    def use(self, program: moderngl.Program) -> None:
        """Bind the maps to a program."""
        for unit, (name, one) in enumerate(zip(('still', 'moving'), self._used, strict=True), 1):
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
