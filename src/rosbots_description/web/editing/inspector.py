"""What is selected, in numbers, for as long as it is."""

from collections.abc import Sequence
from typing import Protocol

import viser

from ...sim.core import Pose, SimError, Twist
from ...sim.description import SceneChange, ShownModel
from ..controls import Panel, Words, parts_html, state_html
from ..scene import Selection

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
        """Return the parts that a model was spawned without, each in a few words; [] of a light.

        Raises:
            SimError: as above.
        """


class Inspector(Panel):
    """A table of the state, and lists of joints, collisions and sensors."""

    def __init__(self, gui: viser.GuiApi, states: States, selection: Selection) -> None:
        self._states, self._selection = states, selection
        self._nothing = Words(gui, 'Click on a model in the scene or below.')
        self._examined: ShownModel | None = None  # the model whose omissions are known
        self._omissions: Sequence[str] = ()
        self._state = gui.add_html('', visible=False)
        self._parts = gui.add_html('', visible=False)
        selection.on_change(self._select)

    def apply(self, change: SceneChange) -> None:
        """Show new properties of what is selected."""
        if self._selection.is_in(change):
            self._select()

    def refresh(self) -> None:
        """Show the state of what is selected."""
        model, link = self._selection.shown, self._selection.link
        if model is None:
            return
        try:
            pose, twist = self._states.state(model.name, link, SOON)
            if model is not self._examined:
                omissions = self._states.omissions(model.name)
        except SimError:
            return  # it went, or the simulator did, which others say
        with self._selection.lock:
            if model is self._selection.shown and link == self._selection.link:
                self._state.content = state_html(model, link, pose, twist)
                if model is not self._examined:
                    self._examined, self._omissions = model, omissions
                    self._show_parts(model, link)

    def _select(self) -> None:
        model, link = self._selection.shown, self._selection.link
        self._nothing.visible = model is None
        self._state.visible = self._parts.visible = model is not None
        if model is not None:
            pose = self._selection.models.pose(model.name, link)
            self._state.content = state_html(model, link, pose, None)
            self._show_parts(model, link)

    def _show_parts(self, model: ShownModel, link: str | None) -> None:
        omissions = self._omissions if model is self._examined else ()
        self._parts.content = parts_html(model, link, omissions)
