"""A model as it is sent to a simulator."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from ..core import IDENTITY, Pose


@dataclass(frozen=True)
class ModelText:
    """A model or a light as URDF or SDF, and how it is to be spawned.

    `name` is '' for the one in the text. `pose` is in the world; a light is where its text says.
    `joints` are positions [rad or m] by name.
    """

    name: str
    xml: str
    namespace: str = ''  # of plugins that have none of their own
    pose: Pose = IDENTITY
    joints: Mapping[str, float] = field(default_factory=dict)
