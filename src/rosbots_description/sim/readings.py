"""What plugins and sensors hand out, as plain values, and the ports they hand it out through."""

from collections.abc import Callable
from typing import NamedTuple

from .pose import Pose, Twist


class Odometry(NamedTuple):
    """Pose in the odometry frame; twist in the axes of the moving frame."""

    pose: Pose
    twist: Twist


class FrameTransform(NamedTuple):
    """Where the frame `child` stands in the frame `parent`."""

    parent: str
    child: str
    pose: Pose


class JointStates(NamedTuple):
    """Joint names with their positions [rad or m], and velocities and efforts if they are told."""

    names: tuple[str, ...]
    positions: tuple[float, ...]
    velocities: tuple[float, ...] = ()  # [rad/s or m/s]
    efforts: tuple[float, ...] = ()  # [N m or N]


class Port:
    """An output of a plugin. Nothing is computed for it while nobody wants it.

    `wanted()` tells whether a reading would be used; only then it is handed to `send(reading)`.
    """

    def __init__(self) -> None:
        self.disconnect()

    def connect(self, send: Callable, wanted: Callable[[], bool]) -> None:
        """Give every reading to `send(reading)` while `wanted()` is true."""
        self.send, self.wanted = send, wanted

    def disconnect(self) -> None:
        """Give readings to nobody."""
        self.send, self.wanted = None, _nobody


def _nobody() -> bool:
    return False
