#!/usr/bin/env python3
"""Twenty robots from one launch file: separate topics and frames, and no cross-talk."""

import random
import sys
import unittest

import rospy
import rostest
from gazebo_msgs.srv import DeleteModel, GetModelState, GetWorldProperties
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from simulator import GROUND, proxy, topics_of, wait_until
from tf2_msgs.msg import TFMessage

ROBOTS = [f'robot_{i}' for i in range(20)]
OWN_TOPICS = ('odom', 'joint_states', 'cmd_vel')
EDGES = {
    ('odom', 'base_link'),
    ('base_footprint', 'wheel_left_link'),
    ('base_footprint', 'wheel_right_link'),
}
DRIVEN = 'robot_7'
STILL = 0.1  # bound of the motion of robots without commands [m]


class ManyRobotsTest(unittest.TestCase):
    def setUp(self):
        self.delete = proxy('delete_model', DeleteModel)
        self.model_state = proxy('get_model_state', GetModelState)
        self.world = proxy('get_world_properties', GetWorldProperties)
        wait_until(lambda: len(self.world().model_names) == len(ROBOTS) + 1, 'all robots', 60.0)
        wait_until(lambda: self._own_topics(ROBOTS) <= topics_of(), 'all topics')

    @staticmethod
    def _own_topics(robots):
        return {f'/{robot}/{topic}' for robot in robots for topic in OWN_TOPICS}

    def _x_of(self, robot):
        return self.model_state(robot, '').pose.position.x

    def test_twenty_robots_are_independent(self):
        self._check_frames()
        self._check_that_one_command_moves_one_robot()
        self._check_deletions()

    def _check_frames(self):
        edges = set()

        def note(message):
            edges.update((t.header.frame_id, t.child_frame_id) for t in message.transforms)

        subscriber = rospy.Subscriber('/tf', TFMessage, note)
        expected = {
            (f'{robot}/{parent}', f'{robot}/{child}') for robot in ROBOTS for parent, child in EDGES
        }
        wait_until(lambda: expected <= edges, 'the frames of all robots')
        subscriber.unregister()
        self.assertEqual(edges, expected)

    def _check_that_one_command_moves_one_robot(self):
        heard = []
        subscriber = rospy.Subscriber(f'/{DRIVEN}/odom', Odometry, heard.append)
        before = {robot: self._x_of(robot) for robot in ROBOTS}
        self._drive(DRIVEN)
        wait_until(lambda: heard and heard[-1].twist.twist.linear.x > 0.1, 'its odometry')
        self.assertEqual(
            (heard[-1].header.frame_id, heard[-1].child_frame_id),
            (f'{DRIVEN}/odom', f'{DRIVEN}/base_link'),
        )
        subscriber.unregister()
        for robot in set(ROBOTS) - {DRIVEN}:
            self.assertAlmostEqual(self._x_of(robot), before[robot], delta=STILL)

    def _drive(self, robot):
        publisher = rospy.Publisher(f'/{robot}/cmd_vel', Twist, queue_size=1)
        wait_until(publisher.get_num_connections, f'{robot} listening')
        command = Twist()
        command.linear.x = 0.5
        start = self._x_of(robot)
        publisher.publish(command)
        wait_until(lambda: self._x_of(robot) > start + 0.3, f'{robot} driving')
        publisher.unregister()

    def _check_deletions(self):
        left = list(ROBOTS)
        random.Random(3).shuffle(left)
        while left:
            gone = left.pop()
            self.assertTrue(self.delete(gone).success)
            topics = topics_of()
            self.assertTrue(self._own_topics(left) <= topics)
            self.assertFalse(self._own_topics([gone]) & topics)
            if len(left) == len(ROBOTS) // 2:
                self._drive(left[0])
        self.assertEqual(self.world().model_names, [GROUND])
        self.assertNotIn('/tf', topics_of())


if __name__ == '__main__':
    rospy.init_node('test_many_robots', disable_rostime=True)
    rostest.rosrun('rosbots_description', 'many_robots', ManyRobotsTest, sys.argv)
