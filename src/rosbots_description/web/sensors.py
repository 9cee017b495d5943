"""The sensors of robots: those whose boxes are checked are shown, and no others read."""

import threading
from collections.abc import Collection, Mapping
from functools import partial
from typing import Protocol

import viser

from ..sim.core import IDENTITY, Pose, SimError, compose
from ..sim.description import SceneChange, ShownLink, ShownReading
from .models import Models
from .panel import Panel
from .sensor_row import SensorRow
from .ticker import Ticker

PERIOD = 1.0 / 15.0  # [s, wall] between two looks at the sensors
WORLD = ('', 'world')  # frames that are the world's own
NONE = 'No sensor publishes.'


class Sensors(Protocol):
    """Sensors by their topics."""

    def sensor_topics(self) -> Mapping[str, str]:
        """Return the types of the topics of sensors that there are, by name."""

    def open(self, topic: str, kind: str) -> None:
        """Begin to read a topic of one of these types."""

    def close(self, topic: str) -> None:
        """End that."""

    def read(self, topic: str) -> ShownReading | None:
        """Return the newest reading of an open topic; None if there is none since the last call.

        Raises:
            SimError: it cannot be shown.
        """

    def locate(self, frame: str, links: Collection[str]) -> tuple[str, Pose] | None:
        """Return the link of these that a frame is fixed to, and its pose there, if known."""


class SensorPanel(Panel):
    """A box for each sensor."""

    def __init__(self, site: viser.ViserServer, sensors: Sensors, models: Models) -> None:
        self._site, self._sensors, self._models = site, sensors, models
        self._lock = threading.RLock()
        self._ticker = Ticker(PERIOD, self._tick)
        self._topics: Mapping[str, str] = {}
        self._rows: dict[str, SensorRow] = {}
        self._chosen: set[str] = set()  # also of topics that have gone, and may return
        self._open: set[str] = set()
        self._unplaced: dict[str, ShownReading] = {}  # until TF tells where they were taken
        self._is_seen = False
        self._links: dict[str, dict[str, ShownLink]] = {}  # by names, for each topic
        self._note = site.gui.add_markdown(NONE)
        self._folder = site.gui.add_folder('Sensors')

    def apply(self, change: SceneChange) -> None:
        """Look for links anew."""
        with self._lock:
            self._links.clear()

    def refresh(self) -> None:
        """Offer the topics that there are, and read those that are chosen."""
        topics = self._sensors.sensor_topics()
        with self._lock:
            if topics != self._topics:
                self._offer(topics)
            self._read_chosen()

    def open(self) -> None:
        """Read what is chosen."""
        with self._lock:
            self._is_seen = True
            self._read_chosen()

    def close(self) -> None:
        """Read nothing until somebody looks again."""
        with self._lock:
            self._is_seen = False
            self._read_chosen()

    def _offer(self, topics: Mapping[str, str]) -> None:
        self._read({topic for topic in self._open if topics.get(topic) == self._topics[topic]})
        for row in self._rows.values():
            row.remove()
        self._topics = topics
        self._note.visible = not topics
        with self._folder:
            self._rows = {
                topic: SensorRow(self._site, topic, kind, topic in self._chosen,
                                 partial(self._choose, topic))
                for topic, kind in topics.items()}

    def _choose(self, topic: str, chosen: bool) -> None:
        with self._lock:
            self._chosen = self._chosen | {topic} if chosen else self._chosen - {topic}
            self._read_chosen()

    def _read_chosen(self) -> None:
        self._read(self._chosen & self._topics.keys() if self._is_seen else set())

    def _read(self, topics: set[str]) -> None:
        """Read these topics and no others."""
        for topic in self._open - topics:
            self._sensors.close(topic)
            self._unplaced.pop(topic, None)
            self._rows[topic].clear()
        for topic in topics - self._open:
            self._sensors.open(topic, self._topics[topic])
            self._rows[topic].tell('Nothing has come yet.')
        self._open = topics
        self._ticker.run(bool(topics))

    def _tick(self) -> None:
        with self._lock:
            for topic in self._open:
                row = self._rows[topic]
                if row.is_ready:
                    self._show(topic, row)

    def _show(self, topic: str, row: SensorRow) -> None:
        try:
            reading = self._sensors.read(topic)
        except SimError as error:
            row.tell(str(error))
            return
        reading = reading or self._unplaced.pop(topic, None)
        if reading is not None:
            pose = self._pose(topic, reading.frame)
            if pose is None:
                self._unplaced[topic] = reading
            row.show(reading, pose)

    def _pose(self, topic: str, frame: str) -> Pose | None:
        """Return the pose of a sensor's frame in the world; None if it is not known."""
        if frame in WORLD:
            return IDENTITY
        links = self._links_for(topic)
        found = self._sensors.locate(frame, links)
        if found is None:
            return None
        link, pose = found
        return compose(self._models.link_pose(links[link]), pose)

    def _links_for(self, topic: str) -> Mapping[str, ShownLink]:
        """Return links by name, and by model and name; one name has that of the topic's robot."""
        if topic not in self._links:
            spaces = topic.split('/')
            models = sorted(self._models.all.values(), key=lambda model: model.name not in spaces)
            self._links[topic] = found = {}
            for model in models:
                for link in model.links:
                    found[f'{model.name}/{link.name}'] = link
                    found.setdefault(link.name, link)
        return self._links[topic]
