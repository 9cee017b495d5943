#!/usr/bin/env python3
"""The car of car.launch follows cmd_vel with all four wheels, and knows where it is."""

import math
import sys
import unittest

import rospy
import rostest
from gazebo_msgs.srv import GetModelState
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from sensor_msgs.msg import JointState
from simulator import proxy, wait_until

SPEED, TURN = 0.4, 0.5  # [m/s], [rad/s]
NEAR = 0.05  # [m] of the odometry to the truth


class CarTest(unittest.TestCase):
    def test_car_drives_an_arc_and_knows_where_it_is(self):
        heard = {}
        rospy.Subscriber('/car/drive/odom', Odometry, lambda m: heard.update(odom=m))
        rospy.Subscriber('/car/joint_states', JointState, lambda m: heard.update(joints=m))
        commands = rospy.Publisher('/car/drive/cmd_vel', Twist, queue_size=1)
        command = Twist()
        command.linear.x, command.angular.z = SPEED, TURN
        model_state = proxy('get_model_state', GetModelState)

        def steers():
            commands.publish(command)  # the wheels turn back if none comes for half a second
            angles = dict(zip(heard['joints'].name, heard['joints'].position, strict=True))
            left, right = angles['front_left_steering'], angles['front_right_steering']
            return left > right > 0.1 and angles['rear_left_steering'] < -0.1

        def has_turned():
            commands.publish(command)
            orientation = model_state('car', 'world').pose.orientation
            return 2.0 * math.atan2(orientation.z, orientation.w) > 1.0

        wait_until(lambda: {'odom', 'joints'} <= heard.keys(), 'its controllers')
        wait_until(steers, 'wheels on a circle, the inner one steered more')
        wait_until(has_turned, 'an arc of 1 rad')
        wait_until(lambda: abs(heard['odom'].twist.twist.linear.x) < 1e-3, 'a stop')
        true, found = (
            one.position for one in (model_state('car', 'world').pose, heard['odom'].pose.pose)
        )
        self.assertGreater(math.hypot(true.x, true.y), 0.5)
        self.assertLess(math.dist((true.x, true.y), (found.x, found.y)), NEAR)


if __name__ == '__main__':
    rospy.init_node('test_car', disable_rostime=True)
    rostest.rosrun('rosbots_description', 'car', CarTest, sys.argv)
