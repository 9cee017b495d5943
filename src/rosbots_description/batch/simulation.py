"""One run of a scenario in a world of its own, and the row that comes of it."""

import contextlib
import logging
import math
from collections.abc import Iterator
from dataclasses import asdict
from functools import partial
from typing import Any

from ..sim import Fault, Joint, Link, Model, Odometry, SimError, World
from ..sim.core import MOST_FAULTS, NANOSECONDS, one_line
from .parameters import Run
from .policy import Policy, PolicyError, commands_of, in_words, load_policy
from .records import JointReading
from .scenario import RecordEntry, Scenario, ScenarioError, ScenarioFile
from .topics import Topics

PASSED, FAILED, ERROR = 'passed', 'failed', 'error'


def simulate(file: ScenarioFile, number: int) -> dict[str, Any]:
    """Make one run; return its row, whatever happens.

    The outcome is `passed`; `failed`, by a condition that does not hold; or `error`, if the run
    could not be made or its world reported an error. `reason` says why in one line.
    """
    run = file.parameters.run(number)
    row = empty_row(file, run)
    try:
        scenario = file.scenario(run)
        conditions = file.conditions(scenario)
        simulation = _Simulation(file, run, scenario)
        row['faults'] = simulation.faults
        row |= simulation.columns()
        if simulation.faults:
            raise ScenarioError(str(Fault(**simulation.faults[0])))
        faults = filter(None, (condition.fault(row) for condition in conditions))
        reason = next(faults, '')
    except (SimError, PolicyError, ValueError, OSError) as error:
        return {**row, 'outcome': ERROR, 'reason': one_line(str(error))}
    except Exception as error:  # one run must not end the others
        return {**row, 'outcome': ERROR, 'reason': one_line(in_words(error))}
    return {**row, 'outcome': FAILED if reason else PASSED, 'reason': one_line(reason)}


def empty_row(file: ScenarioFile, run: Run) -> dict[str, Any]:
    """Return the row of a run of which nothing is known but its parameters."""
    return {
        'run': run.number,
        'seed': run.seed,
        'outcome': ERROR,
        'reason': '',
        'faults': [],
        **run.parameters,
        **dict.fromkeys(file.columns),
    }


class _Simulation:
    """The world of one run."""

    def __init__(self, file: ScenarioFile, run: Run, scenario: Scenario) -> None:
        self._file, self._run, self._scenario = file, run, scenario
        self.faults: list[dict[str, Any]] = []
        self._records = scenario.records()
        self._fault: ScenarioError | None = None
        self._models: dict[str, Model | Link | Joint] = {}  # what is recorded of the world

    def columns(self) -> dict[str, float | None]:
        """Simulate; return what was recorded."""
        scenario, locate = self._scenario, self._file.locate
        with World.from_file(
            locate(scenario.world), seed=self._run.seed, on_fault=self._keep
        ) as world:
            for model in scenario.models:
                world.spawn(
                    model.text or locate(model.file),
                    model.name,
                    model.pose.pose(),
                    arguments=model.xacro_arguments(),
                )
            self._topics = Topics(world)
            for name, record in scenario.record.items():
                self._open(world, name, record)
            self._advance(world)
        return self._records.columns()

    def _keep(self, fault: Fault) -> None:
        """Keep an error; which warnings come may depend on what this process has read before."""
        if fault.severity >= logging.ERROR and len(self.faults) < MOST_FAULTS:
            self.faults.append(asdict(fault))

    def _open(self, world: World, name: str, record: RecordEntry) -> None:
        """Begin to record."""
        with _within(f"record '{name}'"):
            if record.topic:
                for output in self._topics.outputs(record.topic):
                    output.connect(partial(self._receive, name))
                return
            model = world.model(record.model)
            if record.joint:
                self._models[name] = model.joint(record.joint)
            else:
                self._models[name] = model.link(record.link) if record.link else model

    def _receive(self, name: str, reading: object) -> None:
        """Record a reading of a topic; the world would log an exception, and go on."""
        try:
            self._take(name, reading)
        except ScenarioError as error:
            self._fault = self._fault or error

    def _take(self, name: str, reading: object) -> None:
        with _within(f"record '{name}'"):
            self._records.take(name, reading)

    def _advance(self, world: World) -> None:
        """Run to the end, with commands and records in between; the policy acts first."""
        scenario, begin = self._scenario, world.clock.steps  # not 0 in a world that was saved
        steps = _StepsOf(scenario, world)
        policy = (
            load_policy(scenario.policy, self._file.folder, self._run) if scenario.policy else None
        )
        for step in steps.all:
            world.run(begin + step - world.clock.steps)
            if self._fault:
                raise self._fault
            if step in steps.ticks or step == steps.end:
                for name, thing in self._models.items():
                    self._take(name, _state(thing))
            if step == steps.end:
                break
            if policy and step in steps.ticks:
                self._act(policy, step * world.clock.step_ns / NANOSECONDS)
            for index in steps.commands.get(step, ()):
                command = scenario.commands[index]
                with _within(f'commands[{index}]'):
                    self._topics.send(command.topic, command.message)

    def _act(self, policy: Policy, time: float) -> None:
        address = self._scenario.policy
        for topic, message in commands_of(policy, address, time, self._records.newest).items():
            with _within(f"the policy '{address}' at {time:g} s, topic '{topic}'"):
                self._topics.send(topic, message)


class _StepsOf:
    """The steps at which something is done in a run, counted from its beginning."""

    def __init__(self, scenario: Scenario, world: World) -> None:
        size = world.physics.step_size
        period = max(scenario.period, size)
        self.end = max(1, round(scenario.duration / size))
        self.ticks = {
            tick
            for index in range(math.ceil(scenario.duration / period))
            if (tick := round(index * period / size)) < self.end
        }
        self.commands: dict[int, list[int]] = {}  # indices of the commands
        for index, command in sorted(enumerate(scenario.commands), key=lambda one: one[1].at):
            self.commands.setdefault(round(command.at / size), []).append(index)
        self.all = sorted({*self.ticks, self.end, *self.commands})


def _state(thing: Model | Link | Joint) -> Odometry | JointReading:
    state = thing.state()
    return JointReading(*state) if isinstance(thing, Joint) else Odometry(*state)


@contextlib.contextmanager
def _within(place: str) -> Iterator[None]:
    """Name the place of the scenario in an error."""
    try:
        yield
    except (SimError, ValueError) as error:
        raise ScenarioError(f'{place}: {error}') from None
