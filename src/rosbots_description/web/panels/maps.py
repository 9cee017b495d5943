"""Maps, paths, poses of particles and goals, where the robot takes them to be."""

import threading
from typing import Protocol

import viser

from ...sim.core import IDENTITY, SimError
from ...sim.description import ShownReading
from ..scene import Models
from .reading_row import ReadingRow
from .topics import ShownTopics, TopicPanel

NONE = 'Nobody publishes a map, a path, poses or a goal.'
TRUE = 'true map'


class Maps(ShownTopics, Protocol):
    """Topics of maps, and the true map."""

    def true_map(self, height: float) -> ShownReading:
        """Return what the world occupies at a height [m], models with joints left out.

        Raises:
            SimError: it cannot be told.
        """


class MapPanel(TopicPanel):
    """A box for each topic, and one for the true map.

    Frames such as map move against the true robot when a robot corrects where it takes itself to
    be: what is shown moves along. One that TF does not connect with a robot is the world's.
    """

    UNKNOWN_FRAME = "TF does not connect its frame '{}' with a robot: it is shown as the world's."

    def __init__(self, site: viser.ViserServer, maps: Maps, models: Models) -> None:
        super().__init__(site, maps, models, 'maps and goals', NONE)
        self._maps = maps
        # What is shown, by topics, and whether TF connects it with a robot.
        self._shown: dict[str, tuple[ShownReading, bool]] = {}
        self._turn = threading.Lock()
        self._truth = ReadingRow(site, TRUE, 'at a height', checked=False, choose=self._show_truth)
        self._height = site.gui.add_number('Height of the true map [m]', 0.2, step=0.05)

    def _show_truth(self) -> None:
        with self._turn:  # making it takes seconds, in which the box may be checked otherwise
            self._truth.clear()
            if self._truth.is_checked:
                try:
                    self._truth.show(self._maps.true_map(float(self._height.value)), IDENTITY)
                except SimError as error:
                    self._truth.tell(str(error))

    def _end(self, name: str) -> None:
        self._shown.pop(name, None)
        super()._end(name)

    def _place(self, topic: str, reading: ShownReading, row: ReadingRow) -> None:
        pose = self._pose(topic, reading.frame)
        self._shown[topic] = reading, pose is not None
        row.show(reading, pose or IDENTITY, self._frame_note(reading, pose))

    def _tick(self) -> None:
        super()._tick()
        with self._lock:
            for topic, (reading, was_known) in self._shown.items():
                pose, row = self._pose(topic, reading.frame), self._rows[topic]
                row.move(pose or IDENTITY)
                if was_known != (pose is not None):
                    self._shown[topic] = reading, pose is not None
                    row.say(reading, self._frame_note(reading, pose))
