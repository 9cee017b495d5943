"""Cameras that follow a model."""

import numpy as np
import viser

from ..sim.description import ShownMotion
from .models import Models
from .panel import Panel
from .selection import Selection

FOLLOW, STOP = 'Follow the selection', 'Stop following'
MOVED = 1e-3  # [m] less is not followed, so that a resting model leaves the mouse alone


class FollowPanel(Panel):
    """A button: the view of each browser looks at the selected model until it is pressed again.

    Turning and zooming stay with the person: only the point that is looked at is given, and the
    camera keeps the offset from it that it reports.
    """

    def __init__(self, site: viser.ViserServer, models: Models, selection: Selection) -> None:
        self._site, self._models, self._selection = site, models, selection
        self._followed: str | None = None
        self._at = np.full(3, np.inf)  # where the cameras look [m]
        self._follows = False
        self._button = site.gui.add_button(FOLLOW, icon=viser.Icon.VIDEO)
        self._button.on_click(lambda _: self._toggle())
        site.gui.add_command('View: follow the selection', hotkey='V').on_trigger(
            lambda _: self._toggle()
        )

    def move(self, _motion: ShownMotion) -> None:
        """Move the cameras along."""
        model = self._selection.model if self._follows else None
        if model != self._followed:
            self._followed, self._at = model, np.full(3, np.inf)
        if model is None:
            return
        at = np.array(self._models.pose(model).position)
        if np.linalg.norm(at - self._at) > MOVED:
            self._at = at
            for client in self._site.get_clients().values():
                with client.atomic():
                    # Viser moves the point that is looked at along with the camera.
                    camera = client.camera
                    camera.position = at + camera.position - camera.look_at
                    camera.look_at = at

    def _toggle(self) -> None:
        self._follows = not self._follows
        self._button.label = STOP if self._follows else FOLLOW
        self._button.icon = viser.Icon.VIDEO_OFF if self._follows else viser.Icon.VIDEO
