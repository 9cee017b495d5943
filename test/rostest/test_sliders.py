"""rviz.launch with sliders: joint states have the values of the sliders."""

import math
import unittest

import rospy
from sensor_msgs.msg import JointState
from simulator import wait_until
from terminal import Terminal, open_display

START = 90.0  # [s, wall] timeout of launch file and window
SLIDER = 2.0 * math.pi / 10000  # [rad] resolution of a slider
AT_FIRST = {'wheel_left_joint': 1.0, 'wheel_right_joint': 0.0}  # [rad]


class SlidersTest(unittest.TestCase):
    def test_window_publishes_the_values_of_its_sliders(self):
        rospy.set_param('/zeros/wheel_left_joint', AT_FIRST['wheel_left_joint'])
        messages = []
        rospy.Subscriber('/joint_states', JointState, messages.append)
        self.addCleanup(open_display())
        terminal = Terminal(
            'roslaunch', 'rosbots_description', 'rviz.launch', 'gui:=true', 'rviz:=false'
        )
        self.addCleanup(terminal.close)
        try:
            wait_until(lambda: messages or 'has died' in terminal.shown(), 'joint states', START)
        finally:
            terminal.end()
        self.assertTrue(messages, terminal.shown())
        self.assertEqual(messages[-1]._connection_header['callerid'], '/joint_state_publisher_gui')
        shown = dict(zip(messages[-1].name, messages[-1].position, strict=True))
        self.assertEqual(set(shown), set(AT_FIRST))
        for joint, position in AT_FIRST.items():
            self.assertAlmostEqual(shown[joint], position, delta=SLIDER)
        self.assertNotIn('Traceback', terminal.shown())
