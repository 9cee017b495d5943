"""Keeps the cameras of browsers above the ground."""

import threading
from typing import NamedTuple
from weakref import WeakKeyDictionary

import numpy as np
import viser

from ...sim.core import Vector, compose, rotate
from ...sim.description import Plane, SceneChange
from ..controls import Panel
from .models import Models
from .views import look

CLEARANCE = 0.05  # [m] of an eye above the ground
UPWARDS = 0.9  # z of a normal that faces upwards
NEAR = 1e-2  # [m] from an eye that a browser was told to the one that it reports
TOLERANCE = 1e-3  # [m] of an eye that was put there: browsers round


class FirstView(NamedTuple):
    """What a browser was told when it came."""

    eye: Vector  # in the world [m]
    target: Vector
    told: float  # when viser's camera got it [s, wall]


class Ground(Panel):
    """Lifts a camera that its browser has moved below the lowest ground, if there is one."""

    def __init__(self, models: Models) -> None:
        self._models = models
        self._lowest: float | None = None  # height of an eye [m]
        # Those that browsers have not reported yet.
        self._expected: WeakKeyDictionary[viser.ClientHandle, FirstView] = WeakKeyDictionary()
        self._lock = threading.Lock()  # viser reports several views at once, in threads

    def begin(self, client: viser.ClientHandle, eye: Vector, target: Vector) -> None:
        """Tell a browser its first view, and watch it; what it reports before is not its own.

        Args:
            client: the browser.
            eye, target: of the view, in the world [m].
        """
        with self._lock:
            client.camera.on_update(self._lift)
            self._tell(client.camera, eye, target)

    def apply(self, _change: SceneChange) -> None:
        """Look for grounds: planes that face upwards."""
        heights = []
        for model in self._models.all.values():
            for link in model.links:
                for visual in link.visuals:
                    if isinstance(visual.geometry, Plane):
                        pose = compose(self._models.link_pose(link), visual.pose)
                        if rotate(pose.orientation, visual.geometry.normal)[2] > UPWARDS:
                            heights.append(pose.position[2])
        self._lowest = min(heights) + CLEARANCE if heights else None

    def _lift(self, camera: viser.CameraHandle) -> None:
        with self._lock:  # else an old report, looked at late, would move it from a newer view
            first = self._expected.get(camera.client)
            if first is not None and camera.update_timestamp == first.told:
                return  # viser has what the browser was told, not yet what it reports
            x, y, z = map(float, camera.position)
            lowest = self._lowest
            is_below = lowest is not None and z < lowest - TOLERANCE
            if first is not None:
                if np.allclose((x, y, z), first.eye, atol=NEAR):
                    self._expected.pop(camera.client, None)
                elif is_below:
                    self._tell(camera, first.eye, first.target)
            elif lowest is not None and is_below:
                tx, ty, tz = map(float, camera.look_at)
                if (tx, ty) == (x, y):
                    tz = lowest - 1.0  # straight ahead would be nowhere
                with camera.client.atomic():
                    look(camera, (x, y, lowest), (tx, ty, tz))

    def _tell(self, camera: viser.CameraHandle, eye: Vector, target: Vector) -> None:
        """Tell a first view, and expect it to be reported if it is another than the present one."""
        before = camera.update_timestamp
        with camera.client.atomic():
            look(camera, eye, target)
        if camera.update_timestamp != before:
            self._expected[camera.client] = FirstView(eye, target, camera.update_timestamp)
