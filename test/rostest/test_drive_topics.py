"""Topics of skid steer, planar and tricycle drives: frames, covariances, joint states."""

import rospy
from dynamic_reconfigure.msg import Config, DoubleParameter
from dynamic_reconfigure.srv import Reconfigure
from nav_msgs.msg import Odometry
from sensor_msgs.msg import JointState
from simulator import SimulatorTest, pose, recorded, topics_of, wait_until
from tf2_msgs.msg import TFMessage

WHEEL = '<wheel link_name="{side}_{end}_link"><wheel_normal_force>29</wheel_normal_force></wheel>'
SETTLING = rospy.Duration(1.0)  # a skid steer turns faster for 0.3 s when it begins to turn
STEERED = ['steer_joint', 'front_joint', 'left_joint', 'right_joint']


class DriveTest(SimulatorTest):
    def spawn_drive(self, robot, topics):
        """Spawn a robot; return its odometry and a function that sends commands."""
        self.spawn_recorded(robot, topics, z=0.02)
        return self.collect('/odom', Odometry), self.driver('/cmd_vel')

    def edges(self, messages):
        return {
            (edge.header.frame_id, edge.child_frame_id)
            for message in messages
            for edge in message.transforms
        }

    def test_odometry_of_a_skid_steer_is_planar_with_its_covariances(self):
        odometry, command = self.spawn_drive('skid4', {'/cmd_vel', '/odom', '/tf'})
        transforms = self.collect('/tf', TFMessage)
        command(0.5)
        wait_until(lambda: odometry and odometry[-1].twist.twist.linear.x > 0.45, 'it drives')
        message = odometry[-1]
        self.assertEqual(message.pose.pose.position.z, 0.0)
        variances = [1e-4, 1e-4, 1e12, 1e12, 1e12, 1e-2]
        for covariance in (message.pose.covariance, message.twist.covariance):
            self.assertEqual([covariance[7 * i] for i in range(6)], variances)
        wait_until(transforms.__len__, 'transforms')
        self.assertEqual(self.edges(transforms), {('odom', 'base_footprint')})

    def test_slip_compliance_is_set_by_dynamic_reconfigure(self):
        before = topics_of()
        wheels = ''.join(
            WHEEL.format(side=side, end=end)
            for side in ('left', 'right')
            for end in ('front', 'rear')
        )
        plugin = f'<gazebo><plugin name="s" filename="libgazebo_ros_wheel_slip.so">{wheels}'
        xml = recorded('skid4')
        xml = xml.replace('</robot>', f'{plugin}</plugin></gazebo></robot>')
        self.assertTrue(self.spawn('skid4', xml, pose(z=0.02)).success)
        there = topics_of() - before
        self.assertIn('/skid4/wheel_slip/parameter_updates', there)
        odometry = self.collect('/odom', Odometry)
        self.driver('/cmd_vel')(turn=1.0)
        wait_until(lambda: odometry and odometry[-1].twist.twist.angular.z > 0.5, 'it turns')
        settled = odometry[-1].header.stamp + SETTLING
        wait_until(lambda: odometry[-1].header.stamp > settled, 'the turn to settle')
        self.assertLess(odometry[-1].twist.twist.angular.z, 0.8)
        change = rospy.ServiceProxy('/skid4/wheel_slip/set_parameters', Reconfigure)
        name = 'slip_compliance_unitless_lateral'
        change(Config(doubles=[DoubleParameter(name=name, value=10.0)]))
        wait_until(lambda: odometry[-1].twist.twist.angular.z > 0.85, 'slip of the tyres')
        self.delete('skid4')
        self.assertEqual(topics_of(), before)

    def test_planar_robot_moves_sideways(self):
        odometry, command = self.spawn_drive('planar', {'/cmd_vel', '/odom', '/tf'})
        command(left=0.3)
        wait_until(lambda: odometry and odometry[-1].twist.twist.linear.y > 0.25, 'it moves')
        self.assertLess(abs(odometry[-1].twist.twist.linear.x), 0.05)

    def test_tricycle_publishes_all_of_its_joints(self):
        topics = {'/cmd_vel', '/odom', '/tf', '/joint_states'}
        odometry, command = self.spawn_drive('tricycle', topics)
        states = self.collect('/joint_states', JointState)
        transforms = self.collect('/tf', TFMessage)
        command(0.3, turn=0.2)
        wait_until(lambda: states and states[-1].position[0] > 0.1, 'it steers')
        self.assertEqual(states[-1].name, STEERED)
        self.assertEqual(len(states[-1].velocity), 4)
        self.assertEqual(list(states[-1].effort), [0.0] * 4)
        wait_until(odometry.__len__, 'odometry')
        wait_until(lambda: len(self.edges(transforms)) >= 5, 'five edges')
        children = {child for _, child in self.edges(transforms)}
        self.assertEqual(children, {'base_footprint', *STEERED})
