"""The topics of imu_sensor_controller and force_torque_sensor_controller.

Publishes:
    <ns>/<sensor> (sensor_msgs/Imu or geometry_msgs/WrenchStamped), in the frame of the sensor
"""

import logging
from typing import cast

from geometry_msgs.msg import WrenchStamped
from sensor_msgs.msg import Imu

from ....sim.controllers import IMU, SensorController
from ...messages import ImuLayout
from ...transport import is_valid_name, topic_name
from ..adapter import Adapter, owner_name
from ..declarations import Endpoint, PublishedTopic, Publishes
from ..wrenches import wrench_message
from .topics import connects_controller

logger = logging.getLogger(__name__)


class SensorTopics(Endpoint):
    """The topics of the sensors whose names are names in ROS."""

    def __init__(self, adapter: Adapter) -> None:
        super().__init__(adapter)
        controller = cast(SensorController, adapter.plugin)
        self._topics: list[PublishedTopic] = []
        for sensor, frame in controller.frames.items():
            if not is_valid_name(topic_name(controller.namespace, sensor)):
                logger.error(
                    "%s: no topic for the sensor '%s', since ROS has no such names",
                    owner_name(controller),
                    sensor,
                )
                continue
            declared = (
                _imu(sensor, frame)
                if controller.interface == IMU
                else Publishes(sensor, WrenchStamped, convert=wrench_message, frame=frame)
            )
            self._topics.append(declared(adapter))

    def open(self) -> None:
        """Advertise them."""
        for topic in self._topics:
            topic.open()

    def refresh(self) -> None:
        """Connect the sensors whose topics have subscribers."""
        for topic in self._topics:
            topic.refresh()

    def disconnect(self) -> None:
        """Disconnect the sensors."""
        for topic in self._topics:
            topic.disconnect()


def _imu(sensor: str, frame: str) -> Publishes:
    return Publishes(sensor, Imu, serializer=lambda _adapter: ImuLayout(frame).pack)


connects_controller(SensorController, SensorTopics)
