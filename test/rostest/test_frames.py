#!/usr/bin/env python3
"""rviz.launch with the simulator, started in both orders: one TF tree, and quiet terminals."""

import os
import re
import sys
import tempfile
import unittest
from pathlib import Path
from unittest import mock

import debian_rviz
import rospy
import rostest
from geometry_msgs.msg import Twist
from sensor_msgs.msg import JointState
from simulator import wait_until
from terminal import Terminal, open_display
from tf2_msgs.msg import TFMessage

STEP = 90.0  # [s, wall] timeout of the output of a launch file
NO_WINDOW = 'gui:=false'  # in all tests but one: it is another RViz
LINES = 40  # limit of lines in a terminal
DRIVEN = 0.5  # [m]: about two seconds; a defect printed 400 lines in that time
NUDGE = 0.1  # [m]
TURNED = 1.0  # [rad]: less than the rotation of the wheels over that distance
ARTICLE = """<launch>
  <param name="robot_description" command="xacro '$(find rosbots_description)/urdf/rosbots.xacro'"/>
  <node name="joint_state_publisher" pkg="joint_state_publisher" type="joint_state_publisher"/>
  <node name="robot_state_publisher" pkg="robot_state_publisher" type="robot_state_publisher"/>
  <node name="rviz" pkg="rviz" type="rviz"/>
</launch>
"""
WHEELS = {'wheel_left_link', 'wheel_right_link'}
TREE = {
    'base_footprint': {'odom'},
    'base_link': {'base_footprint'},
    'wheel_left_link': {'base_link'},
    'wheel_right_link': {'base_link'},
}
DRIVEN_TREE = {child: parents for child, parents in TREE.items() if child != 'base_link'}
BY_THE_TAGS = {
    'base_link': {'odom'},
    'wheel_left_link': {'base_footprint'},
    'wheel_right_link': {'base_footprint'},
}
# Escape sequences of titles and colours.
CONTROL = re.compile(r'\x1b\][^\x07]*\x07|\x1b\[[0-9;]*m')


class FramesTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.addClassCleanup(open_display())

    def setUp(self):
        self._folder = self.enterContext(tempfile.TemporaryDirectory())
        self._view = Path(self._folder, debian_rviz.SAVED)
        debian_rviz.draw_seldom(self._view)
        self.enterContext(mock.patch.dict(os.environ, HOME=self._folder))
        self._edges = {}
        for topic in ('/tf', '/tf_static'):
            subscriber = rospy.Subscriber(topic, TFMessage, self._note)
            self.addCleanup(subscriber.unregister)
        self._travelled = 0.0
        self._joints = {}  # node -> its latest joint states
        subscriber = rospy.Subscriber('/joint_states', JointState, self._note_joints)
        self.addCleanup(subscriber.unregister)

    def _note_joints(self, message):
        self._joints[message._connection_header['callerid']] = dict(
            zip(message.name, message.position, strict=True)
        )

    def _note(self, message):
        for transform in message.transforms:
            self._edges.setdefault(transform.child_frame_id, set()).add(transform.header.frame_id)
            if transform.header.frame_id == 'odom':
                self._travelled = transform.transform.translation.x

    def open(self, *command):
        terminal = Terminal(*command)
        self.addCleanup(terminal.close)
        self.addCleanup(terminal.end)
        return terminal

    def rviz(self, own=False):
        """Launch rviz.launch, a reader's or ours, and wait until RViz is ready."""
        if own:
            words = [os.path.join(self._folder, 'rviz.launch')]
            Path(words[0]).write_text(ARTICLE)
        else:
            words = ['rosbots_description', 'rviz.launch', f'rviz_config:={self._view}']
        return debian_rviz.start(lambda: self.open('roslaunch', *words), STEP)

    def simulator(self, *arguments):
        terminal = self.open('roslaunch', 'gazebo_ros', 'empty_world.launch', *arguments)
        rospy.wait_for_service('/gazebo/spawn_urdf_model', STEP)
        spawn = self.open('roslaunch', 'rosbots_description', 'spawn.launch')
        wait_until(lambda: 'Successfully spawned entity' in spawn.shown(), 'the spawn', STEP)
        return terminal

    def drive(self, distance=DRIVEN):
        """Drive by a distance [m]; return the TF edges received meanwhile."""
        publisher = rospy.Publisher('/part2_cmr/cmd_vel', Twist, queue_size=1)
        self.addCleanup(publisher.unregister)
        wait_until(publisher.get_num_connections, 'the plugin', STEP)
        self._edges.clear()
        end = self._travelled + distance
        command = Twist()
        command.linear.x = 0.3
        publisher.publish(command)
        wait_until(lambda: self._travelled > end, 'the drive', STEP)
        publisher.publish(Twist())
        return {
            child: self._edges[child]
            for child in (*WHEELS, 'base_link', 'base_footprint')
            if child in self._edges
        }

    def assert_complete_and_quiet(self, terminals):
        """Drive; assert that the TF tree is complete and terminals are quiet."""
        # RViz may be ready before the state publisher: the frames change hands meanwhile
        wait_until(lambda: self.drive(NUDGE).items() >= DRIVEN_TREE.items(), 'the tree', STEP)
        moved = self.drive()  # without latched static transforms
        self.assertEqual(moved, {child: TREE[child] for child in moved})
        self.assertTrue(DRIVEN_TREE.keys() <= set(moved), moved)
        wait_until(self._angles_agree, f'the same angles in {self._joints}', STEP)
        for terminal in terminals:
            shown = CONTROL.sub('', terminal.shown())
            lines = [line for line in shown.splitlines() if line.strip()]
            self.assertLessEqual(len(lines), LINES, shown)
            # Debian's RViz may also crash later by the heap that it corrupts at its start.
            ours = debian_rviz.CRASH.sub('', shown)
            self.assertNotRegex(ours, 'Traceback|has died|no such package|QStandard')
            # A new state publisher may publish each wheel once before it is known.
            self.assertLessEqual(shown.count('TF_'), len(WHEELS), shown)

    def _angles_agree(self):
        told, passed_on = (
            self._joints.get(f'/{name}') for name in ('gazebo', 'joint_state_publisher')
        )
        return (
            told
            and passed_on
            and all(
                abs(angle) > TURNED and abs(angle - passed_on[joint]) < TURNED / 10
                for joint, angle in told.items()
            )
        )

    def test_rviz_before_the_simulator(self):
        view = self.rviz()
        self.assert_complete_and_quiet([view, self.simulator()])

    def test_rviz_after_the_simulator_and_closed_again(self):
        simulator = self.simulator(NO_WINDOW)
        self.assertEqual(self.drive(), BY_THE_TAGS)
        view = self.rviz()
        self.assert_complete_and_quiet([view, simulator])
        view.end()
        wait_until(lambda: self.drive() == BY_THE_TAGS, 'the frames by the tags', STEP)

    def test_a_readers_own_rviz_before_the_simulator(self):
        view = self.rviz(own=True)
        self.assert_complete_and_quiet([view, self.simulator(NO_WINDOW)])

    def test_a_readers_own_rviz_after_the_simulator(self):
        simulator = self.simulator(NO_WINDOW)
        self.assert_complete_and_quiet([self.rviz(own=True), simulator])


if __name__ == '__main__':
    rospy.init_node('test_frames', disable_rostime=True)
    rostest.rosrun('rosbots_description', 'frames', FramesTest, sys.argv)
