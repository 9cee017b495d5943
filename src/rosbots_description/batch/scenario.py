"""A scenario: the YAML file, and what it says for one run."""

import hashlib
import json
import math
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any, Self

import msgspec
from msgspec import Meta, Struct

from ..sim import Pose, SimError, from_rpy
from ..sim.core import one_line
from .conditions import Condition
from .parameters import Parameters, Run, substitute
from .records import Records
from .yaml_file import read_yaml

MIN_PERIOD = 0.001  # [s] a shorter one is a step, which is not much shorter in any world
MAX_PERIODS = 10_000_000  # of a run, in each of which records are taken
Positive = Annotated[float, Meta(gt=0.0)]


class ScenarioError(SimError):
    """A scenario that cannot be run as written."""


class PoseEntry(Struct, frozen=True, forbid_unknown_fields=True):
    """A pose in the world: position [m], and roll, pitch and yaw about fixed axes [rad]."""

    x: float = 0.0
    y: float = 0.0
    z: float = 0.0
    roll: float = 0.0
    pitch: float = 0.0
    yaw: float = 0.0

    def pose(self) -> Pose:
        """Return it as the simulator has it."""
        return Pose((self.x, self.y, self.z), from_rpy(self.roll, self.pitch, self.yaw))


class ModelEntry(Struct, frozen=True, forbid_unknown_fields=True):
    """A model to spawn: a URDF, xacro or SDF as a file, an address or a text."""

    name: str
    file: str = ''  # a path, package:// or model://
    text: str = ''
    pose: PoseEntry = PoseEntry()
    arguments: dict[str, str | int | float | bool] = {}  # for xacro

    def xacro_arguments(self) -> dict[str, str]:
        """Return the arguments as xacro takes them."""
        return {
            name: str(value).lower() if isinstance(value, bool) else str(value)
            for name, value in self.arguments.items()
        }


class CommandEntry(Struct, frozen=True, forbid_unknown_fields=True):
    """A message to a topic at a time [s, simulated]; fields that are left out are 0."""

    at: Annotated[float, Meta(ge=0.0)]
    topic: str
    message: dict[str, dict[str, float]] = {}


class RecordEntry(Struct, frozen=True, forbid_unknown_fields=True):
    """A quantity to record: of a topic's readings, or of a model, its link or its joint."""

    value: str = ''  # e.g. pose.position.x; '': for the policy alone
    topic: str = ''
    model: str = ''
    link: str = ''
    joint: str = ''

    def check(self, name: str) -> None:
        """Raise a `ScenarioError` for what its types leave open; `name` is the record's."""
        if not name.isidentifier():
            raise ScenarioError(
                f"'{name}' cannot be the name of a record; use letters, digits and _"
            )
        if bool(self.topic) == bool(self.model):
            raise ScenarioError(f"record '{name}' takes either topic or model")
        if (self.link or self.joint) and (self.topic or (self.link and self.joint)):
            raise ScenarioError(f"record '{name}' takes link or joint, of a model")
        if self.model and not self.value:
            raise ScenarioError(f"record '{name}' needs a value, such as pose.position.x")


class Scenario(Struct, frozen=True, forbid_unknown_fields=True):
    """What one run does; all parameters have values."""

    duration: Positive  # [s, simulated]
    world: str = 'empty'
    models: list[ModelEntry] = []
    commands: list[CommandEntry] = []
    policy: str = ''  # module:function or file.py:function
    period: Positive = 0.1  # of the policy, and of records of models [s, simulated]
    record: dict[str, RecordEntry] = {}
    conditions: list[str] = []

    def check(self) -> None:
        """Raise a `ScenarioError` for what its types leave open."""
        for model in self.models:
            if bool(model.file) == bool(model.text):
                raise ScenarioError(f"model '{model.name}' takes either file or text")
        for name, record in self.record.items():
            record.check(name)
        for index, command in enumerate(self.commands):
            if command.at >= self.duration:
                raise ScenarioError(
                    f'commands[{index}] is at {command.at:g} s; the run ends at {self.duration:g} s'
                )
        if not all(map(math.isfinite, (self.duration, self.period))):
            raise ScenarioError('duration and period take finite numbers of seconds')
        if self.duration > MAX_PERIODS * max(self.period, MIN_PERIOD):
            raise ScenarioError(
                f'the duration of {self.duration:g} s has more than {MAX_PERIODS} '
                f'periods of {self.period:g} s; take a longer period'
            )

    def records(self) -> Records:
        """Return what takes the readings of a run."""
        return Records({name: record.value for name, record in self.record.items()})


class ScenarioFile:
    """A scenario with its parameters, as it is written; `scenario` gives what one run does."""

    def __init__(
        self,
        document: Mapping[str, Any],
        folder: str | os.PathLike[str] = '.',
        parameters: Mapping[str, Any] | None = None,
    ) -> None:
        """Take the content of a YAML file; paths in it are relative to `folder`.

        `parameters` replace those of the same name.

        Raises:
            ScenarioError: it is not a scenario; the message says where and why.
        """
        self.folder = os.path.abspath(folder)
        rest = dict(document)
        given = rest.pop('parameters', None) or {}
        if parameters and isinstance(given, Mapping):
            given = {**given, **parameters}
        try:
            self.parameters = Parameters(given, rest.pop('seed', 0), rest.pop('repeat', 1))
        except ValueError as error:
            raise ScenarioError(str(error)) from None
        self._rest = rest
        first = self.scenario(self.parameters.run(0))
        self.columns = list(first.records().columns())
        taken = {'run', 'seed', 'outcome', 'reason', 'faults', *self.columns} & set(
            self.parameters.names
        )
        if taken:
            raise ScenarioError(f"the parameter '{min(taken)}' has the name of a column; rename it")
        self.conditions(first)

    @classmethod
    def read(
        cls, path: str | os.PathLike[str], parameters: Mapping[str, Any] | None = None
    ) -> Self:
        """Return the scenario of a YAML file; `parameters` replace those of the same name.

        Raises:
            ScenarioError: the file cannot be read, or is not a scenario.
        """
        try:
            document = read_yaml(path)
        except (OSError, ValueError) as error:
            raise ScenarioError(f'{path} cannot be read: {one_line(str(error))}') from None
        if not isinstance(document, dict):
            raise ScenarioError(
                f'{path} is not a scenario; a scenario is a YAML mapping with at least a duration'
            )
        try:
            return cls(document, Path(path).resolve().parent, parameters)
        except ScenarioError as error:
            raise ScenarioError(f'{path}: {error}') from None

    def scenario(self, run: Run) -> Scenario:
        """Return what one run does.

        Raises:
            ScenarioError: with its parameters it is not valid.
        """
        try:
            filled = substitute(self._rest, run.parameters)
            scenario = msgspec.convert(filled, Scenario, strict=True)
        except msgspec.ValidationError as error:
            raise ScenarioError(_in_words(str(error))) from None
        except ValueError as error:
            raise ScenarioError(str(error)) from None
        scenario.check()
        return scenario

    def conditions(self, scenario: Scenario) -> list[Condition]:
        """Return the conditions of a run, of which `scenario` is given.

        Raises:
            ScenarioError: one of them is not an expression over its row.
        """
        try:
            return [
                Condition(text, [*self.columns, *self.parameters.names])
                for text in scenario.conditions
            ]
        except ValueError as error:
            raise ScenarioError(str(error)) from None

    def locate(self, path: str) -> str:
        """Return a path relative to the scenario's folder as absolute, if there is such a file."""
        inside = os.path.join(self.folder, path)
        return inside if os.path.exists(inside) else path

    @property
    def fingerprint(self) -> str:
        """Return a text that differs from that of scenarios with other rows."""
        content = json.dumps([self._rest, self.parameters.content], sort_keys=True, default=str)
        return hashlib.sha256(content.encode()).hexdigest()


def _in_words(message: str) -> str:
    """Return msgspec's message, with the place first: `$.models[0].pose.x`."""
    fault, _, place = message.partition(' - at ')
    where = place.strip('`').removeprefix('$').removeprefix('.')
    return f'{where}: {fault}' if where else fault
