"""Sliders for the joints of a robot, and for commands to controllers of joints."""

import math
import threading
from collections.abc import Callable, Sequence
from functools import partial
from typing import Protocol

import viser

from ...sim.core import SimError
from ...sim.description import PRISMATIC, CommandTopic, JointSpec
from ..controls import Choice, Panel, attempt, plain
from ..scene import Models

NOTHING, TOPICS = '', 'topics of controllers'
POSITION, VELOCITY, EFFORT = 'position', 'velocity', 'effort'
MOST = 40  # sliders
STEPS = 1000  # of a slider
UNITS = {  # of joints that slide, and of those that turn
    POSITION: ('m', 'rad'),
    VELOCITY: ('m/s', 'rad/s'),
    EFFORT: ('N', 'N m'),
}
# Of the sliders: the model, its joints or the topics, what they set, and the range.
Sliders = tuple[str, Sequence[CommandTopic | str], str, float]


class Joints(Protocol):
    """The joints of a simulator; each command raises SimError with a sentence if it is refused."""

    def position(self, model: str, joint: str) -> float:
        """Return a position [rad or m]."""

    def set_position(self, model: str, joint: str, position: float) -> None:
        """Move a joint there [rad or m] at once."""

    def set_velocity(self, model: str, joint: str, velocity: float, effort: float) -> None:
        """Let a motor keep a velocity [rad/s or m/s] with at most an effort [N m or N]."""

    def set_effort(self, model: str, joint: str, effort: float) -> None:
        """Apply an effort [N m or N] from now on."""

    def command_topics(self) -> Sequence[CommandTopic]:
        """Return the topics of commands that have subscribers."""

    def command(self, topic: CommandTopic, values: Sequence[float]) -> None:
        """Publish a value for each joint of a topic, or its one number."""


class JointPanel(Panel):
    """A slider for each joint of the model that is chosen."""

    def __init__(
        self,
        client: viser.ClientHandle,
        joints: Joints,
        topics: Callable[[], Sequence[CommandTopic]],
        models: Models,
        complain: Callable[[str], None],
    ) -> None:
        """Add the controls; `topics` returns the newest of `joints.command_topics`."""
        self._client, self._joints, self._offered = client, joints, topics
        self._models, self._complain = models, complain
        self._lock = threading.RLock()
        self._topics: Sequence[CommandTopic] = ()
        self._shown: Sliders = NOTHING, (), POSITION, 0.0
        self._sliders: list[viser.GuiSliderHandle[float]] = []
        gui = client.gui
        self._folder = gui.add_folder('Joints', visible=False)
        with self._folder:
            self._of = Choice(gui, 'Of', [NOTHING], hint='a model, or topics of controllers')
            self._what = gui.add_dropdown('Sliders set', [POSITION, VELOCITY, EFFORT])
            self._range = gui.add_number(
                'Range',
                10.0,
                min=0.001,
                step=0.001,
                hint='of velocities [rad/s, m/s], efforts [N m, N] without a limit, and topics',
            )
            self._force = gui.add_number(
                'Motor effort',
                10.0,
                min=0.0,
                step=0.001,
                hint='a velocity is kept with at most this effort [N m, N]',
            )
            self._release = gui.add_button(
                'Release', hint='switches motors off and ends efforts of these joints'
            )
        self._of.on_update(self._show)
        for control in (self._what, self._range):
            control.on_update(lambda _: self._show())
        self._release.on_click(lambda _: self._let_go())

    def refresh(self) -> None:
        """Offer the models and topics that there are."""
        with self._lock:
            self._topics = self._offered()
            names = [model.name for model in tuple(self._models.all.values()) if model.joints]
            options = (NOTHING, *names, *((TOPICS,) if self._topics else ()))
            if options != self._of.names:
                self._of.offer(options)
                self._folder.visible = len(options) > 1
            self._show()

    def _specs(self, name: str) -> Sequence[JointSpec]:
        model = self._models.all.get(name)
        return model.joints[:MOST] if model else ()

    def _show(self) -> None:
        """Show the sliders of what is chosen; those that are there stay, for they may be in use."""
        with self._lock:
            model = self._of.value
            names: Sequence[CommandTopic | str] = tuple(joint.name for joint in self._specs(model))
            if model == TOPICS:
                names = tuple(self._topics)
            wanted = model, names, self._what.value, float(self._range.value)
            if wanted != self._shown:
                self._shown = wanted
                self._build()

    def _build(self) -> None:
        """Make the sliders of what is to be shown, each at rest."""
        with self._lock:
            for slider in self._sliders:
                slider.remove()
            self._sliders.clear()
            model, _, what, limit = self._shown  # what is chosen may be another meanwhile
            if model == TOPICS:
                for topic in self._topics:
                    self._add_topic(topic, limit)
                return
            for joint in self._specs(model):
                unit = UNITS[what][joint.type != PRISMATIC]
                self._add(
                    f'{joint.name} [{unit}]',
                    *self._range_of(model, joint, what, limit),
                    self._setter(model, joint.name, what),
                )

    def _add_topic(self, topic: CommandTopic, limit: float) -> None:
        """Add the sliders of a topic, if there is room for all; a command has all their values.

        Positions begin where the joints stand, so that the first command moves one joint only.
        """
        names = topic.joints or ('',)
        if len(self._sliders) + len(names) > MOST:
            return
        model, specs = self._model_of(topic.joints) if topic.are_positions else ('', {})
        places = [
            self._range_of(model, specs[name], POSITION, limit)
            if name in specs
            else ((-limit, limit), 0.0)
            for name in names
        ]
        values = [value for _, value in places]

        def command(index: int, value: float) -> None:
            values[index] = value
            self._joints.command(topic, tuple(values))

        for index, (name, (limits, value)) in enumerate(zip(names, places, strict=True)):
            self._add(f'{topic.name} {name}'.rstrip(), limits, value, partial(command, index))

    def _model_of(self, joints: Sequence[str]) -> tuple[str, dict[str, JointSpec]]:
        """Return the first model with these joints, and its joints by name; else '', {}."""
        for model in tuple(self._models.all.values()):
            specs = {joint.name: joint for joint in model.joints}
            if specs.keys() >= set(joints):
                return model.name, specs
        return '', {}

    def _range_of(
        self, model: str, joint: JointSpec, what: str, limit: float
    ) -> tuple[tuple[float, float], float]:
        """Return the least and greatest value of a joint's slider, and where it stands."""
        if what == VELOCITY:
            return (-limit, limit), 0.0
        if what == EFFORT:
            greatest = joint.effort or limit
            return (-greatest, greatest), 0.0
        try:
            now = self._joints.position(model, joint.name)
        except SimError:  # it is being deleted
            now = 0.0
        open_end = 1.0 if joint.type == PRISMATIC else math.pi
        low = -open_end if joint.lower is None else joint.lower
        high = open_end if joint.upper is None else joint.upper
        if joint.type != PRISMATIC and joint.lower is None and joint.upper is None:
            now = math.remainder(now, math.tau)
        return (low, max(high, low + 1e-6)), now

    def _setter(self, model: str, joint: str, what: str) -> Callable[[float], None]:
        if what == VELOCITY:
            return lambda value: self._joints.set_velocity(
                model, joint, value, float(self._force.value)
            )
        command = self._joints.set_position if what == POSITION else self._joints.set_effort
        return partial(command, model, joint)

    def _add(
        self,
        label: str,
        limits: tuple[float, float],
        value: float,
        command: Callable[[float], None],
    ) -> None:
        low, high = limits
        sent = [min(max(value, low), high)]

        def send(event: viser.GuiEvent[viser.GuiSliderHandle[float]]) -> None:
            with self._lock:  # one after the other, and of those that wait the newest
                now = event.target.value
                if event.client is not None and now != sent[0]:
                    sent[0] = now
                    attempt(lambda: command(float(now)), self._complain)

        with self._folder, self._client.atomic():  # not moved before it is listened to
            slider = self._client.gui.add_slider(
                plain(label), low, high, (high - low) / STEPS, sent[0]
            )
            slider.on_update(send)
        self._sliders.append(slider)

    def _let_go(self) -> None:
        with self._lock:
            model = self._shown[0]
            for joint in self._specs(model):
                attempt(
                    partial(self._joints.set_velocity, model, joint.name, 0.0, 0.0), self._complain
                )
                attempt(partial(self._joints.set_effort, model, joint.name, 0.0), self._complain)
            self._build()
