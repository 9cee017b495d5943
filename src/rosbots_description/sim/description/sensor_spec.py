"""A sensor as plain values: what a <sensor> says of itself, whatever it measures."""

from dataclasses import dataclass, field

from ..core import IDENTITY, Pose
from .element import Element, PluginSpec


@dataclass(frozen=True)
class SensorSpec:
    """Something that measures; what its type needs to know stands in `element`."""

    name: str
    type: str  # e.g. 'ray', 'imu'
    pose: Pose = IDENTITY  # in its link's frame
    update_rate: float = 0.0  # [Hz]; 0: in every step
    always_on: bool = False
    visualize: bool = False
    topic: str = ''
    plugins: tuple[PluginSpec, ...] = ()
    element: Element = field(default_factory=lambda: Element('sensor'))
