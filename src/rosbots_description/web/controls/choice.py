"""A dropdown of strangers' names: topics, models, parameters, lights."""

from collections import Counter
from collections.abc import Callable, Sequence

import viser

from .text import MOST, plain

NUMBER = 12  # characters that tell texts apart that would be alike


class Choice:
    """Shows each name as a text on the page, no two alike; what is chosen is the name."""

    def __init__(
        self, gui: viser.GuiApi, label: str, names: Sequence[str], hint: str | None = None
    ) -> None:
        self._names = _by_text(names)
        self._dropdown = gui.add_dropdown(label, tuple(self._names), hint=hint)

    @property
    def value(self) -> str:
        """The name that is chosen; '' for one that is not offered any more."""
        return self._names.get(self._dropdown.value, '')

    @property
    def names(self) -> tuple[str, ...]:
        """What is offered."""
        return tuple(self._names.values())

    def offer(self, names: Sequence[str]) -> None:
        """Offer other names, at least one; the first is chosen if the chosen one is missing."""
        if tuple(names) == self.names:
            return
        found = _by_text(names)
        if list(found.items()) != list(self._names.items()):
            self._names = found
            self._dropdown.options = tuple(found)

    def on_update(self, act: Callable[[], None]) -> None:
        """Call back when another is chosen."""
        self._dropdown.on_update(lambda _: act())


def _by_text(names: Sequence[str]) -> dict[str, str]:
    """Return names by their texts."""
    found: dict[str, str] = {}
    alike: Counter[str] = Counter()
    for name in dict.fromkeys(names):
        text = plain(name)
        short = plain(name, MOST - NUMBER)
        while text in found:
            alike[short] += 1
            text = f'{short} ({1 + alike[short]})'
        found[text] = name
    return found
