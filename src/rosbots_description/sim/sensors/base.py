"""Base classes of sensors, and of the plugins that publish their readings."""

import logging
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any, Generic, TypeVar

from ..core import MIN_UPDATE_RATE, NANOSECONDS, FaultPlace, PluginError, Pose, compose
from ..description import PluginSpec, SensorSpec
from ..plugin_registry import register_sensor
from ..plugins import ModelPlugin
from ..runtime import NEVER, Output, SensorPart
from .noise import RandomSteps

if TYPE_CHECKING:
    from ..runtime import Link, World

Reading = TypeVar('Reading')


class DueTimes:
    """The times t0 + k / rate, computed from the integer k, so that they never drift."""

    def __init__(self, rate: float, what: str, now_ns: int) -> None:
        """Begin at `now_ns` with a rate [Hz]; 0 or less means at every time.

        Raises:
            PluginError: the rate is too low; the message names `what`, e.g. '<updateRate>'.
        """
        if 0.0 < rate < MIN_UPDATE_RATE:
            raise PluginError(
                f'{what} is {rate:g} Hz; it must be at least {MIN_UPDATE_RATE:g}, '
                'or 0 for every step'
            )
        self._period_ns = NANOSECONDS / rate if rate > 0.0 else 0.0
        self.begin(now_ns)

    def begin(self, now_ns: int) -> None:
        """Set t0 to `now_ns`; the first time is one period later."""
        self._begin_ns = now_ns

    def after(self, now_ns: int) -> int:
        """Return the first time later than `now_ns` [ns]."""
        if not self._period_ns:
            return now_ns + 1
        passed = (now_ns - self._begin_ns) / self._period_ns
        return self._begin_ns + round((int(passed + 1e-6) + 1) * self._period_ns)


class Sensor(SensorPart):
    """Measures at its own rate while its output has readers; otherwise it costs nothing.

    A subclass is registered by `register_sensor(type)`, reads its elements in `load`, and returns a
    reading from `measure`, an immutable value. A sensor of an unregistered type is kept, but does
    not measure.
    """

    measures = True
    is_noisy = False  # whether its <noise> has a deviation
    noise_scale = 1.0  # factor on that deviation, which may be set between two runs

    def __init__(self, world: 'World', link: 'Link', spec: SensorSpec) -> None:
        self.world = world
        self.link = link
        self.model = link.model
        self.spec = spec
        self.name = spec.name
        self.scoped_name = f'{link.scoped_name}::{spec.name}'
        self.called = f"{spec.type or 'sensor'} '{spec.name}' of link '{link.name}'"
        self.readings: Output[Any] = Output(self.count_readers)
        self.random = RandomSteps(world, self.scoped_name)

    @property
    def place(self) -> FaultPlace:
        """Return where this is, for its faults."""
        called, line = f"{self.spec.type or 'sensor'} '{self.name}'", self.spec.element.line
        return {'model': self.model.name, 'link': self.link.name, 'element': called, 'line': line}

    @property
    def pose(self) -> Pose:
        """Return the sensor's pose in the world."""
        return compose(self.link.pose, self.spec.pose)

    def start(self) -> None:
        """Load and begin."""
        self._times = DueTimes(self.spec.update_rate, '<update_rate>', self.world.clock.now_ns)
        self.load()
        self.restart()

    def load(self) -> None:
        """Read the settings in `spec.element`.

        Raises:
            PluginError: a number is out of range.
        """

    def measure(self) -> object:
        """Return a reading of the current state, at the end of a step."""
        raise NotImplementedError

    def read(self) -> Any:  # noqa: ANN401  each type of sensor has its own readings
        """Return a reading of the current state, independent of the rate.

        Raises:
            PluginError: sensors of this type are not simulated.
        """
        if not self.measures:
            raise PluginError(f'{self.called}: sensors of this type are not simulated')
        return self.measure()

    def shared(self) -> Iterable[object]:
        """Return description and output."""
        return (self.spec, self.readings)

    def restart(self) -> None:
        """Restart the schedule of readings at the current time."""
        self._times.begin(self.world.clock.now_ns)
        self.count_readers()
        self.reset()

    def before_step(self) -> None:
        """Request a reading after physics, so that it matches the stamp of the step."""
        self.runs_after_step = self.readings.wanted
        self.count_readers()

    def after_step(self) -> None:
        """Send a reading to the readers."""
        self.send(self.measure())

    def send(self, reading: object) -> None:
        """Send a reading, and count it."""
        self.count += 1
        self.last_ns = self.world.clock.now_ns
        self.readings.send(reading)

    def count_readers(self) -> None:
        """Set the next due step, or NEVER without readers."""
        clock = self.world.clock
        if self.readings.wanted and self.measures:
            step = clock.first_step_after(self._times.after(clock.now_ns) - 1)
            self.due = max(clock.steps + 1, step)
        else:
            self.due = NEVER


@register_sensor('')
class UnsupportedSensor(Sensor):
    """A sensor of a type that is not simulated."""

    measures = False


class LogsDefaults:
    """A plugin that logs the default of a missing tag as information, in upstream's words."""

    missing = staticmethod('missing <{}>, defaults to {}'.format)
    missing_level = logging.INFO


class SensorPlugin(ModelPlugin, Generic[Reading]):
    """A plugin in a <sensor>: it takes the sensor's readings while its outputs have readers.

    A subclass is registered by `register_in_sensor(library)`, sets `sensor_class` to the sensors
    that it supports, reads its tags and makes its outputs in `load`, and sends to them in
    `process`. `rate` limits the rate of its readings [Hz]; 0 means no limit.
    """

    sensor_class: type[Sensor] = Sensor
    rate = 0.0
    rate_tag = 'updateRate'

    def __init__(self, sensor: Sensor, spec: PluginSpec) -> None:
        super().__init__(sensor.world, sensor.model, spec)
        self.sensor = sensor
        self._receiving = False
        self.random = RandomSteps(self.world, f'{sensor.scoped_name}::{spec.name}')

    @property
    def place(self) -> FaultPlace:
        """Return where this is, for its faults."""
        return {**super().place, 'link': self.sensor.link.name}

    def start(self) -> None:
        """Load and begin.

        Raises:
            PluginError: the sensor is of an unsupported type.
        """
        if not isinstance(self.sensor, self.sensor_class):
            raise PluginError(
                f'{self.spec.filename} does not work in a <sensor> of type '
                f"'{self.sensor.spec.type}'"
            )
        super().start()

    def restart(self) -> None:
        """Restart the schedule of readings at the current time."""
        self._times = DueTimes(self.rate, f'<{self.rate_tag}>', self.world.clock.now_ns)
        self._wake()
        self.reset()

    def process(self, reading: Reading) -> None:
        """Send the outputs for a reading of the sensor."""
        raise NotImplementedError

    def readers_changed(self) -> None:
        """Take readings while any output has readers."""
        readings = self.sensor.readings
        if not self.is_read:
            readings.disconnect(self._receive)
        elif not readings.is_read_by(self._receive):
            readings.connect(self._receive)
        if self.is_read and not self._receiving:
            self._wake()
        self._receiving = self.is_read

    def _wake(self) -> None:
        """Resume on the original schedule, as if readings had never stopped."""
        self._next_ns = self._times.after(self.world.clock.now_ns)

    def _receive(self, reading: Reading) -> None:
        stamp_ns = self.stamp_of(reading)
        if stamp_ns >= self._next_ns:
            self._next_ns = self._times.after(stamp_ns)
            self.process(reading)

    def stamp_of(self, _reading: Reading) -> int:
        """Return the time of a reading [ns]."""
        return self.world.clock.now_ns
