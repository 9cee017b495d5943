"""Controllers of joints, as ros_control gives them to a robot; importing registers them.

A control law (`pid`, `limits`, …) knows no interface; a controller reads parameters, joints and
commands, and applies the law; the manager loads, switches and updates controllers.
"""

from .controller import Controller, ControllerSpec, RateGate, require_finite
from .drive import (
    AckermannSteeringController,
    DiffDriveController,
    DriveController,
    FourWheelSteering,
    FourWheelSteeringController,
    MecanumDriveController,
)
from .errors import ControllerError
from .goal import ABORTED, ACTIVE, CANCELED, REJECTED, SUCCEEDED, Goal
from .gripper_action import GripperActionController, GripperGoal, GripperResult
from .hardware import EFFORT, POSITION, STATE, VELOCITY, JointHandle, SimulatedRobot
from .joint_command import JointCommandController, JointGroupCommandController
from .joint_pid import (
    JointGroupPositionController,
    JointPidState,
    JointPositionController,
    JointVelocityController,
)
from .joint_state import JointStateController
from .joint_trajectory import FollowedGoal, JointTrajectoryController
from .manager import ControllerManager, ControllerStatus
from .mimic_plugin import MimicJointPlugin
from .parameters import ControllerParameters
from .pid import Gains, Pid
from .plugin import RosControl
from .registry import register_controller
from .sensor_states import IMU, WRENCH, SensorController
from .trajectory import (
    Tolerance,
    Trajectory,
    TrajectoryGoal,
    TrajectoryPoint,
    TrajectoryState,
)

__all__ = [
    'ABORTED',
    'ACTIVE',
    'CANCELED',
    'EFFORT',
    'IMU',
    'POSITION',
    'REJECTED',
    'STATE',
    'SUCCEEDED',
    'VELOCITY',
    'WRENCH',
    'AckermannSteeringController',
    'Controller',
    'ControllerError',
    'ControllerManager',
    'ControllerParameters',
    'ControllerSpec',
    'ControllerStatus',
    'DiffDriveController',
    'DriveController',
    'FollowedGoal',
    'FourWheelSteering',
    'FourWheelSteeringController',
    'Gains',
    'Goal',
    'GripperActionController',
    'GripperGoal',
    'GripperResult',
    'JointCommandController',
    'JointGroupCommandController',
    'JointGroupPositionController',
    'JointHandle',
    'JointPidState',
    'JointPositionController',
    'JointStateController',
    'JointTrajectoryController',
    'JointVelocityController',
    'MecanumDriveController',
    'MimicJointPlugin',
    'Pid',
    'RateGate',
    'RosControl',
    'SensorController',
    'SimulatedRobot',
    'Tolerance',
    'Trajectory',
    'TrajectoryGoal',
    'TrajectoryPoint',
    'TrajectoryState',
    'register_controller',
    'require_finite',
]
