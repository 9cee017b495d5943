#!/usr/bin/env python3
"""Topics, services and parameters are exactly Gazebo's."""

import sys

import rospy
import rostest
from network import OF_ROBOT, OF_ROSOUT, PARAMETERS, PUBLISHED, SERVICES, SUBSCRIBED, services_of
from simulator import SimulatorTest, topics_of, wait_until

OF_GAZEBO = set(PUBLISHED) | set(SUBSCRIBED) | OF_ROSOUT


class WithoutExtensionsTest(SimulatorTest):

    def test_an_empty_world_and_the_robot_in_it(self):
        wait_until(lambda: 'set_parameters' in services_of(), 'dynamic_reconfigure')
        self.assertEqual(topics_of(), OF_GAZEBO)
        self.assertEqual(services_of(), set(SERVICES))
        self.assertEqual(len(SERVICES), 30)
        parameters = set(rospy.get_param('/gazebo')) - {'extensions'}
        self.assertEqual(parameters, PARAMETERS | {'enable_ros_network'})
        self.assertIs(rospy.get_param('/use_sim_time'), True)
        self.spawn()
        self.assertEqual(topics_of(), OF_GAZEBO | OF_ROBOT)
        self.assertEqual(services_of(), set(SERVICES))


if __name__ == '__main__':
    rospy.init_node('test_without_extensions', disable_rostime=True)
    rostest.rosrun('rosbots_description', 'without_extensions', WithoutExtensionsTest, sys.argv)
