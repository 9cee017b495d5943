"""Topics with boxes: those whose boxes are checked are shown, and no others read."""

from collections.abc import Collection, Mapping
from functools import cache, partial
from itertools import islice
from typing import Protocol

import viser

from ...sim.core import IDENTITY, Pose, SimError, compose
from ...sim.description import SceneChange, ShownReading
from ..controls import ReadingPanel, Words
from ..scene import Models
from .reading_row import ReadingRow, has_shape

PERIOD = 1.0 / 15.0  # [s, wall] between two looks at the topics
WORLD = ('', 'world')  # frames that are the world's own
MOST = 100  # topics that have a box


class ShownTopics(Protocol):
    """Topics that can be shown."""

    def offered(self) -> Mapping[str, str]:
        """Return the types of the topics that there are, by name."""

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
        """Return a link of these that a frame is known to be at, and its pose there."""


class TopicPanel(ReadingPanel):
    """A box for each topic."""

    UNKNOWN_FRAME = "It is not in the scene: TF does not connect its frame '{}' with a link."

    def __init__(
        self, site: viser.ViserServer, source: ShownTopics, models: Models, plural: str, none: str
    ) -> None:
        """Add the boxes.

        Args:
            plural: what the topics are.
            none: a sentence that there is none.
        """
        super().__init__(PERIOD)
        self._site, self._source, self._models = site, source, models
        self._plural, self._none = plural, none
        self._offered: Mapping[str, str] = {}  # all that there are
        self._topics: Mapping[str, str] = {}  # those that have a box
        self._rows: dict[str, ReadingRow] = {}
        self._checked: set[str] = set()  # also of topics that have gone, and may return
        self._unplaced: dict[str, ShownReading] = {}  # until it is known where they are
        self._links_for = cache(models.links_for)  # until the models change
        self._note = Words(site.gui, none)
        self._folder = site.gui.add_folder(plural.capitalize())

    def apply(self, change: SceneChange) -> None:
        """Look for links anew."""
        with self._lock:
            self._links_for.cache_clear()

    def refresh(self) -> None:
        """Offer the topics that there are, and read those that are chosen."""
        topics = self._source.offered()
        with self._lock:
            if topics != self._offered:
                self._offered = topics
                self._offer(dict(islice(topics.items(), MOST)))
            self._read_chosen()

    def _offer(self, topics: Mapping[str, str]) -> None:
        """Offer topics; boxes that remain are kept: a click on one made anew would be lost."""
        for topic in [one for one in self._rows if topics.get(one) != self._topics[one]]:
            if topic in self._open:
                self._end(topic)
                self._open.remove(topic)
            self._rows.pop(topic).remove()
        self._topics = topics
        self._note.visible = not topics or len(self._offered) > MOST
        self._note.show(
            f'The first {MOST} of {len(self._offered)} {self._plural} are listed.'
            if topics
            else self._none
        )
        with self._folder:
            for number, (topic, kind) in enumerate(topics.items()):
                if topic not in self._rows:
                    choose = partial(self._choose, topic)
                    checked = topic in self._checked
                    self._rows[topic] = ReadingRow(self._site, topic, kind, checked, choose)
                self._rows[topic].rank(number)

    def _choose(self, topic: str) -> None:
        with self._lock:
            row = self._rows.get(topic)
            if row is not None:  # it has not gone meanwhile
                self._checked = (
                    self._checked | {topic} if row.is_checked else self._checked - {topic}
                )
                self._read_chosen()

    def _chosen(self) -> set[str]:
        return self._checked & self._topics.keys()

    def _begin(self, name: str) -> bool:
        self._source.open(name, self._topics[name])
        self._rows[name].tell('Nothing has come yet.')
        return True

    def _end(self, name: str) -> None:
        self._source.close(name)
        self._unplaced.pop(name, None)
        self._rows[name].clear()

    def _tick(self) -> None:
        with self._lock:
            for topic in self._open:
                row = self._rows[topic]
                if row.is_ready:
                    self._show(topic, row)

    def _show(self, topic: str, row: ReadingRow) -> None:
        try:
            reading = self._source.read(topic)
        except SimError as error:
            row.tell(str(error))
            return
        reading = reading or self._unplaced.pop(topic, None)
        if reading is not None:
            self._place(topic, reading, row)

    def _place(self, topic: str, reading: ShownReading, row: ReadingRow) -> None:
        """Show a reading where it was taken, as soon as that is known."""
        pose = self._pose(topic, reading.frame)
        if pose is None:
            self._unplaced[topic] = reading
        row.show(reading, pose, self._frame_note(reading, pose))

    def _frame_note(self, reading: ShownReading, pose: Pose | None) -> str:
        """Return a sentence about a frame that is not known, if it is needed; else ''."""
        is_needed = pose is None and has_shape(reading)
        return self.UNKNOWN_FRAME.format(reading.frame) if is_needed else ''

    def _pose(self, topic: str, frame: str) -> Pose | None:
        """Return the pose of a frame in the world; None if it is not known."""
        if frame in WORLD:
            return IDENTITY
        links = self._links_for(topic)
        found = self._source.locate(frame, links)
        if found is None:
            return None
        link, pose = found
        return compose(self._models.link_pose(links[link]), pose)
