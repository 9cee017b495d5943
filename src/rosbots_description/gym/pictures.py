"""Pictures of a world for people, from above and beside its robot."""

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ..sim import Model, SimError, World
from ..sim.rendering import Figure, Illustrator, RenderError, look_at

_EYE = (-2.2, -2.8, 3.2)  # [m] from what it looks at
_SHOWN = 1.5  # [m] from there, what it shows in any direction on the ground


class Pictures:
    """Pictures of a robot in its world, by a process that starts with the first of them."""

    def __init__(self, world: World, robot: Model) -> None:
        self._illustrator, self._robot = Illustrator(world), robot

    def take(self, figures: Sequence[Figure] = ()) -> NDArray[np.uint8]:
        """Return a picture (height, width, 3) of the robot and of the figures that are in view.

        Raises:
            SimError: nothing can be drawn on this machine; the message says why.
        """
        x, y, z = self._robot.pose.position
        seen = [(x, y), *(one.pose.position[:2] for one in figures if one.in_view)]
        (left, low), (right, high) = (tuple(map(end, *seen, seen[0])) for end in (min, max))
        middle = ((left + right) / 2.0, (low + high) / 2.0, z)
        reach = math.dist((left, low), (right, high)) / 2.0
        away = max(1.0, (reach + _SHOWN / 2.0) / _SHOWN)
        eye = tuple(at + away * way for at, way in zip(middle, _EYE, strict=True))
        try:
            return self._illustrator.take(
                look_at((eye[0], eye[1], eye[2]), middle), middle, figures
            )
        except RenderError as error:
            raise SimError(f'there is no picture: {error}') from None
