"""The models in the world, and the links of the selected one: what is clicked on is selected."""

from collections.abc import Iterator
from typing import NamedTuple

import viser

from ...sim.description import SceneChange
from ..controls import Allow, Panel, Words, plain
from ..scene import Selection

MOST = 60  # rows that are shown; what is looked for is found by a part of its name


class TreeRow(NamedTuple):
    """A model, or one of its links."""

    model: str
    link: str | None

    @property
    def text(self) -> str:
        """Return what its button says."""
        return plain(self.model) if self.link is None else f'\u2514 {plain(self.link)}'


class ModelTree(Panel):
    """A button for each model, and below the selected one a button for each of its links."""

    def __init__(
        self, client: viser.ClientHandle, selection: Selection, allow_viewers: Allow
    ) -> None:
        self._client, self._selection, self._allow_viewers = client, selection, allow_viewers
        gui = client.gui
        self._rows: dict[TreeRow, viser.GuiButtonHandle] = {}
        # Used again: if a button is changed and removed between two frames of a browser, viser's
        # page removes it first and then complains of the change.
        self._hidden: list[viser.GuiButtonHandle] = []
        self._find = gui.add_text('Find', '', hint='a part of the name')
        self._find.on_update(lambda _: self._draw())
        allow_viewers(self._find)
        self._folder = gui.add_folder('In the world')
        self._rest = Words(gui, visible=False)
        selection.on_change(self._draw)
        self._draw()

    def apply(self, _change: SceneChange) -> None:
        """Show models that came, and no longer those that went."""
        self._draw()

    def _draw(self) -> None:
        with self._selection.lock:
            wanted = list(self._wanted())
            for row in self._rows.keys() - set(wanted[:MOST]):
                button = self._rows.pop(row)
                button.visible = False
                self._hidden.append(button)
            for order, row in enumerate(wanted[:MOST]):
                if row not in self._rows:
                    self._rows[row] = self._button(row.text)
                button = self._rows[row]
                button.order = float(order)
                chosen = row == (self._selection.model, self._selection.link)
                button.color = 'orange' if chosen else 'gray'
            left = len(wanted) - MOST
            self._rest.visible = left > 0
            if left > 0:
                self._rest.show(f'and {left} more; Find shows those with a part of the name')

    def _button(self, text: str) -> viser.GuiButtonHandle:
        if self._hidden:
            button = self._hidden.pop()
            button.label, button.visible = text, True
        else:
            with self._folder, self._client.atomic():  # not shown before it is listened to
                button = self._client.gui.add_button(text)
                button.on_click(self._choose)
                self._allow_viewers(button)
        return button

    def _wanted(self) -> Iterator[TreeRow]:
        """Return the rows that have what is looked for in their names, the selected model first."""
        part = self._find.value.lower()
        models, selected = self._selection.models.all, self._selection.model
        for name in sorted(models, key=lambda name: name != selected):
            matches = part in name.lower()
            if matches or name == selected:
                yield TreeRow(name, None)
            if name == selected:
                for link in models[name].links:
                    if matches or part in link.name.lower():
                        yield TreeRow(name, link.name)

    def _choose(self, event: viser.GuiEvent[viser.GuiButtonHandle]) -> None:
        with self._selection.lock:
            row = next((row for row, button in self._rows.items() if button is event.target), None)
            if row is not None:
                self._selection.choose(*row)
