"""The topics of IMUs and of satellite navigation; their frames have no prefix.

Publishes:
    <ns>/<topicName> (sensor_msgs/Imu): imu_sensor; imu and hector's imu, plugins of a model.
    <ns>/<biasTopicName> (sensor_msgs/Imu): the errors of hector's imu.
    <ns>/<topicName> (sensor_msgs/NavSatFix): hector's gps.
    <ns>/<velocityTopicName> (geometry_msgs/Vector3Stamped): of hector's gps, to north, west and up.
Services:
    <ns>/<serviceName> (std_srvs/Empty): of imu, where nothing is calibrated, as upstream; of
        hector's imu it removes the drift of the angular velocity.
"""

from collections.abc import Callable
from typing import cast

import rospy
from geometry_msgs.msg import Vector3, Vector3Stamped
from sensor_msgs.msg import Imu, NavSatFix, NavSatStatus
from std_srvs.srv import Empty, EmptyRequest, EmptyResponse

from ...sim.sensors import Fix, HectorGps, HectorImu, ImuSensorPlugin, LinkImu
from ..messages import ImuLayout
from .adapter import Adapter
from .declarations import Offers, Publishes, Serializer
from .registry import declare_topics


def imu_serializer(adapter: Adapter) -> Serializer:
    """Return what lays readings out."""
    return ImuLayout(adapter.text('<frameName>')).pack


def calibration(adapter: Adapter, name: str) -> Callable[[], None]:
    """Offer the service."""
    plugin = cast(LinkImu, adapter.plugin)

    def answer(_request: EmptyRequest) -> EmptyResponse:
        adapter.call(plugin.calibrate)
        return EmptyResponse()

    shutdown: Callable[[], None] = rospy.Service(name, Empty, answer).shutdown
    return shutdown


def fix_message(fix: Fix) -> NavSatFix:
    """Return the message of a position."""
    message = NavSatFix(
        status=NavSatStatus(fix.status, fix.service),
        latitude=fix.latitude,
        longitude=fix.longitude,
        altitude=fix.altitude,
        position_covariance_type=NavSatFix.COVARIANCE_TYPE_DIAGONAL_KNOWN,
    )
    message.position_covariance[::4] = fix.variances
    return message


IMU = Publishes('imu', Imu, serializer=imu_serializer)

declare_topics(ImuSensorPlugin, IMU)
declare_topics(LinkImu, IMU, Offers('<serviceName>', calibration))
declare_topics(
    HectorImu,
    IMU,
    Publishes('bias', Imu, '<biasTopicName>', serializer=imu_serializer),
    Offers('<serviceName>', calibration),
)
declare_topics(
    HectorGps,
    Publishes('fix', NavSatFix, '<topicName>', fix_message, frame='<frameId>', queue=10),
    Publishes(
        'velocity',
        Vector3Stamped,
        '<velocityTopicName>',
        convert=lambda velocity: Vector3Stamped(vector=Vector3(*velocity)),
        frame='<frameId>',
        queue=10,
    ),
)
