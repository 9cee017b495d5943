"""The controls of time: play, pause, steps, speed, resets."""

from collections.abc import Callable
from typing import Protocol

import viser

from ...sim.description import SceneChange, ShownMotion
from ..controls import BAR, Panel, Words, attempt, fill

SPEEDS = {'0.1x': 0.1, '1x': 1.0, '10x': 10.0, 'as fast as possible': 0.0}


class TimeControl(Protocol):
    """The commands to a simulator; each raises SimError with a sentence if it is refused."""

    def pause(self) -> None:
        """Pause simulated time."""

    def unpause(self) -> None:
        """Continue simulated time."""

    def step(self, steps: int) -> None:
        """Pause and make steps."""

    def reset_world(self) -> None:
        """Return every model to its spawn pose; time is kept."""

    def reset_simulation(self) -> None:
        """Restart at time zero."""

    def set_speed(self, factor: float) -> None:
        """Set the target real-time factor; 0: as fast as possible."""


class TimePanel(Panel):
    """Controls for all browsers alike."""

    def __init__(
        self, gui: viser.GuiApi, time: TimeControl, complain: Callable[[str], None]
    ) -> None:
        self._time, self._complain = time, complain
        self._warning = Words(gui, visible=False)
        gui.add_html(BAR)
        self._play = gui.add_button('Pause', icon=viser.Icon.PLAYER_PAUSE)
        self._step = gui.add_button('Step', icon=viser.Icon.PLAYER_TRACK_NEXT)
        self._steps = gui.add_number(
            'Steps', 1, min=1, max=1_000_000, step=1, hint='number of steps that Step makes'
        )
        self._speed = gui.add_dropdown(
            'Speed', list(SPEEDS), initial_value='1x', hint='speed: target real-time factor'
        )
        self._reset_world = gui.add_button('Reset world', icon=viser.Icon.RELOAD)
        self._reset = gui.add_button('Reset time and world', icon=viser.Icon.PLAYER_SKIP_BACK)
        self._paused = False
        self._target = 1.0  # real-time factor that the simulator reported last
        self._play.on_click(lambda _: self._toggle())
        self._speed.on_update(self._choose)
        self._step.on_click(lambda _: self._do(lambda: time.step(int(self._steps.value))))
        self._reset_world.on_click(lambda _: self._do(time.reset_world))
        self._reset.on_click(lambda _: self._do(time.reset_simulation))
        gui.add_command('Play or pause', hotkey='space').on_trigger(lambda _: self._toggle())

    def apply(self, change: SceneChange) -> None:
        """Show the target speed when it is another; what was chosen just now may not be set yet."""
        factor = change.max_update_rate * change.step_size
        if factor != self._target:
            self._target = factor
            name = next(
                (name for name, speed in SPEEDS.items() if abs(speed - factor) < 1e-9), None
            )
            if name is not None:
                fill(self._speed, name)

    def move(self, motion: ShownMotion) -> None:
        """Show whether time runs."""
        if motion.paused != self._paused:
            self._paused = motion.paused
            self._play.label = 'Play' if motion.paused else 'Pause'
            self._play.icon = viser.Icon.PLAYER_PLAY if motion.paused else viser.Icon.PLAYER_PAUSE

    def warn(self, sentence: str) -> None:
        """Show a sentence above the controls until it is withdrawn with ''."""
        self._warning.show('', bold=sentence)
        self._warning.visible = bool(sentence)

    def _choose(self, event: viser.GuiEvent[viser.GuiDropdownHandle[str]]) -> None:
        if event.client is not None:  # else it is what the simulator says
            self._do(lambda: self._time.set_speed(SPEEDS[event.target.value]))

    def _toggle(self) -> None:
        self._do(self._time.unpause if self._paused else self._time.pause)

    def _do(self, command: Callable[[], None]) -> None:
        attempt(command, self._complain)
