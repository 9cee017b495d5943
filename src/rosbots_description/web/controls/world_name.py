"""The name of the world: the title of the page and of its panel."""

import viser

from ...sim.description import SceneChange
from .panel import Panel
from .text import plain, running

SET_TITLE = 'document.title = this.title'  # which the page's policy allows


class WorldName(Panel):
    """Shows it in all browsers."""

    def __init__(self, gui: viser.GuiApi) -> None:
        """Begin without a name; to be made outside of tabs, which may be closed."""
        self._gui, self._name = gui, ''
        self._html = gui.add_html('')
        self._show('gzweb')

    def apply(self, change: SceneChange) -> None:
        """Take in the name of another world."""
        if change.name:
            self._show(change.name)

    def _show(self, name: str) -> None:
        if name != self._name:
            self._name = name
            self._gui.set_panel_label(plain(name))
            self._html.content = running(SET_TITLE, name)
