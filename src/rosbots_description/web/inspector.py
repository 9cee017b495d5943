"""What is selected, in numbers, for as long as it is."""

import threading
from collections.abc import Sequence
from typing import Protocol

import viser

from ..sim.core import Pose, SimError, Twist
from ..sim.description import SceneChange, ShownModel
from .descriptions import parts_html, state_html
from .models import Models
from .panel import Panel
from .selection import Selection
from .text import Words

SOON = 1.0  # [s, wall] for a state that is asked for again soon


class States(Protocol):
    """Where models and links are, and how they move."""

    def state(
        self, model: str, link: str | None, patience: float | None = None
    ) -> tuple[Pose, Twist]:
        """Return pose and velocity of a model, or of one of its links, in the world.

        Args:
            patience: for an answer [s, wall]; None: as long as for any other one.
        Raises:
            SimError: there is none of that name, or no simulator.
        """

    def omissions(self, model: str) -> Sequence[str]:
        """Return the parts that a model was spawned without, each in a few words.

        Raises:
            SimError: as above.
        """


class Inspector(Panel):
    """A table of the state, and lists of joints, collisions and sensors."""

    def __init__(
        self,
        gui: viser.GuiApi,
        states: States,
        models: Models,
        selection: Selection,
        lock: threading.RLock,
    ) -> None:
        self._states, self._models, self._selection, self._lock = states, models, selection, lock
        self._nothing = Words(gui, 'Click on a model in the scene or below.')
        self._examined: ShownModel | None = None  # the model whose omissions are known
        self._omissions: Sequence[str] = ()
        self._state = gui.add_html('', visible=False)
        self._parts = gui.add_html('', visible=False)
        selection.on_change(self._select)

    def apply(self, change: SceneChange) -> None:
        """Show new properties of what is selected."""
        if any(model.name == self._selection.model for model in change.models):
            self._select()

    def refresh(self) -> None:
        """Show the state of what is selected."""
        model, link = self._selection.model, self._selection.link
        if model is None:
            return
        shown = self._models.all.get(model)
        try:
            pose, twist = self._states.state(model, link, SOON)
            if shown is not self._examined:
                omissions = self._states.omissions(model)
        except SimError:
            return  # it went, or the simulator did, which others say
        with self._lock:
            if (model, link) == (self._selection.model, self._selection.link):
                self._state.content = state_html(self._models.all[model], link, pose, twist)
                if shown is not self._examined:
                    self._examined, self._omissions = shown, omissions
                    self._show_parts(model, link)

    def _select(self) -> None:
        name, link = self._selection.model, self._selection.link
        self._nothing.visible = name is None
        self._state.visible = self._parts.visible = name is not None
        if name is not None:
            pose = self._models.pose(name, link)
            self._state.content = state_html(self._models.all[name], link, pose, None)
            self._show_parts(name, link)

    def _show_parts(self, name: str, link: str | None) -> None:
        model = self._models.all[name]
        self._parts.content = parts_html(
            model, link, self._omissions if model is self._examined else ()
        )
