#!/usr/bin/env python3
"""The combined launch file gives one TF tree, which moves with the robot."""

import sys
import unittest

import rospy
import rostest
from gazebo_msgs.msg import ContactsState
from geometry_msgs.msg import Twist
from sensor_msgs.msg import CameraInfo, Image, Imu, LaserScan, PointCloud2
from simulator import DEADLINE, wait_until
from tf2_msgs.msg import TFMessage

SENSORS = {  # topic: type, frame
    '/scan': (LaserScan, 'laser_link'),
    '/imu/data': (Imu, 'imu_link'),
    '/bumper_states': (ContactsState, 'base_link'),
    '/camera1/image_raw': (Image, 'camera_link_optical'),
    '/camera1/camera_info': (CameraInfo, 'camera_link_optical'),
    '/camera1/depth/image_raw': (Image, 'camera_link_optical'),
    '/camera1/depth/camera_info': (CameraInfo, 'camera_link_optical'),
    '/camera1/depth/points': (PointCloud2, 'camera_link_optical'),
}
FIXED_FRAMES = {
    'base_link',
    'base_second_link',
    'mcu_link',
    'batery_link',
    'caster_back_link',
    *(frame for _, frame in SENSORS.values()),
}
START = 90.0  # [s, wall] timeout of simulator, spawn and robot_state_publisher


class FramesTest(unittest.TestCase):
    def test_every_frame_has_one_parent_and_odom_is_the_root(self):
        parents, latest = {}, {}

        def listen(message):
            for transform in message.transforms:
                child, parent = transform.child_frame_id, transform.header.frame_id
                parents.setdefault(child, set()).add(parent)
                latest[child] = transform

        subscribers = [rospy.Subscriber(name, TFMessage, listen) for name in ('/tf', '/tf_static')]
        expected = FIXED_FRAMES | {'base_footprint', 'wheel_left_link', 'wheel_right_link'}
        wait_until(lambda: expected <= set(parents), 'all frames', START)
        before = latest['base_footprint'].transform.translation.x
        publisher = rospy.Publisher('/part2_cmr/cmd_vel', Twist, queue_size=1)
        wait_until(publisher.get_num_connections, 'the plugin')
        command = Twist()
        command.linear.x = 0.5
        publisher.publish(command)
        wait_until(
            lambda: latest['base_footprint'].transform.translation.x > before + 0.2,
            'motion of the tree',
            DEADLINE,
        )
        for subscriber in subscribers:
            subscriber.unregister()
        self.assertEqual({child for child, names in parents.items() if len(names) > 1}, set())
        self.assertEqual(parents['base_footprint'], {'odom'})
        self.assertEqual(parents['base_link'], {'base_footprint'})
        roots = set().union(*parents.values()) - set(parents)
        self.assertEqual(roots, {'odom'})

    def test_every_sensor_publishes_in_its_frame(self):
        found = {}

        def keep(message, topic):
            found[topic] = message

        subscribers = [
            rospy.Subscriber(topic, message_class, keep, topic, queue_size=1)
            for topic, (message_class, _) in SENSORS.items()
        ]
        wait_until(lambda: len(found) == len(SENSORS), 'all sensors', START)
        for subscriber in subscribers:
            subscriber.unregister()
        self.assertEqual(
            {topic: message.header.frame_id for topic, message in found.items()},
            {topic: frame for topic, (_, frame) in SENSORS.items()},
        )


if __name__ == '__main__':
    rospy.init_node('test_simulation', disable_rostime=True)
    rostest.rosrun('rosbots_description', 'simulation', FramesTest, sys.argv)
