"""The topics of IMUs; their frames have no prefix.

Publishes:
    <ns>/<topicName> (sensor_msgs/Imu): imu_sensor, and imu, the plugin of a model.
Services:
    <ns>/<serviceName> (std_srvs/Empty): of imu; it answers, and nothing is calibrated, as upstream.
"""

import logging
from collections.abc import Callable

import rospy
from sensor_msgs.msg import Imu
from std_srvs.srv import Empty, EmptyResponse

from ...sim.sensors import ImuSensorPlugin, LinkImu
from ..messages import ImuLayout
from .adapter import Adapter, where
from .declarations import Offers, Pack, Publishes
from .registry import connects

logger = logging.getLogger(__name__)


def imu_pack(adapter: Adapter) -> Pack:
    """Return what lays readings out."""
    return ImuLayout(adapter.text('<frameName>')).pack


def calibration(adapter: Adapter, name: str) -> Callable[[], None]:
    """Offer the service."""
    try:
        service = rospy.Service(name, Empty, lambda _request: EmptyResponse())
    except rospy.ServiceException:
        logger.warning('%s: there is a service %s already; give this one another <serviceName>',
                       where(adapter.plugin), name)
        return lambda: None
    return service.shutdown


IMU = Publishes('imu', '<topicName>', Imu, pack=imu_pack)

connects(ImuSensorPlugin, IMU)
connects(LinkImu, IMU, Offers('<serviceName>', calibration))
