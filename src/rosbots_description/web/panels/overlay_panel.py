"""The choice of overlays, and of how visuals are drawn."""

import threading

import viser

from ...sim.description import SceneChange, ShownModel
from ...sim.rendering import Look
from ..controls import Allow, Panel
from ..scene import OVERLAYS, SceneView, Selection, link_node


def add_look(gui: viser.GuiApi, view: SceneView, lock: threading.RLock) -> None:
    """Add the choice of how visuals are drawn, in all browsers alike."""
    choice = gui.add_dropdown('Visuals', [look.value for look in Look])

    def draw(_event: object) -> None:
        with lock:
            view.draw_as(Look(choice.value))

    choice.on_update(draw)


class OverlayPanel(Panel):
    """A checkbox for each overlay, of one browser; overlays of a link move along with its node."""

    def __init__(
        self, client: viser.ClientHandle, selection: Selection, allow_viewers: Allow
    ) -> None:
        self._client, self._selection = client, selection
        self._shown: dict[str, list[str]] = {}  # nodes, by models
        gui = client.gui
        self._only = gui.add_checkbox('Only of what is selected', False)
        self._boxes = {name: gui.add_checkbox(name, False) for name in OVERLAYS}
        for box in (self._only, *self._boxes.values()):
            box.on_update(lambda _: self.draw())
            allow_viewers(box)
        selection.on_change(self._select)

    def apply(self, change: SceneChange) -> None:
        """Show it of models that came or changed."""
        with self._client.atomic():  # no mark is seen before it is in its place
            for name in list(self._shown) if change.reset else change.removed:
                self._erase(name)
            for model in change.models:
                self._draw(model)

    def _select(self) -> None:
        if self._only.value:
            self.draw()

    def draw(self) -> None:
        """Show what is checked, and nothing else."""
        with self._selection.lock, self._client.atomic():
            for model in self._selection.models.all.values():
                self._draw(model)

    def _draw(self, model: ShownModel) -> None:
        """Show what is checked of a model, and nothing else."""
        self._erase(model.name)
        names = [name for name, box in self._boxes.items() if box.value]
        chosen, only = self._selection.link, self._only.value
        if not names or (only and model.name != self._selection.model):
            return
        shown = self._shown[model.name] = []
        for link in model.links:
            if not only or chosen in (None, link.name):
                for name in names:
                    path = f'{link_node(model.name, link.name)}/{name}'
                    OVERLAYS[name](self._client.scene, path, model, link)
                    shown.append(path)

    def _erase(self, model: str) -> None:
        for path in self._shown.pop(model, ()):
            self._client.scene.remove_by_name(path)  # unless it went with its link
