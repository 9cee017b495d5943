"""Controllers that drive robots on wheels by velocity commands; importing registers them."""

from .ackermann_steering import AckermannSteeringController
from .base import DriveController
from .diff_drive import DiffDriveController
from .four_wheel_steering import FourWheelSteering, FourWheelSteeringController
from .mecanum_drive import MecanumDriveController

__all__ = [
    'AckermannSteeringController',
    'DiffDriveController',
    'DriveController',
    'FourWheelSteering',
    'FourWheelSteeringController',
    'MecanumDriveController',
]
