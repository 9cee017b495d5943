"""The readings of sensors, at a rate: imu_sensor_controller and force_torque_sensor_controller.

Gazebo's simulated hardware has no such sensors, and upstream's controllers refuse to load there.
Here they report those of the model: each <sensor> of type imu, and each force and torque sensor
(libgazebo_ros_ft_sensor.so) by the name of its plugin. A model without any gets upstream's answer.
"""

from collections.abc import Iterable, Iterator
from typing import Any, NamedTuple

from ..plugins import ModelPlugin
from ..runtime import Output
from .controller import RUNNING, Controller, RateGate
from .errors import ControllerError, InterfaceError
from .registry import register_controller

IMU = 'hardware_interface::ImuSensorInterface'
WRENCH = 'hardware_interface::ForceTorqueSensorInterface'


class _Newest:
    """The newest reading of a sensor."""

    reading: Any = None

    def take(self, reading: object) -> None:
        """Keep a reading."""
        self.reading = reading


class Source(NamedTuple):
    """A sensor: the frame of its readings, their output, and the newest one."""

    frame: str
    readings: Output[Any]
    newest: _Newest


@register_controller('imu_sensor_controller/ImuSensorController', IMU)
@register_controller('force_torque_sensor_controller/ForceTorqueSensorController', WRENCH)
class SensorController(Controller):
    """Report the newest reading of each sensor. Its outputs have the names of the sensors.

    `frames` has the frame of each. Parameter: publish_rate [Hz].
    """

    in_root_namespace = True

    def load(self) -> None:
        """Read the parameter and find the sensors."""
        found = self._find_imus() if self.interface == IMU else self._find_wrenches()
        self._sources = dict(found)
        if not self._sources:
            raise InterfaceError(self.interface)
        rate = self.params.number('publish_rate')
        if rate is None:
            raise ControllerError("Parameter 'publish_rate' not set")
        self._gate = RateGate(rate)
        self.topic_names = {name: name for name in self._sources}
        self.frames = {name: source.frame for name, source in self._sources.items()}
        for name in self._sources:
            self.output(name)

    def _find_imus(self) -> Iterator[tuple[str, Source]]:
        sensors: list[Any] = [*self.model.sensors.values()]
        for sensor in sensors:
            if sensor.spec.type == 'imu' and sensor.measures:
                yield sensor.name, Source(sensor.link.name, sensor.readings, _Newest())

    def _find_wrenches(self) -> Iterator[tuple[str, Source]]:
        for plugin in self.model.plugins.values():
            if isinstance(plugin, ModelPlugin) and 'wrench' in plugin.outputs:
                yield (
                    plugin.spec.name,
                    Source(plugin.params.string('frame'), plugin.outputs['wrench'], _Newest()),
                )

    def starting(self, now_ns: int) -> None:
        """Begin a period."""
        self._gate.restart(now_ns)
        self._attach(True)

    def stopping(self, now_ns: int) -> None:
        """Release the sensors."""
        self._attach(False)

    def time_reset(self, now_ns: int) -> None:
        """Begin a period."""
        self._gate.restart(now_ns)

    def count_readers(self) -> None:
        """Read the sensors while there are readers."""
        super().count_readers()
        self._attach(self.state == RUNNING)

    def update(self, now_ns: int, period: float) -> None:
        """Send the newest readings when they are due."""
        if self._gate.opens(now_ns) and self.is_read:
            for name, source in self._sources.items():
                if source.newest.reading is not None:
                    self.outputs[name].send(source.newest.reading)

    def _attach(self, runs: bool) -> None:
        """Connect to the sensors whose readings are wanted, and disconnect from the others."""
        for name, (_, readings, newest) in self._sources.items():
            wanted = runs and self.outputs[name].wanted
            if wanted and not readings.is_read_by(newest.take):
                readings.connect(newest.take)
            elif not wanted:
                readings.disconnect(newest.take)
                newest.reading = None

    def parts(self) -> Iterable[object]:
        """Return what the sensors write to."""
        return tuple(source.newest for source in self._sources.values())
