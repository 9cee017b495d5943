"""Where on the ground a browser wants something new."""

import viser

from ..sim.core import Vector
from .notices import show

FAR = 100.0  # [m] from the eye, up to which a click chooses a place
MARK = '/place'


class Places:
    """A place for each browser: what it last clicked on, once; else what its camera looks at."""

    def __init__(self, scene: viser.SceneApi) -> None:
        self._scene = scene
        self._choosing: set[int] = set()  # the numbers of browsers
        self._chosen: dict[int, Vector] = {}

    def choose(self, client: viser.ClientHandle | None) -> None:
        """Let the next click of a browser choose its place."""
        if client is not None:
            if not self._choosing:
                self._scene.on_click()(self._click)
            self._choosing.add(client.client_id)
            show(client, 'Click on the ground where the next model is to appear.')

    def take(self, client: viser.ClientHandle | None) -> Vector:
        """Return the place of a browser [m]; one that was clicked on serves once."""
        if client is None:
            return (0.0, 0.0, 0.0)
        chosen = self._chosen.pop(client.client_id, None)
        if chosen is not None:
            self._scene.remove_by_name(f'{MARK}/{client.client_id}')
            return chosen
        x, y, _ = client.camera.look_at
        return (float(x), float(y), 0.0)

    def forget(self, client: viser.ClientHandle) -> None:
        """Forget a browser that has disconnected."""
        self._stop(client.client_id)
        if self._chosen.pop(client.client_id, None) is not None:
            self._scene.remove_by_name(f'{MARK}/{client.client_id}')

    def _click(self, event: viser.SceneClickEvent) -> None:
        if event.client_id not in self._choosing:
            return
        place = on_ground(event.ray_origin, event.ray_direction)
        if place is None:
            show(event.client, 'That is not on the ground; click again, lower.')
            return
        self._stop(event.client_id)
        self._chosen[event.client_id] = place
        self._scene.add_icosphere(f'{MARK}/{event.client_id}', 0.05, color=(255, 140, 0),
                                  position=place, cast_shadow=False)

    def _stop(self, client: int) -> None:
        if client in self._choosing:
            self._choosing.discard(client)
            if not self._choosing:
                self._scene.remove_click_callback(self._click)


def on_ground(eye: Vector, direction: Vector) -> Vector | None:
    """Return where a ray meets the plane z = 0 [m]; None if it does not, or far away."""
    if eye[2] * direction[2] >= 0.0:
        return None
    way = -eye[2] / direction[2]
    if way > FAR:
        return None
    return (eye[0] + way * direction[0], eye[1] + way * direction[1], 0.0)
