"""The interface of a world to a sensor of a link."""

from ..description import SensorSpec
from .model_part import ModelPart


class SensorPart(ModelPart):
    """A sensor of a <sensor> element, fixed to a link."""

    spec: SensorSpec
    name: str
    scoped_name: str  # model::link::sensor
    measures: bool  # False: its type is not simulated
    count = 0  # of readings sent
    last_ns = 0  # time of the last reading [ns]

    def __repr__(self) -> str:
        """Return its kind and name."""
        return f'<{type(self).__name__} {self.scoped_name}>'
