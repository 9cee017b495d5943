"""What every model plugin is: tags, outputs, a life beside its model, and work at a rate."""

import logging
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any

from ..core import NANOSECONDS, NotFoundError, PluginError, Pose
from ..description import PluginSpec
from ..runtime import NEVER, Output, Plugin
from .parameters import Missing, Params, says_default

if TYPE_CHECKING:
    from ..runtime import Joint, Link, Model, World

logger = logging.getLogger(__name__)


class ModelPlugin(Plugin):
    """Code that lives with a model: load, run in the steps it asks for, reset, unload.

    A subclass reads its tags from `params` in `load`. `outputs` has by name what it gives out;
    `is_read` tells whether anybody reads any of it.
    """

    prefix = ''  # how its log lines begin; {} stands for the namespace
    missing: Missing = staticmethod(says_default)
    missing_level = logging.WARNING  # at which that is said
    # The namespace where <robotNamespace> is absent, or empty; {} stands for the model's name.
    absent_namespace = empty_namespace = ''
    hints: Mapping[str, str] = {}  # by a tag that is not read: what to say of it

    def __init__(self, world: 'World', model: 'Model', spec: PluginSpec) -> None:
        self.world = world
        self.model = model
        self.spec = spec
        self.params = Params(spec.element, missing=self.missing, level=self.missing_level)
        self.params.ignore('alwaysOn')
        self.namespace = self.find_namespace(self.params.text('robotNamespace'))
        self.log_prefix = self.params.prefix = self.prefix.format(self.namespace)
        self.outputs: dict[str, Output[Any]] = {}
        self._all_outputs: list[Output[Any]] = []
        self.is_read = False

    def find_namespace(self, given: str | None) -> str:
        """Return the namespace of its topics for the text of <robotNamespace>, None if absent."""
        fallback = self.absent_namespace if given is None else self.empty_namespace
        return given or fallback.format(self.model.name)

    def start(self) -> None:
        """Load and begin; say which tags are not read."""
        self.load()
        unread = self.params.unread()
        if unread:
            logger.warning(
                '%snot read by this plugin: %s%s', self.log_prefix,
                ', '.join(f'<{tag}>' for tag in unread),
                ''.join(hint for tag, hint in self.hints.items() if tag in unread),
            )
        self.restart()

    def load(self) -> None:
        """Read the tags and find what the plugin works on.

        Raises:
            PluginError: a tag makes no sense, or something is missing.
        """

    def output(self, name: str, asked_for: bool = True) -> Output[Any]:
        """Return a new output; if the description asks for it, it has a place in `outputs`."""
        made: Output[Any] = Output(self.count_readers)
        self._all_outputs.append(made)
        if asked_for:
            self.outputs[name] = made
        return made

    def count_readers(self) -> None:
        """Take note of which outputs have readers."""
        self.is_read = any(output.wanted for output in self._all_outputs)
        self.readers_changed()

    def readers_changed(self) -> None:
        """Take note that an output has its first reader, or lost its last one."""

    def shared(self) -> Iterable[object]:
        """Return description, tags and outputs."""
        return (self.spec, self.params, *self._all_outputs)

    def link(self, tag: str) -> 'tuple[Link, Pose]':
        """Return the link that a tag names, or what it was reduced into, and its pose in that.

        Raises:
            PluginError: the tag is missing, or there is no such link.
        """
        name = self.params.required(tag)
        try:
            return self.model.locate(name)
        except NotFoundError as error:
            raise PluginError(
                f'{self.log_prefix}{tag}: {name} does not exist: {error}') from None

    def joint(self, name: str, what: str) -> 'Joint':
        """Return a joint by its name; `what` it is stands in the message of the `PluginError`."""
        try:
            return self.model.joint(name)
        except NotFoundError as error:
            raise PluginError(
                f"{self.log_prefix}couldn't get {what} joint named {name}: {error}"
            ) from None


class PeriodicPlugin(ModelPlugin):
    """A plugin that works at a rate: `update` before physics, `report` after it.

    A subclass calls `set_rate` in `load`; without that it works in every step. One that does
    nothing before physics only watches: it sleeps while nobody reads its outputs.
    """

    # A period ends in the first step that is later than its end, as in most of Gazebo's plugins;
    # False: also in a step at its end.
    later = True
    keeps_rate = True  # the mean rate is exact; False: a period begins in the step that ended one
    every_step = False  # also calls `before_each_step` and `after_each_step`
    _period_ns = 0

    def __init__(self, world: 'World', model: 'Model', spec: PluginSpec) -> None:
        super().__init__(world, model, spec)
        cls, base = type(self), PeriodicPlugin
        acts = cls.update, cls.before_each_step
        self._acts = acts != (base.update, base.before_each_step)

    def set_rate(self, rate: float) -> None:
        """Work at this rate [Hz] from the next period on; not above 0: in every step."""
        self._period_ns = round(NANOSECONDS / rate) if rate > 0.0 else 0

    def update(self, elapsed: float) -> None:
        """Act before physics; the last time was `elapsed` [s] ago."""

    def report(self) -> None:
        """Send readings of the state at the end of the step, which is that at its stamp.

        It is called only if somebody reads an output.
        """

    def before_each_step(self, now_ns: int) -> None:
        """Act before physics in every step, at the time `now_ns` [ns]."""

    def after_each_step(self, now_ns: int) -> None:
        """Read in every step what physics made of it, at the time `now_ns` [ns]."""

    def wake(self) -> None:
        """Begin to watch, after a time in which nobody read."""

    def restart(self) -> None:
        """Begin a period, and as `reset` begins."""
        self.begin_period()
        self.reset()

    def begin_period(self) -> None:
        """Let a period begin now."""
        self._last_ns = self.world.clock.now_ns
        self._reports = False
        self._set_due()

    def before_step(self) -> None:
        """Do what is due before physics."""
        now_ns = self.world.clock.now_ns
        if self.every_step:
            self.before_each_step(now_ns)
        elapsed_ns = now_ns - self._last_ns
        self._reports = elapsed_ns >= self._period_ns + self.later
        self.watches = self.every_step or (self._reports and self.is_read)
        if self._reports:
            self.update(elapsed_ns / NANOSECONDS)
            keeps = self._period_ns and self.keeps_rate
            self._last_ns = self._last_ns + self._period_ns if keeps else now_ns
        self._set_due()

    def after_step(self) -> None:
        """Do what is due after physics."""
        if self.every_step:
            self.after_each_step(self.world.clock.now_ns)
        if self._reports and self.is_read:
            self.report()

    def readers_changed(self) -> None:
        """Fall asleep, or wake up in the rhythm that there would be without having slept."""
        if self.due == NEVER:
            behind = self.world.clock.now_ns - self._last_ns - self.later
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
            end = clock.first_step_after(self._last_ns + self._period_ns + self.later - 1)
            self.due = max(clock.steps + 1, end)
