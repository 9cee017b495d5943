"""Debian's joint_state_publisher, with the joint states of other nodes as its source.

By itself it publishes zero for all joints, even if a simulator publishes their positions, so that
the wheels in RViz jump between both.

Subscribes:
    joint_states (sensor_msgs/JointState): those of other nodes, unless ~source_list is set.
Publishes:
    joint_states (sensor_msgs/JointState) and parameters: as joint_state_publisher has them.
"""

import contextlib
import sys

import rospy
from joint_state_publisher import JointStatePublisher
from sensor_msgs.msg import JointState

from ..transport import init_node, sender_of

NAME = 'joint_state_publisher'


def main() -> int:
    """Publish until shutdown; return an exit code."""
    init_node(NAME, sys.argv[1:])
    try:
        joints = JointStatePublisher()
    except RuntimeError as error:  # there is no robot_description
        sys.stderr.write(f'{NAME}: {error}\n')
        return 1

    def forward(message: JointState) -> None:
        if sender_of(message) != rospy.get_name():
            joints.source_cb(message)

    if not joints.sources:
        joints.sources.append(rospy.Subscriber('joint_states', JointState, forward))
    with contextlib.suppress(rospy.ROSInterruptException):
        joints.loop()
    return 0
