"""A joystick for fingers and mouse: a pad in a corner of a browser's picture."""

import math
import threading
from collections.abc import Callable
from dataclasses import dataclass

import viser

from ...sim.core import Pose, Vector, compose, inverse
from ..controls import Panel, Ticker
from ..scene import place

PERIOD = 0.1  # [s, wall] between two commands while it is held
DEPTH = 0.3  # [m] of the pad ahead of the camera
RADIUS, KNOB, CORNER = 0.12, 0.05, 0.16  # parts of the picture's height; CORNER to both its edges
ABOVE_SHEET = 0.08  # further up, in parts of the height, where it is upright: on a phone
THICKNESS = 0.001  # [m] of discs: they face the camera, and so are round also in a corner
NODE = '/joystick'


@dataclass
class _Pad:
    frame: viser.FrameHandle
    knob: viser.CylinderHandle
    radius: float  # [m]


class Joystick(Panel):
    """A pad while the box is checked. Its knob returns when it is let go."""

    def __init__(self, client: viser.ClientHandle, steer: Callable[[float, float], None]) -> None:
        """Add the box; `steer` gets ahead and left, -1 to 1, again and again while it is held."""
        self._client, self._steer = client, steer
        self._lock = threading.RLock()
        self._ticker = Ticker(PERIOD, self._tick)
        self._pad: _Pad | None = None
        self._held: tuple[float, float] | None = None
        self._box = client.gui.add_checkbox(
            'Joystick', initial_value=False, hint='a pad in the picture, for a finger or the mouse'
        )
        self._box.on_update(lambda _: self._switch())
        client.camera.on_update(self._follow)

    def close(self) -> None:
        """Let go."""
        with self._lock:
            self._held = None

    def _switch(self) -> None:
        """Show the pad, or hide it."""
        with self._lock:
            if self._box.value and self._pad is None:
                self._add()
            elif self._pad is not None and not self._box.value:
                self._pad.frame.remove()
                self._pad = self._held = None

    def _add(self) -> None:
        client = self._client
        scene, height = client.scene, 2.0 * DEPTH * math.tan(client.camera.fov / 2.0)
        with client.atomic():  # what is pressed before it can be dragged would turn the camera
            frame = scene.add_frame(NODE, show_axes=False)
            base = scene.add_cylinder(
                f'{NODE}/pad',
                RADIUS * height,
                THICKNESS,
                (120, 120, 120),
                opacity=0.4,
                cast_shadow=False,
                receive_shadow=False,
                side='double',
            )
            knob = scene.add_cylinder(
                f'{NODE}/knob',
                KNOB * height,
                3.0 * THICKNESS,
                (40, 90, 255),
                cast_shadow=False,
                receive_shadow=False,
            )
            pad = self._pad = _Pad(frame, knob, RADIUS * height)
            place(frame, corner(client.camera))

            async def drag(event: viser.SceneNodeDragEvent[viser.CylinderHandle]) -> None:
                self._drag(event, pad)  # not in threads, which would change the order

            for disc in (base, knob):
                disc.on_drag(drag)

    def _follow(self, camera: viser.CameraHandle) -> None:
        """Keep the pad in its corner."""
        with self._lock:
            if self._pad is not None:
                place(self._pad.frame, corner(camera))

    def _drag(self, event: viser.SceneNodeDragEvent[viser.CylinderHandle], pad: _Pad) -> None:
        with self._lock:
            is_there = self._pad is pad  # a drag goes on when its pad was removed
            if event.phase == 'end' or not is_there:
                self._held = None
                if is_there:
                    pad.knob.position = (0.0, 0.0, 0.0)
                return
            camera = event.client.camera
            across, along, ahead = compose(
                inverse(_pose(camera)), Pose(event.end_position)
            ).position
            middle = _corner(camera)  # the pointer is nearer than the pad, at the knob's surface
            right = across * DEPTH / ahead - middle[0]
            down = along * DEPTH / ahead - middle[1]
            reach = max(math.hypot(right, down), pad.radius)
            right, down = right / reach, down / reach
            pad.knob.position = (right * pad.radius, down * pad.radius, 0.0)
            self._held = -down, -right
            self._ticker.run(True)

    def _tick(self) -> None:
        with self._lock:
            held = self._held
            if held is None:
                self._ticker.run(False)
        self._steer(*(held or (0.0, 0.0)))


def corner(camera: viser.CameraHandle) -> Pose:
    """Return the pose in the world of a pad at the lower left, with the axes of the camera."""
    return compose(_pose(camera), Pose(_corner(camera)))


def _corner(camera: viser.CameraHandle) -> Vector:
    """Return its position in the frame of the camera: x right, y down, z ahead [m]."""
    half = DEPTH * math.tan(camera.fov / 2.0)
    low = CORNER + (ABOVE_SHEET if camera.aspect < 1.0 else 0.0)
    return half * (2.0 * CORNER - camera.aspect), half * (1.0 - 2.0 * low), DEPTH


def _pose(camera: viser.CameraHandle) -> Pose:
    w, x, y, z = map(float, camera.wxyz)
    px, py, pz = map(float, camera.position)
    return Pose((px, py, pz), (x, y, z, w))
