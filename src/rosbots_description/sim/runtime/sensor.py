"""What a world asks of a sensor of a link."""

from ..description import SensorSpec
from .model_part import ModelPart


class SensorLife(ModelPart):
    """What a <sensor> is: it measures, where it is fixed to a link."""

    spec: SensorSpec
    name: str
    scoped_name: str  # with those of its model and link
    measures: bool  # False: it is of a type that is not simulated
    count = 0  # of the readings that it has given
    last_ns = 0  # when it gave the last one [ns]
