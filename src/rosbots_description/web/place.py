"""Where on the ground a browser wants something new."""

import viser

from ..sim.core import Vector
from .ground_clicks import GroundClicks


class Places:
    """A place for each browser: what it last clicked on, once; else what its camera looks at."""

    def __init__(self, site: viser.ViserServer, clicks: GroundClicks) -> None:
        self._clicks = clicks
        self._chosen: dict[int, Vector] = {}  # by the numbers of browsers
        site.on_client_disconnect(self._forget)

    def choose(self, client: viser.ClientHandle) -> None:
        """Let the next click of a browser choose its place."""
        self._clicks.ask(
            client, 'Click on the ground where the next model is to appear.', self._keep
        )

    def take(self, client: viser.ClientHandle) -> Vector:
        """Return the place of a browser [m]; one that was clicked on serves once."""
        chosen = self._chosen.pop(client.client_id, None)
        if chosen is not None:
            self._clicks.unmark(client)
            return chosen
        x, y, _ = client.camera.look_at
        return (float(x), float(y), 0.0)

    def _forget(self, client: viser.ClientHandle) -> None:
        self._chosen.pop(client.client_id, None)

    def _keep(self, client: viser.ClientHandle, point: Vector) -> None:
        self._chosen[client.client_id] = point
        self._clicks.mark(client, point)
