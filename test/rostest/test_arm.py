#!/usr/bin/env python3
"""The example node pick_and_place.py puts a box onto another one."""

import sys
import unittest

import rosnode
import rospy
import rostest
from gazebo_msgs.srv import GetModelState
from simulator import proxy, wait_until

NODE = '/arm/pick_and_place'
STAND, EDGES = (0.3, 0.4), 0.1 + 0.02  # where the large box is; height of the other one on it [m]


class ArmTest(unittest.TestCase):
    def test_box_is_put_onto_the_other_one(self):
        model_state = proxy('get_model_state', GetModelState)

        def is_there():
            state = model_state('box', 'world')
            position, twist = state.pose.position, state.twist.linear
            return (
                state.success
                and abs(position.z - EDGES) < 0.002
                and all(
                    abs(at - wanted) < 0.01
                    for at, wanted in zip((position.x, position.y), STAND, strict=True)
                )
                and abs(twist.z) < 0.001
            )

        wait_until(is_there, 'the box on the other one')
        wait_until(lambda: NODE not in rosnode.get_node_names(), 'the end of the node')
        self.assertTrue(is_there())


if __name__ == '__main__':
    rospy.init_node('test_arm', disable_rostime=True)
    rostest.rosrun('rosbots_description', 'arm', ArmTest, sys.argv)
