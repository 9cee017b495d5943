"""Clicks on the ground, for what has asked a browser for one."""

import threading
from collections.abc import Callable

import viser

from ...sim.core import Vector
from ..controls import show_notice

FAR = 100.0  # [m] from the eye, up to which a click is on the ground
MARK = '/clicked'

Receive = Callable[[viser.ClientHandle, Vector], None]


class GroundClicks:
    """The next click of a browser goes to whoever asked it last; one click for each question."""

    def __init__(self, site: viser.ViserServer) -> None:
        self._scene = site.scene
        self._lock = threading.Lock()
        self._asked: dict[int, Receive] = {}  # by the numbers of browsers
        self._marks: dict[int, viser.IcosphereHandle] = {}
        site.on_client_disconnect(self._forget)

    def ask(self, client: viser.ClientHandle, sentence: str, receive: Receive) -> None:
        """Ask a browser for a click, and let it know; `receive` gets the point [m], z = 0."""
        with self._lock:
            if client.client_id not in self._asked:
                client.scene.on_click()(self._click)  # sent before the sentence, by its own scene
            self._asked[client.client_id] = receive
        show_notice(client, sentence)

    def mark(self, client: viser.ClientHandle, point: Vector) -> None:
        """Show a point in the scene [m], instead of that browser's last one."""
        number = client.client_id
        self._marks[number] = self._scene.add_icosphere(
            f'{MARK}/{number}', 0.05, color=(255, 140, 0), position=point, cast_shadow=False
        )

    def unmark(self, client: viser.ClientHandle) -> None:
        """Show a browser's point no more."""
        mark = self._marks.pop(client.client_id, None)
        if mark is not None:
            mark.remove()

    def _forget(self, client: viser.ClientHandle) -> None:
        self.unmark(client)
        with self._lock:
            self._asked.pop(client.client_id, None)

    def _click(self, event: viser.SceneClickEvent) -> None:
        point = on_ground(event.ray_origin, event.ray_direction)
        if point is None:
            show_notice(event.client, 'That is not on the ground; click again, lower.')
            return
        with self._lock:
            receive = self._asked.pop(event.client_id, None)
            if receive is not None:
                event.client.scene.remove_click_callback(self._click)
        if receive is not None:
            receive(event.client, point)


def on_ground(eye: Vector, direction: Vector) -> Vector | None:
    """Return where a ray meets the plane z = 0 [m]; None if it does not, or far away."""
    if eye[2] * direction[2] >= 0.0:
        return None
    way = -eye[2] / direction[2]
    if way > FAR:
        return None
    return (eye[0] + way * direction[0], eye[1] + way * direction[1], 0.0)
