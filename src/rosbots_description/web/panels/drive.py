"""Driving by keys and held buttons, as by teleop_twist_keyboard."""

import threading
from collections.abc import Callable, Sequence
from functools import partial
from typing import Any, Protocol

import viser

from ..controls import PAD, Allow, CameraKeys, Choice, Panel

HOLD = 0.6  # [s, wall] a command lasts; browsers repeat a held key after half a second
# Ahead and left, -1 to 1, with teleop's keys. Viser lists neither comma nor full stop, but passes
# on to the browser whatever a key is called there.
DIRECTIONS: dict[str, tuple[float, float, Any]] = {
    'Forward': (1.0, 0.0, 'I'),
    'Left': (0.0, 1.0, 'J'),
    'Stop': (0.0, 0.0, 'K'),
    'Right': (0.0, -1.0, 'L'),
    'Backward': (-1.0, 0.0, ','),
}
CURVES: dict[str, tuple[float, float, Any]] = {
    'Forward and left': (1.0, 1.0, 'U'),
    'Forward and right': (1.0, -1.0, 'O'),
    'Backward and right': (-1.0, -1.0, 'M'),  # it turns as teleop does
    'Backward and left': (-1.0, 1.0, '.'),
}
CAMERA_KEYS: dict[str, tuple[Any, Any]] = {  # viser moves its camera by them
    'Forward': ('W', 'arrowup'),
    'Left': ('A', 'arrowleft'),
    'Right': ('D', 'arrowright'),
    'Backward': ('S', 'arrowdown'),
}


class Robots(Protocol):
    """Robots that take velocity commands."""

    def drive_topics(self) -> Sequence[str]:
        """Return the topics of commands that have subscribers."""

    def drive(self, topic: str, forward: float, left: float) -> None:
        """Send a command: forward [m/s], and turning left [rad/s]."""


class VelocityCommands:
    """Drives robots for all browsers; one stops when no command has come for `HOLD`."""

    def __init__(self, robots: Robots) -> None:
        self._robots = robots
        self._lock = threading.Lock()
        self._ends: dict[str, threading.Timer] = {}  # stop what is driven, by its topic

    def drive(self, topic: str, forward: float, left: float) -> None:
        """Send a command for `HOLD`: forward [m/s], and turning left [rad/s]."""
        with self._lock:
            if topic in self._ends:  # another robot stops when its time has come
                self._ends.pop(topic).cancel()
            self._robots.drive(topic, forward, left)
            if forward or left:
                end = self._ends[topic] = threading.Timer(
                    HOLD, self._robots.drive, (topic, 0.0, 0.0)
                )
                end.daemon = True
                end.start()


class DrivePanel(Panel):
    """Controls that are there while there is something to drive; it stops when they are let go."""

    def __init__(
        self,
        gui: viser.GuiApi,
        velocities: VelocityCommands,
        topics: Callable[[], Sequence[str]],
        keys: CameraKeys,
        allow_viewers: Allow,
    ) -> None:
        """Add the controls; `topics` returns the newest of `Robots.drive_topics`."""
        self._velocities, self._offered, self._camera_keys = velocities, topics, keys
        self._topics: Sequence[str] = ()
        self._folder = gui.add_folder('Drive', visible=False)
        with self._folder:
            self._topic = Choice(gui, 'Topic', [''])
            self._speed = gui.add_slider('Speed [m/s]', 0.05, 3.0, 0.05, 0.5)
            self._turn = gui.add_slider('Turn [rad/s]', 0.1, 4.0, 0.1, 1.0)
            self._keys = gui.add_checkbox(
                'W A S D and arrows drive', initial_value=True, hint='else they move the camera'
            )
            gui.add_html(PAD)  # last in the folder: a cross of the directions
            for name, (ahead, left, key) in DIRECTIONS.items():
                button = gui.add_button(name, hint=f'hold; or hold the key {key}')
                button.on_hold(partial(self._command, ahead, left))
        for name, (ahead, left, key) in (DIRECTIONS | CURVES).items():
            gui.add_command(f'{name} ({key})', hotkey=key).on_trigger(
                partial(self._command, ahead, left)
            )
        self._commands = [
            gui.add_command(f'{name} ({key})', hotkey=key, disabled=True)
            for name, keys in CAMERA_KEYS.items()
            for key in keys
        ]
        for command in self._commands:
            ahead, left, _ = DIRECTIONS[command.label.split()[0]]
            command.on_trigger(partial(self._command, ahead, left))
        self._keys.on_update(lambda _: self._bind())
        allow_viewers(self._keys)

    def refresh(self) -> None:
        """Offer the topics that there are."""
        topics = self._offered()
        if topics != self._topics:
            self._topics = topics
            self._folder.visible = bool(topics)
            if topics:
                self._topic.offer(topics)
            self._bind()

    def steer(self, ahead: float, left: float) -> None:
        """Drive: parts of the greatest speed and turn, -1 to 1."""
        topic = self._topic.value
        if topic in self._topics:
            self._velocities.drive(topic, ahead * self._speed.value, left * self._turn.value)

    def _bind(self) -> None:
        """Let the camera's keys drive, or leave them to the camera."""
        drives = bool(self._topics) and self._keys.value
        self._camera_keys.give(to_camera=not drives)
        for command in self._commands:
            command.disabled = not drives

    def _command(self, ahead: float, left: float, _event: object) -> None:
        self.steer(ahead, left)
