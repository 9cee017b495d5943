"""A sample of planar motion; without ROS, so that reports can use it without ROS."""

from dataclasses import dataclass


@dataclass(frozen=True)
class PlanarSample:
    """Position and yaw in the ground plane at one time, in the world frame."""

    stamp: float  # [s] simulated
    wall: float  # [s] monotonic clock
    x: float  # [m]
    y: float  # [m]
    yaw: float  # [rad] counter-clockwise
