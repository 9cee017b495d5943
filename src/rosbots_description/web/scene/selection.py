"""What is selected in a browser."""

import threading
from collections.abc import Callable

from ...sim.description import SceneChange, ShownLink, ShownModel
from ..controls import Panel, chosen_links
from .models import Models


class Selection(Panel):
    """A model or one of its links, or nothing; it ends when the model goes.

    Any thread may choose. Callbacks are called with the page's lock held, so they must be quick;
    what takes long, such as a service, is called from elsewhere.
    """

    def __init__(self, models: Models, lock: threading.RLock) -> None:
        self.models, self.lock = models, lock
        self._chosen: tuple[str | None, str | None] = (None, None)
        self._expected: str | None = None  # a model that is to be selected when it comes
        self._callbacks: list[Callable[[], None]] = []

    @property
    def model(self) -> str | None:
        """Return the name of the selected model, or None."""
        return self._chosen[0]

    @property
    def link(self) -> str | None:
        """Return the name of the selected link in that model; None for the whole model."""
        return self._chosen[1]

    @property
    def shown(self) -> ShownModel | None:
        """Return the selected model as it is shown, or None."""
        return self.models.all.get(self.model or '')

    @property
    def links(self) -> list[ShownLink]:
        """Return the selected link, or all links of the selected model."""
        model = self.shown
        return chosen_links(model, self.link) if model else []

    def is_in(self, change: SceneChange) -> bool:
        """Tell whether a change shows the selected model anew."""
        return any(model.name == self.model for model in change.models)

    def choose(self, model: str | None, link: str | None = None) -> None:
        """Select a model, one of its links, or nothing; what does not exist counts as nothing."""
        with self.lock:
            self._expected = None
            shown = self.models.all.get(model or '')
            if shown is None or link not in {one.name for one in shown.links}:
                link = None
            if shown is None:
                model = None
            if (model, link) != self._chosen:
                self._chosen = model, link
                for callback in self._callbacks:
                    callback()

    def expect(self, model: str) -> None:
        """Select a model as soon as the simulator shows it, unless something else is chosen."""
        with self.lock:
            if model in self.models.all:
                self.choose(model)
            else:
                self._expected = model

    def click(self, model: str, link: str) -> None:
        """Select what was clicked on: the model first, then the link."""
        self.choose(model, link if model == self.model else None)

    def on_change(self, callback: Callable[[], None]) -> None:
        """Call back from now on when something else, or nothing, is selected."""
        self._callbacks.append(callback)

    def apply(self, _change: SceneChange) -> None:
        """End with the model, or fall back to it when the link goes; select what is expected."""
        expected = self._expected
        self.choose(*self._chosen)
        if expected is not None:
            self.expect(expected)
