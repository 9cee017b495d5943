"""teleop_twist_keyboard.py on a pseudo-terminal: commands that it publishes."""

import signal
import unittest

import rospy
from geometry_msgs.msg import Twist
from programs import find_program
from simulator import DEADLINE, wait_until
from terminal import Terminal


class TeleopTest(unittest.TestCase):
    """Starts the program for each test."""

    def setUp(self):
        self._commands = []  # (linear x [m/s], angular z [rad/s]) in order of arrival

    def tearDown(self):
        self.doCleanups()
        # Private parameters remain after the end of the node.
        if rospy.has_param('/teleop_twist_keyboard'):
            rospy.delete_param('/teleop_twist_keyboard')

    def _start(self, topic, *arguments):
        self._terminal = Terminal(
            find_program('teleop_twist_keyboard', 'teleop_twist_keyboard.py'),
            f'/cmd_vel:={topic}',
            *arguments,
        )
        self.addCleanup(self._terminal.close)

    def _listen(self, topic):
        def hear(twist):
            self._commands.append((twist.linear.x, twist.angular.z))

        self.addCleanup(rospy.Subscriber(topic, Twist, hear).unregister)

    def _see(self, text):
        wait_until(lambda: text in self._terminal.shown(), text)

    def _press(self, key, *expected):
        """Type a key and wait for a command (linear x [m/s], angular z [rad/s]) sent after it."""
        before = len(self._commands)
        self._terminal.type(key)
        wait_until(lambda: expected in self._commands[before:], f'{expected} after {key!r}')

    def _hear_stop(self):
        wait_until(lambda: self._commands[-1] == (0.0, 0.0), 'a stop')

    def _assert_ends_well(self):
        self.assertEqual(self._terminal.process.wait(DEADLINE), 0, self._terminal.shown())
        self.assertEqual(self._terminal.mode(), self._terminal.saved_mode)
        self.assertNotIn('Traceback', self._terminal.shown())

    def test_keys_publish_on_the_articles_topic(self):
        self._listen('/part2_cmr/cmd_vel')
        self._start('/part2_cmr/cmd_vel', '_key_timeout:=0')
        self._see('currently:\tspeed 0.5\tturn 1.0')
        wait_until(lambda: self._commands, 'a first command')
        self.assertEqual(self._commands[0], (0.0, 0.0))
        self._press('i', 0.5, 0.0)
        self._press('j', 0.0, 1.0)
        self._press('k', 0.0, 0.0)
        self._press('l', 0.0, -1.0)
        self._press(',', -0.5, 0.0)
        self._press('q', -0.55, 0.0)
        self._press('u', 0.55, 1.1)
        self._terminal.type('\x03')
        self._assert_ends_well()
        self._hear_stop()

    def test_robot_stops_when_no_key_is_pressed(self):
        self._listen('/part2_cmr/cmd_vel')
        self._start('/part2_cmr/cmd_vel')
        self._see('currently:')
        self._press('i', 0.5, 0.0)
        self._hear_stop()

    def test_waits_with_a_message_without_a_subscriber(self):
        self._start('/nobody/cmd_vel')
        self._see('Waiting for subscriber to connect to /nobody/cmd_vel')
        self._listen('/nobody/cmd_vel')
        self._see('Ctrl-C')
        self._press('i', 0.5, 0.0)

    def test_ctrl_c_ends_the_wait(self):
        self._start('/nobody/cmd_vel')
        self._see('Waiting for subscriber')
        self._terminal.process.send_signal(signal.SIGINT)
        self._assert_ends_well()

    def test_shutdown_of_the_node_stops_the_robot(self):
        self._listen('/part2_cmr/cmd_vel')
        self._start('/part2_cmr/cmd_vel', '_key_timeout:=0')
        self._see('currently:')
        self._press('i', 0.5, 0.0)
        self._terminal.process.send_signal(signal.SIGINT)
        self._assert_ends_well()
        self._hear_stop()

    def test_last_command_is_repeated_at_the_rate(self):
        self._listen('/part2_cmr/cmd_vel')
        self._start('/part2_cmr/cmd_vel', '_repeat_rate:=20', '_key_timeout:=0')
        self._see('currently:')
        self._press('i', 0.5, 0.0)
        wait_until(lambda: self._commands[-5:] == [(0.5, 0.0)] * 5, 'repetitions')
