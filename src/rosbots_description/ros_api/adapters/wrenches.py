"""The topic of joints that are measured.

Publishes:
    <ns>/<topicName> (geometry_msgs/WrenchStamped): ft_sensor, in the frame of the joint's child.
Parameters:
    tf_prefix, searched from the plugin's namespace upward.
"""

from geometry_msgs.msg import Vector3, Wrench, WrenchStamped

from ...sim.sensors import JointWrench, JointWrenchPlugin
from .declarations import Publishes
from .registry import declare_topics


def wrench_message(reading: JointWrench) -> WrenchStamped:
    """Return the message of a wrench."""
    return WrenchStamped(wrench=Wrench(Vector3(*reading.force), Vector3(*reading.torque)))


declare_topics(
    JointWrenchPlugin, Publishes('wrench', WrenchStamped, convert=wrench_message, frame='<frame>')
)
