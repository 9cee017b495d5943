"""The demo's ROS node, which drives the robot and records its motion."""

from __future__ import annotations

import time
from collections.abc import Callable

import numpy as np
import rosgraph
import rospy
from gazebo_msgs.srv import DeleteModel, GetModelState, GetModelStateResponse
from geometry_msgs.msg import Pose, Twist
from nav_msgs.msg import Odometry
from numpy.typing import NDArray
from sensor_msgs.msg import Image

from ...sim.core import yaw_of
from ...sim.rendering import EYE, TARGET
from ..messages import read_quaternion, read_vector
from .planar_sample import PlanarSample

_PERIOD = 0.04  # [s] wall time between two polls of the simulator
_ANSWER = 60.0  # [s] wall time; a running simulator answers at once, on a busy machine late
_SLOWEST = 0.1  # real-time factor below which the demo gives up


def wait_until(
    condition: Callable[[], bool],
    timeout: float,
    what: str,
    alive: Callable[[], bool] = lambda: True,
) -> None:
    """Wait for a condition.

    Args:
        timeout: longest time to wait [s, wall].
        what: what is waited for, completes the sentence "gave up waiting for …".
        alive: tells whether waiting still makes sense.
    Raises:
        TimeoutError: the condition was not met in time, or `alive` returned false.
    """
    deadline = time.monotonic() + timeout
    while not condition():
        if not alive():
            raise TimeoutError(f'waited for {what}, but it has ended')
        if time.monotonic() > deadline:
            raise TimeoutError(f'gave up waiting for {what} after {timeout:g} s')
        time.sleep(_PERIOD)


class DemoClient:
    """A client of the simulator at /gazebo for one model.

    Publishes:
        /part2_cmr/cmd_vel (geometry_msgs/Twist)
    Subscribes:
        /odom (nav_msgs/Odometry), /gazebo/view/image_raw (sensor_msgs/Image)
    Calls:
        /gazebo/get_model_state, /gazebo/delete_model
    """

    def __init__(self, model: str, timeout: float, alive: Callable[[], bool]) -> None:
        """Start the node once there are a master and a simulator.

        Args:
            timeout: longest time to wait for both [s, wall].
            alive: tells whether the simulator's process still runs.
        Raises:
            TimeoutError: one of them did not start in time.
        """
        self._model = model
        wait_until(rosgraph.is_master_online, timeout, 'the ROS master', alive)
        rospy.init_node('demo', anonymous=True, disable_signals=True, log_level=rospy.ERROR)
        wait_until(lambda: _offered('/gazebo/get_model_state'), timeout, 'the simulator', alive)
        self._get_state = rospy.ServiceProxy('/gazebo/get_model_state', GetModelState)
        self._delete = rospy.ServiceProxy('/gazebo/delete_model', DeleteModel)
        self._odometry: list[PlanarSample] = []
        self._command = rospy.Publisher('/part2_cmr/cmd_vel', Twist, queue_size=1)
        rospy.Subscriber('/odom', Odometry, self._remember)

    def _remember(self, message: Odometry) -> None:
        self._odometry.append(_sample(message.header.stamp, message.pose.pose))

    def _state(self) -> GetModelStateResponse:
        try:
            return self._get_state(self._model, '')
        except (rospy.ServiceException, rospy.ROSException) as error:
            raise ConnectionError(f'the simulator does not answer any more: {error}') from error

    def present(self) -> bool:
        """Tell whether the model is in the world."""
        return bool(self._state().success)

    def height(self) -> float:
        """Return z of the model's origin in the world [m]; 0 if there is no such model."""
        return float(self._state().pose.position.z)

    def delete(self) -> str:
        """Delete the model and return the simulator's status message.

        Raises:
            ConnectionError: the simulator refused or did not answer.
        """
        try:
            response = self._delete(self._model)
        except (rospy.ServiceException, rospy.ROSException) as error:
            raise ConnectionError(f'the model could not be deleted: {error}') from error
        if not response.success:
            raise ConnectionError(f'the model could not be deleted: {response.status_message}')
        return str(response.status_message)

    def wait_for_plugin(self) -> None:
        """Wait until the robot subscribes to commands and publishes odometry.

        Raises:
            TimeoutError: it does not in time.
        """
        self._odometry.clear()
        wait_until(
            lambda: self._command.get_num_connections() > 0 and bool(self._odometry),
            _ANSWER,
            "the robot's plugin on /part2_cmr/cmd_vel and /odom",
        )

    def drive(
        self, speed: float, turn_rate: float, duration: float
    ) -> tuple[list[PlanarSample], list[PlanarSample]]:
        """Command a velocity and record the motion.

        Args:
            speed: along the robot's x [m/s].
            turn_rate: counter-clockwise [rad/s].
            duration: how long [s, simulated].
        Returns:
            Samples of ground truth and of odometry, in the world frame, oldest first.
        Raises:
            TimeoutError: simulated time is stopped or too slow.
            ConnectionError: the model was deleted, or the simulator ended.
        """
        command = Twist()
        command.linear.x, command.angular.z = speed, turn_rate
        self._odometry.clear()
        truth: list[PlanarSample] = []

        def is_done() -> bool:
            self._command.publish(command)
            state = self._state()
            if not state.success:
                raise ConnectionError(f'{self._model} was deleted: {state.status_message}')
            truth.append(_sample(state.header.stamp, state.pose))
            return truth[-1].stamp - truth[0].stamp >= duration

        wait_until(is_done, duration / _SLOWEST, f'{duration:g} s of simulated time')
        return truth, list(self._odometry)

    def look_at_robot(self) -> NDArray[np.uint8]:
        """Return an overview picture of the robot: (height, width, 3) RGB bytes.

        Raises:
            TimeoutError: no picture arrived.
        """
        robot = self._state().pose.position
        for name, point in (('eye', EYE), ('target', TARGET)):
            place = [robot.x + point[0], robot.y + point[1], point[2]]
            rospy.set_param(f'/gazebo/view/{name}', place)
        pictures: list[Image] = []
        watch = rospy.Subscriber('/gazebo/view/image_raw', Image, pictures.append)
        try:
            wait_until(lambda: bool(pictures), _ANSWER, 'a picture on /gazebo/view/image_raw')
        finally:
            watch.unregister()
        image = pictures[0]
        return np.frombuffer(image.data, np.uint8).reshape(image.height, image.width, 3)

    def close(self) -> None:
        """Shut the node down."""
        rospy.signal_shutdown('the demo is over')


def _offered(service: str) -> bool:
    try:
        rospy.wait_for_service(service, timeout=_PERIOD)
    except rospy.ROSException:
        return False
    return True


def _sample(stamp: rospy.Time, pose: Pose) -> PlanarSample:
    x, y, _ = read_vector(pose.position)
    yaw = yaw_of(read_quaternion(pose.orientation))
    return PlanarSample(stamp.to_sec(), time.monotonic(), x, y, yaw)
