"""A camera that follows a model."""

import numpy as np
import viser

from ...sim.description import ShownMotion
from ..controls import Allow, Panel
from .selection import Selection

FOLLOW, STOP = 'Follow the selection', 'Stop following'
MOVED = 1e-3  # [m] less is not followed, so that a resting model leaves the mouse alone


class FollowPanel(Panel):
    """A button: the view of a browser looks at its selected model until it is pressed again.

    Turning and zooming stay with the person: only the point that is looked at is given, and the
    camera keeps the offset from it that it reports.
    """

    def __init__(
        self, client: viser.ClientHandle, selection: Selection, order: float, allow_viewers: Allow
    ) -> None:
        self._client, self._selection = client, selection
        self._followed: str | None = None
        self._at = np.full(3, np.inf)  # where the camera looks [m]
        self._follows = False
        self._button = client.gui.add_button(FOLLOW, icon=viser.Icon.VIDEO, order=order)
        self._button.on_click(lambda _: self._toggle())
        command = client.gui.add_command('View: follow the selection', hotkey='V')
        command.on_trigger(lambda _: self._toggle())
        allow_viewers(self._button, command)

    def move(self, _motion: ShownMotion) -> None:
        """Move the camera along."""
        model = self._selection.model if self._follows else None
        if model != self._followed:
            self._followed, self._at = model, np.full(3, np.inf)
        if model is None:
            return
        at = np.array(self._selection.models.pose(model).position)
        if np.linalg.norm(at - self._at) > MOVED:
            self._at = at
            with self._client.atomic():
                # Viser moves the point that is looked at along with the camera.
                camera = self._client.camera
                camera.position = at + camera.position - camera.look_at
                camera.look_at = at

    def _toggle(self) -> None:
        self._follows = not self._follows
        self._button.label = STOP if self._follows else FOLLOW
        self._button.icon = viser.Icon.VIDEO_OFF if self._follows else viser.Icon.VIDEO
