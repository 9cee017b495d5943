#!/usr/bin/env python3
"""teleop_twist_keyboard.py on a pseudo-terminal: commands that it publishes."""

import signal
import sys
import threading
import time
import unittest

import rospy
import rostest
from geometry_msgs.msg import Twist
from simulator import DEADLINE
from terminal import Terminal


def wait_for(condition):
    """Return the first true value of a condition, or its last value at the deadline."""
    end = time.monotonic() + DEADLINE
    while time.monotonic() < end:
        value = condition()
        if value:
            return value
        time.sleep(0.01)
    return condition()


class TeleopTest(unittest.TestCase):
    """Starts the program for each test."""

    def setUp(self):
        self._lock = threading.Lock()
        self._commands = []  # (linear x, angular z) in order of arrival
        self._subscriber = None
        self._terminal = None

    def tearDown(self):
        if self._terminal:
            self._terminal.close()
        if self._subscriber:
            self._subscriber.unregister()
        # Private parameters remain after the end of the node.
        if rospy.has_param('/teleop_twist_keyboard'):
            rospy.delete_param('/teleop_twist_keyboard')

    def _start(self, topic, *arguments):
        self._terminal = Terminal(
            'rosrun',
            'teleop_twist_keyboard',
            'teleop_twist_keyboard.py',
            f'/cmd_vel:={topic}',
            *arguments,
        )

    def _listen(self, topic):
        def hear(twist):
            with self._lock:
                self._commands.append((twist.linear.x, twist.angular.z))

        self._subscriber = rospy.Subscriber(topic, Twist, hear)

    def _heard(self):
        with self._lock:
            return list(self._commands)

    def _press(self, key, *expected):
        """Type a key and wait for a command (linear x [m/s], angular z [rad/s]) sent after it."""
        before = len(self._heard())
        self._terminal.type(key)
        self.assertTrue(
            wait_for(lambda: expected in self._heard()[before:]),
            f'{key!r} should give {expected}, gave {self._heard()[before:]}',
        )

    def _assert_ends_well(self):
        self.assertEqual(self._terminal.process.wait(DEADLINE), 0, self._terminal.shown())
        self.assertEqual(self._terminal.mode(), self._terminal.saved_mode)
        self.assertNotIn('Traceback', self._terminal.shown())

    def test_keys_publish_on_the_articles_topic(self):
        self._listen('/part2_cmr/cmd_vel')
        self._start('/part2_cmr/cmd_vel', '_key_timeout:=0')
        self.assertTrue(
            wait_for(lambda: 'currently:\tspeed 0.5\tturn 1.0' in self._terminal.shown()),
            self._terminal.shown(),
        )
        self.assertTrue(wait_for(lambda: self._heard()[:1] == [(0.0, 0.0)]), self._heard())
        self._press('i', 0.5, 0.0)
        self._press('j', 0.0, 1.0)
        self._press('k', 0.0, 0.0)
        self._press('l', 0.0, -1.0)
        self._press(',', -0.5, 0.0)
        self._press('q', -0.55, 0.0)
        self._press('u', 0.55, 1.1)
        self._terminal.type('\x03')
        self._assert_ends_well()
        self.assertTrue(wait_for(lambda: self._heard()[-1] == (0.0, 0.0)), self._heard())

    def test_robot_stops_when_no_key_is_pressed(self):
        self._listen('/part2_cmr/cmd_vel')
        self._start('/part2_cmr/cmd_vel')
        self.assertTrue(wait_for(lambda: 'currently:' in self._terminal.shown()))
        self._press('i', 0.5, 0.0)
        self.assertTrue(wait_for(lambda: self._heard()[-1] == (0.0, 0.0)), self._heard())

    def test_waits_with_a_message_without_a_subscriber(self):
        self._start('/nobody/cmd_vel')
        line = 'Waiting for subscriber to connect to /nobody/cmd_vel'
        self.assertTrue(wait_for(lambda: line in self._terminal.shown()), self._terminal.shown())
        self._listen('/nobody/cmd_vel')
        self.assertTrue(wait_for(lambda: 'Ctrl-C' in self._terminal.shown()))
        self._press('i', 0.5, 0.0)

    def test_ctrl_c_ends_the_wait(self):
        self._start('/nobody/cmd_vel')
        self.assertTrue(wait_for(lambda: 'Waiting for subscriber' in self._terminal.shown()))
        self._terminal.process.send_signal(signal.SIGINT)
        self._assert_ends_well()

    def test_shutdown_of_the_node_stops_the_robot(self):
        self._listen('/part2_cmr/cmd_vel')
        self._start('/part2_cmr/cmd_vel', '_key_timeout:=0')
        self.assertTrue(wait_for(lambda: 'currently:' in self._terminal.shown()))
        self._press('i', 0.5, 0.0)
        self._terminal.process.send_signal(signal.SIGINT)
        self._assert_ends_well()
        self.assertTrue(wait_for(lambda: self._heard()[-1] == (0.0, 0.0)), self._heard())

    def test_last_command_is_repeated_at_the_rate(self):
        self._listen('/part2_cmr/cmd_vel')
        self._start('/part2_cmr/cmd_vel', '_repeat_rate:=20', '_key_timeout:=0')
        self.assertTrue(wait_for(lambda: 'currently:' in self._terminal.shown()))
        self._press('i', 0.5, 0.0)
        self.assertTrue(wait_for(lambda: self._heard()[-5:] == [(0.5, 0.0)] * 5), self._heard())


if __name__ == '__main__':
    rospy.init_node('test_teleop')
    rostest.rosrun('rosbots_description', 'teleop', TeleopTest, sys.argv)
