"""Driving by keys and held buttons, as by teleop_twist_keyboard."""

import threading
from collections.abc import Sequence
from functools import partial
from typing import Any, Protocol

import viser

from .panel import Panel

HOLD = 0.6  # [s, wall] a command lasts; browsers repeat a held key after half a second
# Ahead and left, -1 to 1, with the keys. Viser has no comma, teleop's key for backward.
DIRECTIONS: dict[str, tuple[float, float, tuple[Any, ...]]] = {
    'Forward': (1.0, 0.0, ('I', 'arrowup')),
    'Left': (0.0, 1.0, ('J', 'arrowleft')),
    'Right': (0.0, -1.0, ('L', 'arrowright')),
    'Backward': (-1.0, 0.0, ('M', 'arrowdown')),
    'Stop': (0.0, 0.0, ('K',)),
}


class Robots(Protocol):
    """Robots that take velocity commands."""

    def drive_topics(self) -> Sequence[str]:
        """Return the topics of commands that somebody subscribes to."""

    def drive(self, topic: str, forward: float, left: float) -> None:
        """Send a command: forward [m/s], and turning left [rad/s]."""


class DrivePanel(Panel):
    """Controls that are there while there is something to drive; it stops when they are let go."""

    def __init__(self, gui: viser.GuiApi, robots: Robots) -> None:
        self._robots = robots
        self._lock = threading.Lock()
        self._end = threading.Timer(0.0, lambda: None)
        self._topics: Sequence[str] = ()
        self._folder = gui.add_folder('Drive', visible=False)
        with self._folder:
            self._topic = gui.add_dropdown('Topic', [''])
            self._speed = gui.add_slider('Speed [m/s]', 0.05, 3.0, 0.05, 0.5)
            self._turn = gui.add_slider('Turn [rad/s]', 0.1, 4.0, 0.1, 1.0)
            for name, (ahead, left, keys) in DIRECTIONS.items():
                button = gui.add_button(name, hint=f'hold; or keys {" and ".join(keys)}')
                button.on_hold(partial(self._command, ahead, left))
        for name, (ahead, left, keys) in DIRECTIONS.items():
            for key in keys:
                gui.add_command(f'{name} ({key})', hotkey=key).on_trigger(
                    partial(self._command, ahead, left))

    def refresh(self) -> None:
        """Offer the topics that there are."""
        topics = tuple(self._robots.drive_topics())
        if topics != self._topics:
            self._topics = topics
            self._folder.visible = bool(topics)
            if topics:
                self._topic.options = topics

    def _command(self, ahead: float, left: float, _event: object) -> None:
        with self._lock:
            topic = self._topic.value
            if topic not in self._topics:
                return
            self._end.cancel()
            self._robots.drive(topic, ahead * self._speed.value, left * self._turn.value)
            if ahead or left:
                self._end = threading.Timer(HOLD, self._robots.drive, (topic, 0.0, 0.0))
                self._end.daemon = True
                self._end.start()
