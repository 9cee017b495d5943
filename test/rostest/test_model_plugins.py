"""Topics of p3d, joint states, trajectories, force and hand of god, as recorded in Gazebo."""

import itertools
import math

import rospy
from geometry_msgs.msg import TransformStamped, Wrench
from nav_msgs.msg import Odometry
from sensor_msgs.msg import JointState
from simulator import SimulatorTest, topics_of, wait_until
from std_msgs.msg import Header
from tf2_msgs.msg import TFMessage
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

WHEELS = [f'{side}_{end}_joint' for end in ('front', 'rear') for side in ('left', 'right')]
TOLD = {
    '/gt': ('world', 'base_footprint', 20),
    '/gt_off': ('map', 'base_footprint', 20),
    '/gt_noise': ('world', 'base_footprint', 20),
    '/gt_lumped': ('world', 'base_footprint', 20),
    '/gt_wheel': ('base_footprint', 'left_front_link', 34),
    '/gt_default': ('world', 'base_footprint', 1),
}
HALF = rospy.Duration(0.5)


def has_period(messages, period):
    """Tell whether two stamps are one period [ms] apart, and none is off it.

    A slow subscriber misses messages, so the least spacing is seen only after a while.
    """
    stamps = [message.header.stamp.to_nsec() // 1_000_000 for message in list(messages)]
    between = {after - before for before, after in itertools.pairwise(stamps)}
    assert all(gap > 0 and gap % period == 0 for gap in between), between
    return period in between


class ModelPluginsTest(SimulatorTest):
    def setUp(self):
        super().setUp()
        before = topics_of()
        self.addCleanup(lambda: self.assertEqual(topics_of(), before))

    def test_true_poses_and_joint_states_have_gazebos_frames_and_stamps(self):
        self.spawn_recorded(
            'skid4_p3d', {'/cmd_vel', '/odom', '/tf', '/joint_states', '/gt_badframe', *TOLD}
        )
        received = {topic: self.collect(topic, Odometry) for topic in TOLD}
        states = self.collect('/joint_states', JointState)
        self.driver('/cmd_vel')(0.4, 0.5)
        heard = len(states)
        wait_until(lambda: len(states) > heard + 40, 'two seconds of joint states')
        for topic, (frame, child, expected) in TOLD.items():
            message = received[topic][-1]
            self.assertEqual((message.header.frame_id, message.child_frame_id), (frame, child))
            self.assertEqual(message._connection_header.get('latching', '0'), '0')
            wait_until(
                lambda t=topic, p=expected: has_period(received[t], p), f'the period of {topic}'
            )
        wait_until(lambda: has_period(states, 50), 'the period of joint states')
        self.assertEqual(states[-1].name, WHEELS)
        self.assertEqual((states[-1].header.frame_id, list(states[-1].effort)), ('', []))
        self.assertGreater(states[-1].velocity[1], states[-1].velocity[0])
        self.check_poses({topic: messages[-1] for topic, messages in received.items()})

    def check_poses(self, received):
        """Compare messages of almost equal stamps; the robot drives a left curve."""
        twist = received['/gt'].twist.twist
        yaw = 2.0 * math.atan2(
            received['/gt'].pose.pose.orientation.z, received['/gt'].pose.pose.orientation.w
        )
        forward = math.cos(yaw) * twist.linear.x + math.sin(yaw) * twist.linear.y
        self.assertAlmostEqual(forward, 0.4, delta=0.02)
        self.assertAlmostEqual(
            received['/gt_off'].pose.pose.position.z - 3.0,
            received['/gt'].pose.pose.position.z,
            delta=1e-3,
        )
        self.assertAlmostEqual(
            received['/gt_lumped'].pose.pose.position.z - 0.13,
            received['/gt'].pose.pose.position.z,
            delta=1e-3,
        )
        wheel = received['/gt_wheel'].pose.pose.position
        for found, expected in ((wheel.x, 0.18), (wheel.y, 0.22), (wheel.z, 0.1)):
            self.assertAlmostEqual(found, expected, delta=1e-3)

    def test_trajectory_is_played_point_by_point(self):
        self.spawn_recorded(
            'arm_ft', {'/joint_states', '/set_joint_trajectory', '/ft_elbow', '/ft_shoulder'}
        )
        states = self.collect('/joint_states', JointState)
        play = self.publisher('/set_joint_trajectory', JointTrajectory).publish
        for frame in ('', 'nope'):  # an error in the log
            play(
                JointTrajectory(
                    Header(frame_id=frame),
                    ['elbow'],
                    [JointTrajectoryPoint(positions=[2.0], time_from_start=HALF)],
                )
            )
        positions = [(0.3 * k, -0.2 * k) for k in range(1, 4)]
        play(
            JointTrajectory(
                Header(frame_id='world'),
                ['shoulder', 'elbow'],
                [
                    JointTrajectoryPoint(positions=point, time_from_start=HALF)
                    for point in positions
                ],
            )
        )
        wait_until(
            lambda: any(abs(state.position[0] - 0.9) < 1e-9 for state in list(states)),
            'the last point',
        )
        wait_until(lambda: abs(states[-1].position[0] - 0.9) > 1e-3, 'physics again')
        for point in positions:
            held = [state for state in states if state.position == point]
            lasted = held[-1].header.stamp - held[0].header.stamp
            self.assertAlmostEqual(lasted.to_sec(), 0.5, delta=0.05)
        self.assertNotIn(2.0, [state.position[1] for state in states])

    def test_wrench_acts_until_the_next_one(self):
        self.spawn_recorded('force', {'/force'})
        push = self.publisher('/force', Wrench).publish
        wrench = Wrench()
        wrench.force.x, wrench.force.z = 5.0, 60.0
        push(wrench)
        wait_until(lambda: self.model_state('bot', '').twist.linear.x > 0.2, 'motion')
        wrench.force.x = float('nan')
        push(wrench)  # dropped with an error
        wait_until(lambda: self.model_state('bot', '').twist.linear.x > 0.4, 'acceleration')
        twist = self.model_state('bot', '').twist.linear
        self.assertAlmostEqual(twist.z / twist.x, 2.2, delta=0.01)
        push(Wrench())
        wait_until(lambda: self.model_state('bot', '').twist.linear.z < 0.0, 'it falls')

    def test_hand_of_god_follows_a_frame(self):
        self.spawn_recorded('hog', {'/tf', '/tf_static'} - topics_of(), z=0.5)
        lead = self.publisher('/tf', TFMessage)  # before this node reads /tf: it has one reader
        transforms = self.collect('/tf', TFMessage)
        edge = TransformStamped()
        edge.header.frame_id, edge.child_frame_id = 'world', 'hog_desired'
        edge.transform.translation.x = edge.transform.translation.z = 1.0
        edge.transform.rotation.w = 1.0
        self.assertEqual(self.actual(transforms), [])
        self.assertAlmostEqual(self.model_state('bot', '').pose.position.z, 0.5)
        lead.publish(TFMessage([edge]))
        wait_until(lambda: self.model_state('bot', '').pose.position.x > 0.999, 'the frame reached')
        wait_until(lambda: has_period(self.actual(transforms), 1), 'transforms of successive steps')
        received = self.actual(transforms)
        self.assertEqual({edge.header.frame_id for edge in received}, {'world'})
        self.assertLess(max(edge.transform.translation.x for edge in received), 1.0 + 1e-9)

    def actual(self, transforms):
        """Return the published transforms of the link."""
        return [
            edge
            for message in list(transforms)
            for edge in message.transforms
            if edge.child_frame_id == 'hog_actual'
        ]
