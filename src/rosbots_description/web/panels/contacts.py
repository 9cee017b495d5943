"""The contacts in the world, and their forces, while a box is checked."""

import threading
from collections.abc import Callable, Sequence
from typing import Protocol

import numpy as np
import viser

from ...sim.description import ShownContact
from ..controls import Panel, fill

POINT, FORCE = (40, 90, 255), (20, 170, 60)
SIZE = 0.02  # of a point [m]
LENGTH = 0.5  # about that of the greatest force at first [m]
WIDTH = 3.0  # of the line of a force [pixels]


class Contacts(Protocol):
    """The contacts of a simulator, which computes them for those who look."""

    def open(self, show: Callable[[Sequence[ShownContact]], None]) -> None:
        """Begin to call back, from any thread."""

    def close(self) -> None:
        """End that."""


class ContactsPanel(Panel):
    """Points, and lines as long as the forces on what touches from above."""

    def __init__(self, site: viser.ViserServer, contacts: Contacts, lock: threading.RLock) -> None:
        self._site, self._contacts, self._lock = site, contacts, lock
        self._looked_at = self._is_open = self._is_scaled = False
        self._nodes: tuple[viser.PointCloudHandle, viser.LineSegmentsHandle] | None = None
        self._box = site.gui.add_checkbox('Contacts and forces', False)
        self._scale = site.gui.add_number(
            'Force per metre [N]',
            1.0,
            min=0.001,
            step=0.001,
            hint='a force as large as this is shown as a line of 1 m',
        )
        self._box.on_update(lambda _: self._switch())

    def open(self) -> None:
        """Look again at what is checked."""
        self._looked_at = True
        self._switch()

    def close(self) -> None:
        """Look at nothing."""
        self._looked_at = False
        self._switch()

    def _switch(self) -> None:
        with self._lock:
            wanted = self._looked_at and self._box.value
            if wanted and not self._is_open:
                self._contacts.open(self._show)
            elif self._is_open and not wanted:
                self._contacts.close()
                self._clear()
                self._is_scaled = False
            self._is_open = wanted

    def _set_scale(self, greatest: float) -> None:
        """Let the greatest force have a length that can be seen well."""
        if greatest > 0.0:
            self._is_scaled = True
            fill(self._scale, float(f'{greatest / LENGTH:.1g}'))

    def _clear(self) -> None:
        if self._nodes is not None:
            for one in self._nodes:
                one.remove()
            self._nodes = None

    def _show(self, contacts: Sequence[ShownContact]) -> None:
        with self._lock, self._site.atomic():
            if not self._is_open:
                return
            if not contacts:
                self._clear()
                return
            points = np.array([one.position for one in contacts])
            # Of the two opposite forces, that on the upper body is seen best.
            forces = np.array([one.force for one in contacts])
            forces *= np.where(forces[:, 2:] < 0.0, -1.0, 1.0)
            if not self._is_scaled:
                self._set_scale(float(np.linalg.norm(forces, axis=1).max()))
            forces /= self._scale.value
            lines = np.stack([points, points + forces], axis=1)
            if self._nodes is None:
                scene = self._site.scene
                self._nodes = (
                    scene.add_point_cloud(
                        '/contacts/points',
                        points,
                        POINT,
                        point_size=SIZE,
                        point_shape='circle',
                        precision='float32',
                    ),
                    scene.add_line_segments(
                        '/contacts/forces', lines, FORCE, thickness=WIDTH, thickness_units='screen'
                    ),
                )
            else:
                self._nodes[0].points, self._nodes[1].points = points, lines
