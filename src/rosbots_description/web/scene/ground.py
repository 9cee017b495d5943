"""Keeps the cameras of browsers above the ground."""

import threading
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


class Ground(Panel):
    """Lifts a camera that its browser has moved below the lowest ground, if there is one."""

    def __init__(self, models: Models) -> None:
        self._models = models
        self._lowest: float | None = None  # height of an eye [m]
        # First views that browsers have not reported yet: eye and target [m].
        self._expected: WeakKeyDictionary[viser.ClientHandle, tuple[Vector, Vector]] = (
            WeakKeyDictionary()
        )
        self._lock = threading.Lock()  # viser reports several views at once, in threads

    def watch(self, client: viser.ClientHandle, eye: Vector, target: Vector) -> None:
        """Watch a browser from its first view on; what it reports before is not its own.

        Args:
            client: the browser.
            eye, target: of the view that it is told now, in the world [m].
        """
        with self._lock:
            self._expected[client] = eye, target
        client.camera.on_update(self._lift)

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
            x, y, z = map(float, camera.position)
            lowest = self._lowest
            is_below = lowest is not None and z < lowest - TOLERANCE
            first = self._expected.get(camera.client)
            if first is not None:
                if np.allclose(camera.position, first[0], atol=NEAR):
                    self._expected.pop(camera.client, None)
                elif is_below:
                    with camera.client.atomic():
                        look(camera, *first)
            elif lowest is not None and is_below:
                tx, ty, tz = map(float, camera.look_at)
                if (tx, ty) == (x, y):
                    tz = lowest - 1.0  # straight ahead would be nowhere
                with camera.client.atomic():
                    look(camera, (x, y, lowest), (tx, ty, tz))
