"""The clock: simulated time and real-time factor, in a line."""

from collections import deque

import viser

from ...sim.description import ShownMotion
from ..controls import STYLE, Panel, markup

PERIOD = 0.2  # [s, wall] between two clocks shown
WINDOW = 1.0  # [s, wall] over which the real-time factor is taken


class Clock(Panel):
    """Shows times; real time and iterations are its tooltip."""

    def __init__(self, gui: viser.GuiApi) -> None:
        self._shown = 0.0  # real time of the clock shown [s]
        self._past: deque[tuple[float, float]] = deque()  # real time and simulated time
        self._html = gui.add_html(_content('', 'The simulator has not answered yet.', ''))

    def move(self, motion: ShownMotion) -> None:
        """Show times, and how fast simulated time runs."""
        factor = self._factor(motion)
        if abs(motion.real_time - self._shown) < PERIOD:
            return
        self._shown = motion.real_time
        pace = 'paused' if motion.paused else f'{factor:.2f}\u00d7'
        self._html.content = _content(
            _time(motion.time),
            pace,
            (
                f'simulated time, and real-time factor; real time {_time(motion.real_time)}, '
                f'{motion.iterations} iterations'
            ),
        )

    def _factor(self, motion: ShownMotion) -> float:
        """Return the real-time factor of the last second."""
        past = self._past
        if past and (motion.time < past[-1][1] or motion.real_time < past[-1][0]):
            past.clear()  # time was reset, or it is another simulator
        past.append((motion.real_time, motion.time))
        while len(past) > 2 and motion.real_time - past[0][0] > WINDOW:
            past.popleft()
        passed = motion.real_time - past[0][0]
        return (motion.time - past[0][1]) / passed if passed > 0.0 else 0.0


def _content(time: str, pace: str, more: str) -> str:
    return (
        f'<div class="words clock" style="{STYLE}; padding: 0" title="{markup(more)}">'
        f'<b>{markup(time)}</b>&ensp;{markup(pace)}</div>'
    )


def _time(seconds: float) -> str:
    minutes, rest = divmod(seconds, 60.0)
    hours, minutes = divmod(int(minutes), 60)
    return f'{hours:02d}:{minutes:02d}:{rest:06.3f}'
