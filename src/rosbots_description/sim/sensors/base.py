"""What every sensor is: a place on a link, a rate, readings; and the plugins that pass them on."""

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any, Generic, TypeVar

from ..core import NANOSECONDS, SLOWEST_RATE, PluginError, Pose, compose
from ..description import PluginSpec, SensorSpec
from ..plugin_registry import register_sensor
from ..plugins import ModelPlugin
from ..runtime import NEVER, Output, SensorLife
from .noise import RandomSteps

if TYPE_CHECKING:
    from ..runtime import Link, World

Reading = TypeVar('Reading')


class DueTimes:
    """The times k / rate after a beginning: k counts, so that they never drift."""

    _begin_ns = 0

    def __init__(self, rate: float, what: str) -> None:
        """Take a rate [Hz]; 0 or less: at all times.

        Raises:
            PluginError: that would be hardly ever; `what` has the rate, e.g. '<updateRate>'.
        """
        if 0.0 < rate < SLOWEST_RATE:
            raise PluginError(f'{what} is {rate:g} Hz; it must be at least {SLOWEST_RATE:g}, or 0 '
                              'for every step')
        self._period_ns = NANOSECONDS / rate if rate > 0.0 else 0.0

    def begin(self, now_ns: int) -> None:
        """Count from now on; the first of the times is one period later."""
        self._begin_ns = now_ns

    def after(self, now_ns: int) -> int:
        """Return the first of the times that is later than `now_ns` [ns]."""
        if not self._period_ns:
            return now_ns + 1
        passed = (now_ns - self._begin_ns) / self._period_ns
        return self._begin_ns + round((int(passed + 1e-6) + 1) * self._period_ns)


class Sensor(SensorLife):
    """Measures at its own rate while somebody reads; else it costs nothing.

    A subclass is registered by `register_sensor(type)`, reads its elements in `load`, and returns a
    reading in `measure`: a frozen value that nobody changes any more. One that is of no such class
    is kept, and measures nothing.
    """

    measures = True

    def __init__(self, world: 'World', link: 'Link', spec: SensorSpec) -> None:
        self.world = world
        self.link = link
        self.model = link.model
        self.spec = spec
        self.name = spec.name
        self.scoped_name = f'{link.scoped_name}::{spec.name}'
        self.called = f"{spec.type or 'sensor'} '{spec.name}' of link '{link.name}'"
        self.readings: Output[Any] = Output(self.count_readers)
        self.random = RandomSteps(world.seed, self.scoped_name)

    @property
    def pose(self) -> Pose:
        """Return where it is in the world."""
        return compose(self.link.pose, self.spec.pose)

    def start(self) -> None:
        """Load and begin."""
        self._times = DueTimes(self.spec.update_rate, '<update_rate>')
        self.load()
        self.restart()

    def load(self) -> None:
        """Read what stands in `spec.element`.

        Raises:
            PluginError: a number makes no sense.
        """

    def measure(self) -> object:
        """Return a reading of the world as it is now, at the end of a step."""
        raise NotImplementedError

    def read(self) -> Any:  # noqa: ANN401  each type of sensor has its own readings
        """Return a reading of the world as it is now, whatever the rate.

        Raises:
            PluginError: nothing measures as a sensor of this type does.
        """
        if not self.measures:
            raise PluginError(f'{self.called}: sensors of this type are not simulated')
        return self.measure()

    def shared(self) -> Iterable[object]:
        """Return description, output and what makes random numbers."""
        return (self.spec, self.readings, self.random)

    def restart(self) -> None:
        """Count the times of readings from now on."""
        self._times.begin(self.world.clock.now_ns)
        self.count_readers()
        self.reset()

    def before_step(self) -> None:
        """Have the reading taken after physics, so that it belongs to the stamp of the step."""
        self.watches = self.readings.wanted
        self.count_readers()

    def after_step(self) -> None:
        """Give a reading to those who want it."""
        self.give(self.measure())

    def give(self, reading: object) -> None:
        """Send a reading, and count it."""
        self.count += 1
        self.last_ns = self.world.clock.now_ns
        self.readings.send(reading)

    def count_readers(self) -> None:
        """Be due when the next reading is, or never while nobody reads."""
        clock = self.world.clock
        if self.readings.wanted:
            step = clock.first_step_after(self._times.after(clock.now_ns) - 1)
            self.due = max(clock.steps + 1, step)
        else:
            self.due = NEVER


@register_sensor('')
class KeptSensor(Sensor):
    """A sensor of a type that is not simulated."""

    measures = False


class SensorPlugin(ModelPlugin, Generic[Reading]):
    """A plugin in a <sensor>: it takes the sensor's readings while somebody reads its outputs.

    A subclass is registered by `register_in_sensor(library)`, names in `sensor_class` what it can
    stand in, reads its tags and makes its outputs in `load`, and sends to these in `take`. With
    `rate` it takes readings at that rate [Hz] at most.
    """

    sensor_class: type[Sensor] = Sensor
    rate = 0.0
    rate_tag = 'updateRate'

    def __init__(self, sensor: Sensor, spec: PluginSpec) -> None:
        super().__init__(sensor.world, sensor.model, spec)
        self.sensor = sensor
        self._taking = False
        self.random = RandomSteps(self.world.seed, f'{sensor.scoped_name}::{spec.name}')

    def start(self) -> None:
        """Load and begin.

        Raises:
            PluginError: it stands in a sensor of another type.
        """
        if not isinstance(self.sensor, self.sensor_class):
            raise PluginError(f"{self.spec.filename} does not work in a <sensor> of type "
                              f"'{self.sensor.spec.type}'")
        super().start()

    def restart(self) -> None:
        """Count the times of readings from now on."""
        self._times = DueTimes(self.rate, f'<{self.rate_tag}>')
        self._times.begin(self.world.clock.now_ns)
        self._wake()
        self.reset()

    def shared(self) -> Iterable[object]:
        """Return what makes random numbers, too."""
        return (*super().shared(), self.random)

    def take(self, reading: Reading) -> None:
        """Send what is made of a reading of the sensor."""
        raise NotImplementedError

    def readers_changed(self) -> None:
        """Have readings taken as long as somebody reads."""
        self.sensor.readings.disconnect(self._take)
        if self.is_read:
            self.sensor.readings.connect(self._take)
            if not self._taking:
                self._wake()
        self._taking = self.is_read

    def _wake(self) -> None:
        """Go on in the rhythm that there would be without having slept."""
        self._next_ns = self._times.after(self.world.clock.now_ns)

    def _take(self, reading: Reading) -> None:
        stamp_ns = self.stamp_of(reading)
        if stamp_ns >= self._next_ns:
            self._next_ns = self._times.after(stamp_ns)
            self.take(reading)

    def stamp_of(self, _reading: Reading) -> int:
        """Return the time of a reading [ns]."""
        return self.world.clock.now_ns
