"""Fields to change what is selected, by the services that a script would use."""

from collections.abc import Callable
from functools import partial
from typing import Any, Protocol

import viser

from ...sim.core import Pose, Twist, Vector, from_rpy, to_rpy
from ...sim.description import SceneChange, ShownLink, ShownModel
from ..controls import Panel, Value, attempt, chosen_links, fill, friction, scoped_name
from ..scene import Selection
from .history import History
from .inspector import States

NONE: Vector = (0.0, 0.0, 0.0)
STEP = 0.001  # of all fields


class Inspection(States, Protocol):
    """Reads and changes models and links; each raises SimError with a sentence if it is refused.

    A link of None is the whole model.
    """

    def set_state(self, model: str, link: str | None, pose: Pose, twist: Twist) -> None:
        """Set pose and velocity in the world."""

    def set_mass(self, model: str, link: str, mass: float, gravity: bool) -> None:
        """Set a link's mass [kg], its inertia in proportion, and whether gravity acts on it."""

    def set_friction(self, name: str, mu: float, mu2: float) -> None:
        """Set the friction coefficients of a collision, or of all in a model or link."""


class ChangePanel(Panel):
    """Fields with the numbers as they were when it was selected, and buttons that set them."""

    def __init__(
        self,
        gui: viser.GuiApi,
        inspection: Inspection,
        selection: Selection,
        history: History,
        complain: Callable[[str], None],
    ) -> None:
        self._inspection, self._selection = inspection, selection
        self._history, self._complain = history, complain
        self._properties: dict[str, object] = {}  # by fields, as last filled in or set
        self._folder = gui.add_folder('Change', expand_by_default=False, visible=False)
        with self._folder:
            self._position = gui.add_vector3('Position [m]', NONE, step=STEP)
            self._angles = gui.add_vector3('Roll, pitch, yaw [rad]', NONE, step=STEP)
            self._button(gui, 'Set pose', self._set_pose)
            self._motion = gui.add_folder(None)
            with self._motion:
                self._linear = gui.add_vector3('Velocity [m/s]', NONE, step=STEP)
                self._angular = gui.add_vector3('Turning [rad/s]', NONE, step=STEP)
                self._button(gui, 'Set velocity', self._set_velocity)
            self._body = gui.add_folder(None)
            with self._body:
                self._mass = gui.add_number(
                    'Mass [kg]', 1.0, step=STEP, hint='the inertia changes in proportion'
                )
                self._gravity = gui.add_checkbox('Gravity', True)
                self._button(gui, 'Set mass', self._set_mass)
            self._surface = gui.add_folder(None)
            with self._surface:
                self._mu = gui.add_number('mu', 1.0, step=STEP)
                self._mu2 = gui.add_number('mu2', 1.0, step=STEP)
                self._button(gui, 'Set friction', self._set_friction)
        selection.on_change(self._select)

    def apply(self, change: SceneChange) -> None:
        """Show new properties of what is selected."""
        model = self._selection.shown
        if model is not None and self._selection.is_in(change):
            self._fill_properties(model)

    def _button(
        self, gui: viser.GuiApi, label: str, command: Callable[[ShownModel, str | None], None]
    ) -> None:
        def act() -> None:
            with self._history.turn:
                model = self._selection.shown
                if model is not None:
                    command(model, self._selection.link)

        gui.add_button(label).on_click(lambda _: attempt(act, self._complain))

    def _select(self) -> None:
        model = self._selection.shown
        self._folder.visible = model is not None
        if model is not None:
            pose = self._selection.models.pose(model.name, self._selection.link)
            fill(self._position, pose.position)
            fill(self._angles, to_rpy(pose.orientation))
            fill(self._linear, NONE)
            fill(self._angular, NONE)
            self._properties.clear()
            self._fill_properties(model)

    def _fill_properties(self, model: ShownModel) -> None:
        body = _only_link(model, self._selection.link)
        self._motion.visible = not model.static
        self._body.visible = body is not None and not model.static
        if body is not None and body.inertial is not None:
            self._fill(self._mass, float(body.inertial.mass))
            self._fill(self._gravity, body.gravity)
        pairs = friction(self._selection.links)
        self._surface.visible = bool(pairs)
        if pairs:
            for field, value in zip((self._mu, self._mu2), min(pairs), strict=True):
                self._fill(field, float(value))  # viser casts what is typed to the type there

    def _fill(self, field: viser.GuiInputHandle[Value], value: Value) -> None:
        """Fill in a property when it is another; what is typed into the field meanwhile stays."""
        if self._properties.get(field.label) != value:
            self._properties[field.label] = value
            fill(field, value)

    def _note(self, *fields: viser.GuiInputHandle[Any]) -> None:
        """Note what is being set: when the simulator shows it, it is nothing to fill in."""
        self._properties |= {field.label: field.value for field in fields}

    def _set_pose(self, model: ShownModel, link: str | None) -> None:
        pose = Pose(self._position.value, from_rpy(*self._angles.value))
        self._set_state(model.name, link, 'pose', pose, None)

    def _set_velocity(self, model: ShownModel, link: str | None) -> None:
        twist = Twist(self._linear.value, self._angular.value)
        self._set_state(model.name, link, 'velocity', None, twist)

    def _set_state(
        self, model: str, link: str | None, what: str, pose: Pose | None, twist: Twist | None
    ) -> None:
        """Set pose or velocity; the other stays."""
        before = self._inspection.state(model, link)
        self._inspection.set_state(model, link, pose or before[0], twist or before[1])
        self._history.add(
            f"{what} of '{scoped_name(model, link)}'",
            partial(self._inspection.set_state, model, link, *before),
        )

    def _set_mass(self, model: ShownModel, link: str | None) -> None:
        body = _only_link(model, link)
        if body is not None and body.inertial is not None:
            self._note(self._mass, self._gravity)
            self._inspection.set_mass(model.name, body.name, self._mass.value, self._gravity.value)
            self._history.add(
                f"mass of '{scoped_name(model.name, body.name)}'",
                partial(
                    self._inspection.set_mass,
                    model.name,
                    body.name,
                    body.inertial.mass,
                    body.gravity,
                ),
            )

    def _set_friction(self, model: ShownModel, link: str | None) -> None:
        before = [
            (scoped_name(model.name, part.name, one.name), one.surface.mu, one.surface.mu2)
            for part in chosen_links(model, link)
            for one in part.collisions
        ]

        set_friction = self._inspection.set_friction

        def undo() -> None:
            for one in before:
                set_friction(*one)

        name = scoped_name(model.name, link)
        self._note(self._mu, self._mu2)
        set_friction(name, self._mu.value, self._mu2.value)
        self._history.add(f"friction of '{name}'", undo)


def _only_link(model: ShownModel, link: str | None) -> ShownLink | None:
    """Return the link of that name, or that of a model which has no other."""
    links = chosen_links(model, link)
    return links[0] if len(links) == 1 else None
