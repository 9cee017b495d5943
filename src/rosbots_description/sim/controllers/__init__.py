"""Controllers of joints, as ros_control gives them to a robot; importing registers them.

A control law (`pid`, `limits`, …) knows no interface; a controller reads parameters, joints and
commands, and applies the law; the manager loads, switches and updates controllers.
"""

from . import joint_command, joint_pid, joint_state  # noqa: F401
from .controller import Controller, ControllerSpec, RateGate, require_finite
from .errors import ControllerError
from .hardware import EFFORT, POSITION, STATE, VELOCITY, JointHandle, SimulatedRobot
from .joint_command import JointCommandController, JointGroupCommandController
from .joint_pid import (
    JointGroupPositionController,
    JointPidState,
    JointPositionController,
    JointVelocityController,
)
from .joint_state import JointStateController
from .manager import ControllerManager, ControllerStatus
from .parameters import ControllerParameters
from .pid import Gains, Pid
from .plugin import RosControl
from .registry import register_controller

__all__ = [
    'EFFORT', 'POSITION', 'STATE', 'VELOCITY', 'Controller', 'ControllerError', 'ControllerManager',
    'ControllerParameters', 'ControllerSpec', 'ControllerStatus', 'Gains', 'JointCommandController',
    'JointGroupCommandController', 'JointGroupPositionController', 'JointHandle', 'JointPidState',
    'JointPositionController', 'JointStateController', 'JointVelocityController', 'Pid', 'RateGate',
    'RosControl', 'SimulatedRobot', 'register_controller', 'require_finite',
]
