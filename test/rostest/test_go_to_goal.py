#!/usr/bin/env python3
"""The example node drives the robot to the goal that its launch file names, and ends."""

import math
import sys

import rosnode
import rospy
import rostest
from example_nodes import AT_REST, LIMIT, ExampleNodeTest
from gazebo_msgs.srv import GetModelState
from simulator import proxy, wait_until

GOAL = -2.0, 1.5  # [m], see the launch file


class GoToGoalTest(ExampleNodeTest):

    def test_the_robot_stands_at_the_goal_when_the_node_ends(self):
        self.limit_rate(10000)
        wait_until(lambda: '/go_to_goal' not in rosnode.get_node_names(), 'the goal', LIMIT)
        wait_until(lambda: self.speed < AT_REST, 'the robot stopping')
        at = proxy('get_model_state', GetModelState)('rosbots', '').pose.position
        self.assertLess(math.dist((at.x, at.y), GOAL), 0.15)


if __name__ == '__main__':
    rospy.init_node('test_go_to_goal', disable_rostime=True)
    rostest.rosrun('rosbots_description', 'example_go_to_goal', GoToGoalTest, sys.argv)
