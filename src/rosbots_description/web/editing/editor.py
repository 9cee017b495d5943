"""Edits of models, and the controls for them: push, duplicate, delete what is selected."""

from collections.abc import Callable
from functools import partial
from typing import Protocol

import viser

from ...sim.core import Pose, SimError, Vector
from ...sim.description import ModelText
from ..controls import Panel, Words, attempt, scoped_name
from ..scene import Selection
from .history import History

HINT = 'Click on a model to move, push, duplicate or delete it.'
AXES = ('world', 'link')


class Editor(Protocol):
    """Edits models; each method raises SimError with a sentence if it is refused."""

    def insert(self, text: ModelText, on_ground: bool = False, beside: bool = False) -> str:
        """Spawn a model or light under a name that is free; return the name.

        Args:
            on_ground: let its lowest point be at the height of the pose.
            beside: choose the nearest place that is free.
        """

    def delete(self, name: str) -> None:
        """Delete a model, or a light."""

    def describe(self, name: str) -> ModelText:
        """Return what is needed to spawn a model again as it is."""

    def move(self, name: str, pose: Pose) -> None:
        """Move a model, at rest, so that its frame is at a pose in the world."""

    def hold(self, name: str, pose: Pose, duration: float) -> None:
        """Hold a model at rest at a pose for a time [s, wall]; zero: let it go there."""

    def push(
        self, link: str, force: Vector, torque: Vector, duration: float, own_axes: bool
    ) -> None:
        """Apply a force [N] at the centre of mass of a link, and a torque [N m].

        Args:
            link: its scoped name.
            duration: [s, simulated]
            own_axes: in the axes of the link, not of the world.
        """


class EditorPanel(Panel):
    """Controls for the selected model."""

    def __init__(
        self,
        gui: viser.GuiApi,
        selection: Selection,
        editor: Editor,
        history: History,
        complain: Callable[[str], None],
    ) -> None:
        self._selection, self._editor = selection, editor
        self._history, self._complain = history, complain
        self._title = Words(gui, HINT)
        duplicate = gui.add_button('Duplicate', icon=viser.Icon.COPY, hint='Shift-D')
        delete = gui.add_button('Delete', icon=viser.Icon.TRASH, hint='Delete')
        with gui.add_folder('Force and torque', expand_by_default=False):
            force = gui.add_vector3('Force [N]', (0.0, 0.0, 100.0), step=1.0)
            torque = gui.add_vector3('Torque [N m]', (0.0, 0.0, 0.0), step=1.0)
            duration = gui.add_number('Duration [s]', 0.1, min=0.0, step=0.1)
            axes = gui.add_dropdown('Axes of the', AXES)
            push = gui.add_button('Push', icon=viser.Icon.ARROW_BIG_RIGHT)

        def push_link(model: str) -> None:
            in_link = axes.value == 'link'
            editor.push(self._link_of(model), force.value, torque.value, duration.value, in_link)

        self._controls = (duplicate, delete, push)
        self._show()
        selection.on_change(self._show)
        duplicate.on_click(lambda _: self._do(self._duplicate))
        delete.on_click(lambda _: self._do(self._delete))
        push.on_click(lambda _: self._do(push_link))
        gui.add_command('Delete the selected model', hotkey='delete').on_trigger(
            lambda _: self._do(self._delete)
        )
        gui.add_command('Duplicate the selected model', hotkey='D', modifier='shift').on_trigger(
            lambda _: self._do(self._duplicate)
        )

    def _link_of(self, model: str) -> str:
        """Return the scoped name of the selected link, else of the canonical one."""
        shown = self._selection.models.all.get(model)
        if shown is None:
            raise SimError(f"model '{model}' does not exist any more")
        return scoped_name(model, self._selection.link or shown.links[0].name)

    def _duplicate(self, model: str) -> None:
        name = self._editor.insert(self._editor.describe(model), beside=True)
        self._selection.expect(name)
        self._history.add(f"duplicate '{model}'", partial(self._editor.delete, name))

    def _delete(self, model: str) -> None:
        self._selection.choose(None)  # its state is polled no more, and a second press does nothing
        text = self._editor.describe(model)
        self._editor.delete(model)
        self._history.add(f"delete '{model}'", partial(self._editor.insert, text))

    def _do(self, act: Callable[[str], None]) -> None:
        with self._history.turn:
            model = self._selection.model
            if model is not None:
                attempt(lambda: act(model), self._complain)

    def _show(self) -> None:
        model, link = self._selection.model, self._selection.link
        if model is None:
            self._title.show(HINT)
        else:
            self._title.show(f', link {link}' if link else '', bold=model)
        for control in self._controls:
            control.disabled = model is None
