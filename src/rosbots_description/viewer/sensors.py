"""The sensors of a world's robots, while they are shown."""

from collections.abc import Collection
from functools import partial

from ..sim import Pose, World
from ..sim.description import ShownReading
from ..sim.sensors import Sensor, shown_reading
from .commands import WorldCommands


class WorldSensors:
    """Sensors by the names MODEL/LINK/SENSOR; those that are open are read."""

    def __init__(self, world: World, commands: WorldCommands) -> None:
        self._world, self._commands = world, commands
        # The reader of each open sensor, and what it has read last; only the owner of the world
        # connects and disconnects.
        self._open: dict[str, _Reader] = {}

    def offered(self) -> dict[str, str]:
        """Return the types of the sensors that are simulated, by name."""
        return {name: sensor.spec.type for name, sensor in self._sensors().items()}

    def open(self, topic: str, _kind: str) -> None:
        """Begin to read a sensor."""
        sensor = self._sensors().get(topic)
        if sensor is not None:
            self._open[topic] = reader = _Reader(sensor)
            self._commands.post(partial(sensor.readings.connect, reader.keep))

    def close(self, topic: str) -> None:
        """End that."""
        reader = self._open.pop(topic, None)
        if reader is not None:
            self._commands.post(partial(reader.sensor.readings.disconnect, reader.keep))

    def read(self, topic: str) -> ShownReading | None:
        """Return the newest reading of an open sensor; None if there is none since the last call.

        Raises:
            SimError: it cannot be shown.
        """
        reader = self._open.get(topic)
        taken = reader.take() if reader else None
        return shown_reading(reader.sensor, taken, topic) if reader and taken is not None else None

    def locate(self, frame: str, links: Collection[str]) -> tuple[str, Pose] | None:
        """Return the link of a sensor among these, and the sensor's pose there."""
        sensor = self._sensors().get(frame)
        if sensor is None:
            return None
        link = f'{sensor.model.name}/{sensor.link.name}'
        return (link, sensor.spec.pose) if link in links else None

    def _sensors(self) -> dict[str, Sensor]:
        return {
            sensor.scoped_name.replace('::', '/'): sensor
            for model in tuple(self._world.models.values())
            for sensor in tuple(model.sensors.values())
            if isinstance(sensor, Sensor) and sensor.measures
        }


class _Reader:
    """Keeps the newest reading until it is taken."""

    def __init__(self, sensor: Sensor) -> None:
        self.sensor = sensor
        self._newest: object = None

    def keep(self, reading: object) -> None:
        self._newest = reading

    def take(self) -> object:
        taken, self._newest = self._newest, None
        return taken
