"""One run of a scenario with the running /gazebo: models, commands and records go over ROS.

The world is that of the running simulator; physics is paused while models are spawned and topics
are connected. Times are those of /clock, so a run is as exact as the messages are fast.
"""

from __future__ import annotations

import contextlib
import time
from collections.abc import Callable, Mapping
from typing import Any

import genpy.message
import roslib.message
import rospy

from ...batch import (
    ModelEntry,
    Policy,
    RecordEntry,
    Run,
    Scenario,
    ScenarioError,
    ScenarioFile,
    check_vectors,
    commands_of,
    load_policy,
)
from ..messages import read_reading
from .scenario_services import delete, paused, spawn, true_state

DEADLINE = 10.0  # for a connection, which takes a fraction of it [s, wall]


def run_scenario(file: ScenarioFile, number: int) -> dict[str, Any]:
    """Make one run; return its parameters and what was recorded, by column.

    Raises:
        SimError: it could not be made; the message says why.
        PolicyError: its policy raised.
        AssertionError: a condition does not hold; the message has the numbers.

    Subscribes, Publishes:
        the topics of its records, commands and policy
    Calls:
        /gazebo/pause_physics, unpause_physics, spawn_urdf_model, spawn_sdf_model, delete_model,
        get_model_state, get_link_state, get_joint_properties
    """
    run = file.parameters.run(number)
    scenario = file.scenario(run)
    conditions = file.conditions(scenario)
    row = {**run.parameters, **_Run(file, run, scenario).columns()}
    for condition in conditions:
        fault = condition.fault(row)
        assert not fault, fault
    return row


class _Run:
    """The models, topics and records of one run."""

    def __init__(self, file: ScenarioFile, run: Run, scenario: Scenario) -> None:
        self._file, self._run, self._scenario = file, run, scenario
        self._records = scenario.records()
        self._publishers: dict[str, rospy.Publisher] = {}
        self._end = contextlib.ExitStack()
        self._fault: ScenarioError | None = None

    def columns(self) -> dict[str, float | None]:
        """Make the run; return what was recorded."""
        with self._end:
            with paused():
                for model in self._scenario.models:
                    self._spawn(model)
                for name, record in self._scenario.record.items():
                    if record.topic:
                        self._subscribe(name, record)
                for command in self._scenario.commands:
                    self._publisher(command.topic)
            self._advance()
        return self._records.columns()

    def _spawn(self, model: ModelEntry) -> None:
        spawn(model, model.text or self._file.locate(model.file))
        self._end.callback(delete, model.name)

    def _subscribe(self, name: str, record: RecordEntry) -> None:
        def receive(message: genpy.Message) -> None:
            try:
                self._records.take(name, read_reading(message))
            except ValueError as error:
                self._fault = ScenarioError(f"record '{name}': {error}")

        message_class = _message_class(record.topic, f"record '{name}'")
        subscriber = rospy.Subscriber(
            _global(record.topic), message_class, receive, tcp_nodelay=True
        )
        self._end.callback(subscriber.unregister)
        _wait(
            subscriber.get_num_connections,
            f"record '{name}': nothing is sent on the topic '{record.topic}'",
        )

    def _publisher(self, topic: str) -> rospy.Publisher:
        """Return what sends to a topic, connected."""
        if topic not in self._publishers:
            publisher = rospy.Publisher(
                _global(topic), _message_class(topic, 'commands'), queue_size=10, tcp_nodelay=True
            )
            self._end.callback(publisher.unregister)
            _wait(publisher.get_num_connections, f"nothing takes commands on the topic '{topic}'")
            self._publishers[topic] = publisher
        return self._publishers[topic]

    def _advance(self) -> None:
        """Wait for the end, with commands and records in between; the policy acts first."""
        scenario, begin = self._scenario, rospy.get_time()
        policy = (
            load_policy(scenario.policy, self._file.folder, self._run) if scenario.policy else None
        )
        commands = sorted(scenario.commands, key=lambda command: command.at)
        ticks = 0
        while True:
            now = rospy.get_time() - begin
            if self._fault:
                raise self._fault
            is_over = now >= scenario.duration
            if is_over or now >= ticks * scenario.period:
                ticks = int(now / scenario.period) + 1
                self._read_states()
                if policy and not is_over:
                    self._act(policy, now)
            while commands and now >= commands[0].at:
                command = commands.pop(0)
                self._send(command.topic, command.message)
            if is_over:
                return
            soon = min(
                [
                    ticks * scenario.period,
                    scenario.duration,
                    *(command.at for command in commands[:1]),
                ]
            )
            rospy.sleep(max(1e-3, soon - (rospy.get_time() - begin)))

    def _read_states(self) -> None:
        for name, record in self._scenario.record.items():
            if record.model:
                try:
                    self._records.take(name, true_state(record))
                except ValueError as error:
                    raise ScenarioError(f"record '{name}': {error}") from None

    def _act(self, policy: Policy, now: float) -> None:
        commands = commands_of(policy, self._scenario.policy, now, self._records.newest)
        if not set(commands) <= set(self._publishers):
            with paused():
                for topic in commands:
                    self._publisher(topic)
        for topic, message in commands.items():
            self._send(topic, message)

    def _send(self, topic: str, content: Mapping[str, Any]) -> None:
        publisher = self._publisher(topic)
        message = publisher.data_class()
        try:
            check_vectors(content, tuple(message.__slots__))
            genpy.message.fill_message_args(message, [dict(content)])
        except (ValueError, genpy.MessageException) as error:
            raise ScenarioError(f"the command to the topic '{topic}': {error}") from None
        publisher.publish(message)


def _global(topic: str) -> str:
    return '/' + topic.lstrip('/')


def _message_class(topic: str, where: str) -> type[genpy.Message]:
    """Return the type of a topic that is there, or comes soon."""
    found: list[type[genpy.Message]] = []

    def look() -> bool:
        types = dict(rospy.get_master().getTopicTypes()[2])
        found[:] = (
            [roslib.message.get_message_class(types[_global(topic)])]
            if _global(topic) in types
            else []
        )
        return bool(found)

    _wait(look, f"{where}: there is no topic '{topic}'")
    return found[0]


def _wait(condition: Callable[[], object], fault: str) -> None:
    """Wait for a condition; simulated time may be paused."""
    end = time.monotonic() + DEADLINE
    while not condition():
        if time.monotonic() > end or rospy.is_shutdown():
            raise ScenarioError(fault)
        time.sleep(0.005)
