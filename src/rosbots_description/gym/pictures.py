"""Pictures of a world for those who watch, from above and beside its robot."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..sim import Model, SimError, World
from ..sim.rendering import OVERVIEW, ImageCapture, RenderError, Wants, look_at

_EYE = (-2.2, -2.8, 3.2)  # [m] from the robot


class Pictures:
    """Pictures of a robot in its world, by a process that starts with the first of them."""

    def __init__(self, world: World, robot: Model) -> None:
        self._capture, self._robot = ImageCapture(world), robot

    def take(self) -> NDArray[np.uint8]:
        """Return a picture (height, width, 3).

        Raises:
            SimError: nothing can be drawn on this machine; the message says why.
        """
        x, y, z = self._robot.pose.position
        eye = (x + _EYE[0], y + _EYE[1], z + _EYE[2])
        try:
            self._capture.request([(OVERVIEW, look_at(eye, (x, y, z)))], 0, Wants())
            taken = self._capture.receive_image(wait=True)
        except RenderError as error:
            raise SimError(f'there is no picture: {error}') from None
        pixels: Any = taken[0].pixels if taken else None
        return np.array(pixels)
