"""The interface of a world to a sensor of a link."""

from typing import TYPE_CHECKING

from ..description import SensorSpec
from .model_part import ModelPart

if TYPE_CHECKING:
    from .model import Model


class SensorPart(ModelPart):
    """A sensor of a <sensor> element, fixed to a link."""

    model: 'Model'
    spec: SensorSpec
    name: str
    called: str  # in messages, with its link
    scoped_name: str  # model::link::sensor
    measures: bool  # False: its type is not simulated
    count = 0  # of readings sent
    last_ns = 0  # time of the last reading [ns]

    def __repr__(self) -> str:
        """Return its kind and name."""
        return f'<{type(self).__name__} {self.scoped_name}>'
