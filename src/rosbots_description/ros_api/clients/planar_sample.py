"""Where something was at one moment; free of ROS, so that measurements can be worked on without."""

from dataclasses import dataclass


@dataclass(frozen=True)
class PlanarSample:
    """Position and heading in the plane of the ground, world frame, at one moment."""

    stamp: float  # [s] simulated
    wall: float  # [s] monotonic clock of the machine
    x: float  # [m]
    y: float  # [m]
    yaw: float  # [rad] counter-clockwise
