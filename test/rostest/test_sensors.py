"""Topics of sensors: names, types, frames, stamps; resets, and deletion while subscribed."""

import math

import numpy as np
import rospy
from gazebo_msgs.msg import ContactsState
from geometry_msgs.msg import WrenchStamped
from sensor_msgs.msg import Imu, LaserScan, PointCloud, Range
from simulator import DEADLINE, SimulatorTest, recorded, topics_of, wait_until
from std_srvs.srv import Empty


def spacing(messages):
    """Return the distinct spacings of message stamps [ms]."""
    stamps = [message.header.stamp.to_nsec() // 1_000_000 for message in messages]
    return set(np.diff(stamps).tolist())


class SensorTest(SimulatorTest):
    def test_laser_has_its_frame_and_rate(self):
        self.spawn_recorded('laser_nonoise', {'/scan'})
        scans = self.read('/scan', LaserScan, 10)
        scan = scans[-1]
        self.assertEqual(scan.header.frame_id, 'laser_link')
        self.assertEqual((len(scan.ranges), len(scan.intensities)), (720, 720))
        self.assertEqual({scan.ranges[0], scan.ranges[-1]}, {math.inf})
        self.assertEqual((scan.time_increment, scan.scan_time), (0.0, 0.0))
        self.assertAlmostEqual(scan.angle_increment, 2 * 1.5708 / 719, 6)
        self.assertEqual(spacing(scans), {25})

    def test_laser_continues_at_once_after_a_reset_of_time(self):
        self.spawn_recorded('laser_nonoise', {'/scan'})
        scans = self.read('/scan', LaserScan, 40)
        self.reset_simulation()

        def since():
            """Return the stamps [s] since time jumped back; earlier scans may still arrive."""
            stamps = [scan.header.stamp.to_sec() for scan in list(scans)]
            return next(
                (stamps[n:] for n in range(1, len(stamps)) if stamps[n] < stamps[n - 1]), []
            )

        wait_until(lambda: len(since()) >= 3, 'further scans')
        self.assertLess(since()[0], 0.1)

    def test_robot_can_be_deleted_while_its_sensors_are_subscribed(self):
        self.spawn_recorded('laser_nonoise', {'/scan'})
        self.read('/scan', LaserScan, 2)
        self.assertTrue(self.delete('bot').success)
        self.assertNotIn('/scan', topics_of())
        self.disconnect()
        self.spawn_recorded('laser_nonoise', {'/scan'})
        self.read('/scan', LaserScan, 2)

    def test_range_finder_and_point_cloud(self):
        self.spawn_recorded('range', {'/sonar'})
        messages = self.read('/sonar', Range, 3)
        self.assertEqual(spacing(messages), {100})
        self.assertEqual(messages[0].header.frame_id, 'laser_link')
        self.assertAlmostEqual(messages[0].range, 2.508, 3)  # the ground
        self.delete('bot')
        self.spawn_recorded('laser_block', {'/cloud'})
        cloud = self.read('/cloud', PointCloud, 2)[-1]
        self.assertEqual((len(cloud.points), len(cloud.channels[0].values)), (360, 360))
        self.assertEqual(cloud.channels[0].name, '')

    def test_imu_sensor_at_rest(self):
        self.spawn_recorded('imu_sensor', {'/nsx/imu/data'}, namespace='/nsx')
        messages = self.read('/nsx/imu/data', Imu, 100)
        self.assertEqual(spacing(messages), {10})
        self.assertEqual(messages[-1].header.frame_id, 'imu_link')
        self.assertAlmostEqual(messages[-1].linear_acceleration.z, 9.8, 2)
        self.assertEqual(set(messages[-1].orientation_covariance), {0.0})

    def test_imu_plugin_of_a_model_with_its_service(self):
        self.spawn_recorded('imu_model', {'/imu'})
        message = self.read('/imu', Imu, 5)[-1]
        self.assertEqual(message.header.frame_id, 'base_footprint')
        self.assertAlmostEqual(message.linear_acceleration.z, 0.0, 2)
        rospy.wait_for_service('/imu_service', DEADLINE)
        rospy.ServiceProxy('/imu_service', Empty)()
        self.delete('bot')
        self.spawn_recorded('imu_model', {'/imu'})
        rospy.ServiceProxy('/imu_service', Empty)()

    def test_bumper_measures_the_weight(self):
        self.spawn_recorded('bumper', {'/bumper'})
        messages = self.read('/bumper', ContactsState, 20)
        message = messages[-1]
        self.assertEqual(message.header.frame_id, 'base_link')
        self.assertEqual(spacing(messages), {20})
        self.assertEqual(len(message.states), 20)
        self.assertAlmostEqual(message.states[-1].total_wrench.force.z / 49.0, 1.0, 1)

    def test_joint_wrench_is_that_of_the_suspended_mass(self):
        self.spawn('arm', recorded('arm_ft'))
        messages = self.read('/ft_elbow', WrenchStamped, 5)
        self.assertEqual(messages[-1].header.frame_id, 'fore')
        self.assertEqual(spacing(messages), {10})
