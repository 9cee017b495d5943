"""A plot of any numbers that are published, over simulated time."""

import time
from collections import deque
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from itertools import cycle, islice
from typing import Protocol

import numpy as np
import viser
from viser import uplot

from ...sim.core import SimError
from ...sim.description import ShownMotion
from ..controls import Choice, ReadingPanel, fill, plain
from .chart import WINDOW, Chart

PERIOD = 0.2  # [s, wall] between two pictures of the plot
COLOURS = ('#1f77b4', '#d62728', '#2ca02c', '#ff7f0e', '#9467bd', '#8c564b', '#17becf')
HEIGHT, PADDING = 260, (12, 24, 0, 0)  # [pixels]; from the top clockwise
FIRST = 0.0  # place of the plot among what is in its folder
MOST = 20  # curves
MOST_TOPICS = 1000  # that are offered
MOTIONS = 90  # clocks kept, to tell the simulated time of an arrival


class Signals(Protocol):
    """Numbers of topics, by rqt_plot's names: topic and field."""

    def signal_topics(self) -> Mapping[str, Sequence[str]]:
        """Return the fields of each topic that there is."""

    def open(self, curve: str) -> None:
        """Begin to read a curve.

        Raises:
            SimError: there is no such topic or number.
        """

    def close(self, curve: str) -> None:
        """End that."""

    def read(self) -> Mapping[str, Sequence[tuple[float | None, float, float]]]:
        """Return what came for each open curve since the last call.

        That are its stamp [s, simulated], if it has one; its arrival [s, monotonic]; the number.
        """


class PlotPanel(ReadingPanel):
    """Chooses curves and draws them."""

    def __init__(
        self, site: viser.ViserServer, signals: Signals, complain: Callable[[str], None]
    ) -> None:
        super().__init__(PERIOD)
        self._site, self._signals, self._complain = site, signals, complain
        gui = site.gui
        self._chart = Chart()
        self._topics: Mapping[str, Sequence[str]] = {}
        self._clock: deque[tuple[float, float]] = deque(maxlen=MOTIONS)
        self._topic = Choice(gui, 'Topic', [''])
        self._field = Choice(gui, 'Field', [''])
        self._curve = gui.add_text('Curve', '', hint='topic and field, as of rqt_plot')
        self._add = gui.add_button('Add curve', icon=viser.Icon.CHART_LINE)
        self._folder = gui.add_folder(f'Last {WINDOW:.0f} s', visible=False)
        self._boxes: dict[str, viser.GuiCheckboxHandle] = {}
        self._plot: viser.GuiUplotHandle | None = None
        self._topic.on_update(self._choose_topic)
        self._field.on_update(self._choose_field)
        self._add.on_click(lambda _: self._add_curve(self._curve.value.strip()))

    def move(self, motion: ShownMotion) -> None:
        """Take in the clock."""
        with self._lock:
            if self._clock and motion.time < self._clock[-1][1]:
                self._clock.clear()
                self._chart.clear()
            self._clock.append((time.monotonic(), motion.time))

    def refresh(self) -> None:
        """Offer the topics that there are, and read the curves."""
        topics = self._signals.signal_topics()
        with self._lock:
            if topics.keys() != self._topics.keys():
                self._topic.offer(('', *islice(topics, MOST_TOPICS)))
            self._topics = topics
            self._read_chosen()

    def _choose_topic(self) -> None:
        self._field.offer(('', *self._topics.get(self._topic.value, ())))

    def _choose_field(self) -> None:
        if self._field.value:
            fill(self._curve, f'{self._topic.value}/{self._field.value}')

    def _add_curve(self, curve: str) -> None:
        with self._lock:
            if curve in self._chart.curves:
                return
            if len(self._chart.curves) >= MOST:
                self._complain(f'A plot has at most {MOST} curves; remove one first.')
                return
            try:
                self._signals.open(curve)
            except SimError as error:
                self._complain(str(error))
                return
            self._open.add(curve)
            self._chart.add(curve)
            self._show()
            self._read_chosen()

    def _remove_curve(self, curve: str, _event: object) -> None:
        with self._lock:
            if curve in self._chart.curves:  # not removed by somebody else a moment ago
                self._chart.remove(curve)
                self._show()
                self._read_chosen()

    def _chosen(self) -> set[str]:
        return set(self._chart.curves)

    def _begin(self, name: str) -> bool:
        try:
            self._signals.open(name)
        except SimError:  # it was there when it was added, and will be tried again
            return False
        return True

    def _end(self, name: str) -> None:
        self._signals.close(name)

    def _show(self) -> None:
        """Show an empty plot of the curves, and a box for each; boxes that remain are kept.

        A click on a box that is made anew just then would be lost.
        """
        curves = self._chart.curves
        self._folder.visible = bool(curves)
        for curve in self._boxes.keys() - set(curves):
            self._boxes.pop(curve).remove()
        if self._plot is not None:
            self._plot.remove()
            self._plot = None
        with self._folder, self._site.atomic():  # no box is shown before it is listened to
            if curves:
                self._plot = self._site.gui.add_uplot(
                    self._chart.table(self._now()),
                    (
                        uplot.Series(label='simulated time [s]'),
                        *(
                            uplot.Series(label=plain(curve), stroke=colour, width=1.5)
                            for curve, colour in zip(curves, cycle(COLOURS), strict=False)
                        ),
                    ),
                    scales={'x': {'time': False}},
                    height=HEIGHT,
                    padding=PADDING,
                    order=FIRST,
                )
            for curve in curves:
                if curve not in self._boxes:
                    self._boxes[curve] = box = self._site.gui.add_checkbox(
                        plain(curve), initial_value=True, hint='uncheck to remove'
                    )
                    box.on_update(partial(self._remove_curve, curve))

    def _tick(self) -> None:
        with self._lock:
            for curve, samples in self._signals.read().items():
                for stamp, arrival, value in samples:
                    self._chart.note(curve, self._time(stamp, arrival), value)
            if self._plot is not None:
                self._plot.data = self._chart.table(self._now())

    def _now(self) -> float:
        return self._clock[-1][1] if self._clock else 0.0

    def _time(self, stamp: float | None, arrival: float) -> float:
        """Return the simulated time of a message, its stamp unless that is of another clock."""
        if not self._clock:
            return stamp or 0.0
        walls, times = np.array(self._clock).T
        came = float(np.interp(arrival, walls, times))
        return stamp if stamp is not None and abs(stamp - came) < WINDOW else came
