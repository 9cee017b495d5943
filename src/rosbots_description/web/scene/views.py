"""Buttons and keys that turn the camera of a browser to everything, or to what is selected."""

import math
import time
from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
import viser
from viser import Icon

from ...sim.core import Vector, as_vector
from ...sim.description import ShownLink
from ..controls import Allow, Panel
from .bounds import corners
from .selection import Selection
from .start_view import StartView

ROOM = 1.1  # around what is looked at
SMALLEST = 0.2  # radius of what is looked at [m]: nearer, nobody knows where one is
STEEP = 1e-3  # of a view from the top: straight down, no direction of the picture would be up
TOP, FRONT = (-STEEP, 0.0, 1.0), (1.0, 0.0, 0.25)  # from what is looked at to the eye
DOUBLE = 0.4  # [s, wall] from the first click of a double click to the second, at most


class ViewPanel(Panel):
    """The view of a browser: as at first, from the top, from ahead, or as it is, but nearer."""

    def __init__(
        self,
        client: viser.ClientHandle,
        selection: Selection,
        start: StartView,
        order: float,
        allow_viewers: Allow,
    ) -> None:
        self._camera, self._selection = client.camera, selection
        self._clicked = ('', -math.inf)  # last: model, and when [s, monotonic]
        looks: dict[str, tuple[viser.IconName, str, Callable[[viser.CameraHandle], None]]] = {
            'Home': (Icon.HOME, 'H', lambda camera: look(camera, *start.choose(camera.aspect))),
            'Top': (Icon.BOX_ALIGN_TOP, 'T', partial(self._fit, self._all_links, TOP)),
            'Front': (Icon.BOX_ALIGN_BOTTOM, 'F', partial(self._fit, self._all_links, FRONT)),
            'Fit all': (Icon.ARROWS_MAXIMIZE, 'X', partial(self._fit, self._all_links, None)),
            'Go to selection': (Icon.FOCUS_2, 'G', self._go_to_selection),
        }
        for name, (icon, key, turn) in looks.items():
            button = client.gui.add_button(name, icon=icon, order=order)
            button.on_click(partial(_turn, turn))
            command = client.gui.add_command(f'View: {name}', hotkey=key)  # type: ignore[arg-type]  # any
            command.on_trigger(partial(_turn, turn))
            allow_viewers(button, command)

    def click(self, model: str, link: str) -> None:
        """Select what the browser clicked on; the second click of two goes there."""
        last, moment = self._clicked
        self._clicked = model, time.monotonic()
        if last == model and self._clicked[1] - moment < DOUBLE:
            with self._camera.client.atomic():
                self._go_to_selection(self._camera)
        else:
            self._selection.click(model, link)

    def _all_links(self) -> list[ShownLink]:
        return [link for model in self._selection.models.all.values() for link in model.links]

    def _go_to_selection(self, camera: viser.CameraHandle) -> None:
        self._fit(lambda: self._selection.links, None, camera)

    def _fit(
        self,
        links: Callable[[], list[ShownLink]],
        direction: Vector | None,
        camera: viser.CameraHandle,
    ) -> None:
        """Look at links from a direction, None for the present one; not at nothing."""
        pose = self._selection.models.link_pose
        points = [corner for link in links() for corner in corners(link.visuals, pose(link))]
        if not points:
            return
        low, high = np.min(points, axis=0), np.max(points, axis=0)
        middle = (low + high) / 2.0
        radius = max(float(np.linalg.norm(high - low)) / 2.0, SMALLEST)
        way = np.asarray(direction or camera.position - camera.look_at)
        narrow = min(math.tan(camera.fov / 2.0), math.tan(camera.fov / 2.0) * camera.aspect)
        far = ROOM * radius / math.sin(math.atan(narrow))
        look(
            camera,
            as_vector(middle + far * way / max(float(np.linalg.norm(way)), 1e-9)),
            as_vector(middle),
        )


def look(camera: viser.CameraHandle, eye: Vector, target: Vector) -> None:
    """Move a camera to a point, and turn it to another."""
    camera.position, camera.look_at = eye, target  # viser moves the second along with the first


def _turn(
    turn: Callable[[viser.CameraHandle], None], event: viser.GuiEvent[Any] | viser.CommandEvent
) -> None:
    if event.client is not None:
        with event.client.atomic():
            turn(event.client.camera)
