"""Base classes of model plugins: tags, outputs, lifecycle, and an update rate."""

import logging
import math
import re
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any

from ..core import (
    NANOSECONDS,
    Fault,
    FaultPlace,
    NotFoundError,
    PluginError,
    Pose,
    Quaternion,
    Vector,
    conjugate,
    from_rpy,
    multiply,
    report,
    rotate,
    subtract,
    to_rpy,
)
from ..description import PluginSpec
from ..runtime import NEVER, Output, Plugin
from .parameters import Missing, Params, says_default

if TYPE_CHECKING:
    from ..runtime import Joint, Link, Model, World


class ModelPlugin(Plugin):
    """Code that runs with a model: load, run in the requested steps, reset, unload.

    A subclass reads its tags from `params` in `load`. `outputs` maps names to its outputs;
    `is_read` tells whether any of them has a reader.
    """

    prefix = ''  # of its log messages; {} is the namespace
    missing: Missing = staticmethod(says_default)
    missing_level = logging.WARNING  # log level of that message
    # The namespace if <robotNamespace> is absent or empty; {} is the model's name.
    absent_namespace = empty_namespace = ''
    hints: Mapping[str, str] = {}  # unread tag -> remark about it
    # Name of an output, or `command` for the method that a message calls -> topic in the namespace,
    # in which <tag> stands for the value of that tag.
    topic_names: Mapping[str, str] = {}

    def __init__(self, world: 'World', model: 'Model', spec: PluginSpec) -> None:
        self.world = world
        self.model = model
        self.spec = spec
        self.params = Params(spec.element, self.missing, self.missing_level)
        self.params.ignore('alwaysOn')
        self.namespace = self.find_namespace(self.params.text('robotNamespace'))
        self.log_prefix = self.params.prefix = self.prefix.format(self.namespace)
        self.outputs: dict[str, Output[Any]] = {}
        self._all_outputs: list[Output[Any]] = []
        self.is_read = False

    @property
    def place(self) -> FaultPlace:
        """Return where this is, for its faults."""
        element = f"plugin '{self.name}'"
        return {'model': self.model.name, 'element': element, 'line': self.spec.element.line}

    def find_namespace(self, given: str | None) -> str:
        """Return the namespace of its topics, given the text of <robotNamespace> (None: absent)."""
        fallback = self.absent_namespace if given is None else self.empty_namespace
        return given or fallback.format(self.model.name)

    def topic(self, name: str) -> str:
        """Return the global name of one of its `topic_names`, for a server without a namespace."""
        topic = self.params.fill(self.topic_names[name])
        return re.sub('/+', '/', topic if topic.startswith('/') else f'/{self.namespace}/{topic}')

    def start(self) -> None:
        """Load and start; report the tags that were not read."""
        self.load()
        unread = self.params.unread()
        if unread:
            tags = ', '.join(f'<{tag}>' for tag in unread)
            hints = ''.join(hint for tag, hint in self.hints.items() if tag in unread)
            report(Fault(f'{self.log_prefix}not read by this plugin: {tags}{hints}'))
        self.restart()

    def load(self) -> None:
        """Read the tags, and find the links and joints to work on.

        Raises:
            PluginError: a tag is not valid, or something is missing.
        """

    def output(self, name: str, requested: bool = True) -> Output[Any]:
        """Return a new output; it is added to `outputs` if the description requests it."""
        made: Output[Any] = Output(self.count_readers)
        self._all_outputs.append(made)
        if requested:
            self.outputs[name] = made
        return made

    def count_readers(self) -> None:
        """Determine which outputs have readers."""
        self.is_read = any(output.wanted for output in self._all_outputs)
        self.readers_changed()

    def readers_changed(self) -> None:
        """Handle that an output got its first reader, or lost its last one."""

    def shared(self) -> Iterable[object]:
        """Return description, tags and outputs."""
        return (self.spec, self.params, *self._all_outputs)

    def link(self, tag: str, name: str | None = None) -> 'tuple[Link, Pose]':
        """Return the link that a tag names, or its parent after reduction, and the pose in that.

        Args:
            name: the value of the tag, if it was read already; else the tag is required.
        Raises:
            PluginError: the tag is missing, or there is no such link.
        """
        name = name or self.params.required(tag)
        try:
            return self.model.locate(name)
        except NotFoundError as error:
            raise PluginError(f'{self.log_prefix}{tag}: {name} does not exist: {error}') from None

    def joint(self, name: str, what: str) -> 'Joint':
        """Return a joint by its name; `what` describes it in the message of the `PluginError`."""
        try:
            return self.model.joint(name)
        except NotFoundError as error:
            raise PluginError(
                f"{self.log_prefix}couldn't get {what} joint named {name}: {error}"
            ) from None


class PeriodicPlugin(ModelPlugin):
    """A plugin with an update rate: `update` before physics, `report` after it.

    A subclass calls `set_rate` in `load`; by default it runs in every step. A plugin that does
    nothing before physics is suspended while its outputs have no readers.
    """

    # True: due at the first step with t > t_last + period, as in most of Gazebo's plugins;
    # False: with t >= t_last + period.
    strictly_after = True
    keeps_rate = True  # the mean rate is exact; False: a period starts where the last ended
    every_step = False  # also calls `before_each_step` and `after_each_step`
    _period_ns = 0

    def __init__(self, world: 'World', model: 'Model', spec: PluginSpec) -> None:
        super().__init__(world, model, spec)
        cls, base = type(self), PeriodicPlugin
        acts = cls.update, cls.before_each_step
        self._acts = acts != (base.update, base.before_each_step)

    def set_rate(self, rate: float) -> None:
        """Set the update rate [Hz] from the next period on; <= 0: every step."""
        self._period_ns = round(NANOSECONDS / rate) if rate > 0.0 else 0

    def update(self, elapsed: float) -> None:
        """Act before physics; `elapsed` [s] is the time since the last update."""

    def report(self) -> None:
        """Send readings of the state at the end of the step, which is the state at its stamp.

        It is called only if an output has a reader.
        """

    def before_each_step(self, now_ns: int) -> None:
        """Act before physics in every step, at the time `now_ns` [ns]."""

    def after_each_step(self, now_ns: int) -> None:
        """Read the state after physics in every step, at the time `now_ns` [ns]."""

    def wake(self) -> None:
        """Resume after a time without readers."""

    def restart(self) -> None:
        """Start a period, and reset."""
        self.begin_period()
        self.reset()

    def begin_period(self) -> None:
        """Start a period at the last multiple of it, so that equal rates are due in equal steps.

        Upstream's periods start when the plugin was loaded.
        """
        now_ns = self.world.clock.now_ns
        keeps = self._period_ns and self.keeps_rate
        self._last_ns = now_ns - now_ns % self._period_ns if keeps else now_ns
        self._reports = False
        self._set_due()

    def before_step(self) -> None:
        """Run what is due before physics."""
        now_ns = self.world.clock.now_ns
        if self.every_step:
            self.before_each_step(now_ns)
        elapsed_ns = now_ns - self._last_ns
        self._reports = elapsed_ns >= self._period_ns + self.strictly_after
        self.runs_after_step = self.every_step or (self._reports and self.is_read)
        if self._reports:
            self.update(elapsed_ns / NANOSECONDS)
            keeps = self._period_ns and self.keeps_rate
            self._last_ns = self._last_ns + self._period_ns if keeps else now_ns
        self._set_due()

    def after_step(self) -> None:
        """Run what is due after physics."""
        if self.every_step:
            self.after_each_step(self.world.clock.now_ns)
        if self._reports and self.is_read:
            self.report()

    def readers_changed(self) -> None:
        """Suspend, or resume in the phase that it would have without the suspension."""
        if self.due == NEVER:
            behind = self.world.clock.now_ns - self._last_ns - self.strictly_after
            if self._period_ns and self.keeps_rate:
                self._last_ns += max(0, behind // self._period_ns) * self._period_ns
            self.wake()
        self._set_due()

    def _set_due(self) -> None:
        clock = self.world.clock
        if not (self._acts or self.is_read):
            self.due = NEVER
        elif self.every_step:
            self.due = clock.steps + 1
        else:
            end = clock.first_step_after(self._last_ns + self._period_ns + self.strictly_after - 1)
            self.due = max(clock.steps + 1, end)


def offsets_in_gazebo(mount: Pose, xyz: Vector, rpy: Vector) -> tuple[Vector, Quaternion]:
    """Return the offsets of a body that fixed joint reduction merged, with sdformat 9's flaws.

    The plugin works on the parent. <xyzOffset> and <rpyOffset> should become the mount of the body
    on it, but the mount is subtracted, rotations are inverted, and radians are taken for degrees.

    Args:
        mount: of the body on its parent after reduction, by two fixed joints, as it was recorded.
        xyz: <xyzOffset> as written [m]; `rpy` likewise [rad].
    """
    back = conjugate(mount.orientation)
    turn = multiply(back, from_rpy(*map(math.radians, rpy)))
    return subtract(rotate(back, xyz), mount.position), from_rpy(*map(math.radians, to_rpy(turn)))
