"""Cameras that follow a model."""

import numpy as np
import viser

from ..sim.description import ShownMotion
from .models import Models
from .panel import Panel
from .selection import Selection

MOVED = 1e-3  # [m] less is not followed, so that a resting model leaves the mouse alone


class FollowPanel(Panel):
    """A box to check: the view of each browser then looks at the selected model.

    Turning and zooming stay with the person: only the point that is looked at is given, and the
    camera keeps the offset from it that it reports.
    """

    def __init__(self, site: viser.ViserServer, models: Models, selection: Selection) -> None:
        self._site, self._models, self._selection = site, models, selection
        self._followed: str | None = None
        self._at = np.full(3, np.inf)  # where the cameras look [m]
        self._box = site.gui.add_checkbox('Follow', False, hint='with the camera')

    def move(self, _motion: ShownMotion) -> None:
        """Move the cameras along."""
        model = self._selection.model if self._box.value else None
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
