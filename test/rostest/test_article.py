#!/usr/bin/env python3
"""The nine steps of the article, each in its own terminal."""

import signal
import sys
import unittest
from pathlib import Path

import debian_rviz
import rospy
import rostest
from gazebo_msgs.srv import GetModelState
from programs import ran
from simulator import wait_until
from terminal import Terminal, open_display

STEP = 90.0  # [s, wall] timeout of the output of a step
MOVED = 0.05  # [m] or [rad], far more than a standing robot drifts
TELEOP = [
    'rosrun',
    'teleop_twist_keyboard',
    'teleop_twist_keyboard.py',
    '/cmd_vel:=/part2_cmr/cmd_vel',
]
ROSBOTS = Path(__file__).resolve().parents[2] / 'rosbots'
SPAWN = ['roslaunch', 'rosbots_description', 'spawn.launch']
WAITING = 'Waiting for service /gazebo/spawn_urdf_model'
SPAWNED = 'Spawn status: SpawnModel: Successfully spawned entity'
DELETE = ['rosservice', 'call', '/gazebo/delete_model', "model_name: 'rosbots'"]


def output_of(*command, script=''):
    return ran(*command, input=script, timeout=STEP, check=True).stdout


class ArticleTest(unittest.TestCase):
    def setUp(self):
        self._terminals = []

    def tearDown(self):
        for terminal in reversed(self._terminals):
            terminal.end(signal.SIGTERM)
            terminal.close()

    def open(self, *command):
        terminal = Terminal(*command)
        self._terminals.append(terminal)
        return terminal

    def see(self, terminal, text):
        wait_until(lambda: text in terminal.shown(), f'{text!r} on the screen', STEP)

    def state(self):
        answer = rospy.ServiceProxy('/gazebo/get_model_state', GetModelState)('rosbots', '')
        self.assertTrue(answer.success)
        return answer

    def standing(self):
        return abs(self.state().pose.position.z + 0.12) < 0.01

    def press(self, teleop, key, quantity, sign):
        """Press a key, wait until the robot has moved in the right direction, and stop it."""
        start = quantity(self.state())

        def moves():
            teleop.type(key)  # held, as a terminal repeats it
            return sign * (quantity(self.state()) - start) > MOVED

        wait_until(moves, f'motion by {key!r}')
        teleop.type('k')
        wait_until(
            lambda: (
                abs(self.state().twist.linear.x) < 0.01 and abs(self.state().twist.angular.z) < 0.01
            ),
            'the stop',
        )

    def test_all_steps(self):
        # 1: the package is found
        where = output_of(ROSBOTS, 'shell', script='roscd rosbots_description && ls')
        self.assertIn('package.xml', where)
        # 5: spawn_model waits for a simulator
        early = self.open(*SPAWN)
        self.see(early, WAITING)
        self.assertIsNone(early.process.poll())
        # 3: the simulator, with its window if there is a display; the waiting spawn completes
        simulator = self.open(*['roslaunch', 'gazebo_ros', 'empty_world.launch'])
        self.see(early, SPAWNED)
        self.see(early, 'process has finished cleanly')
        # 6: the model is deleted with the topics of its plugin
        self.assertIn('/part2_cmr/cmd_vel', output_of('rostopic', 'list').split())
        answer = output_of(*DELETE)
        self.assertIn('success: True', answer)
        self.assertIn('DeleteModel: successfully deleted model', answer)
        self.assertNotIn('/part2_cmr/cmd_vel', output_of('rostopic', 'list').split())
        # 4 and 7: it is spawned again
        again = self.open(*SPAWN)
        self.see(again, SPAWNED)
        self.assertIn('/part2_cmr/cmd_vel', output_of('rostopic', 'list').split())
        wait_until(self.standing, 'the robot standing on its wheels')
        # 8: keyboard teleoperation
        teleop = self.open(*TELEOP)
        self.see(teleop, 'currently:')
        self.press(teleop, 'i', lambda state: state.pose.position.x, 1)
        self.press(teleop, ',', lambda state: state.pose.position.x, -1)
        self.press(teleop, 'j', lambda state: state.pose.orientation.z, 1)
        self.press(teleop, 'l', lambda state: state.pose.orientation.z, -1)
        # 9: Ctrl-C ends everything
        teleop.type('\x03')
        self.assertEqual(teleop.process.wait(STEP), 0)
        self.assertEqual(simulator.end(), 0, simulator.shown())

    def test_rviz_shows_the_robot(self):
        # 2: on the user's display or a virtual one
        self.addCleanup(open_display())
        command = ('roslaunch', 'rosbots_description', 'rviz.launch')
        view = debian_rviz.start(lambda: self.open(*command), STEP)
        for node in ('/joint_state_publisher', '/robot_state_publisher', '/rviz'):
            wait_until(lambda node=node: node in output_of('rosnode', 'list').split(), node, STEP)
        view.end()


if __name__ == '__main__':
    rospy.init_node('test_article', disable_rostime=True)
    rostest.rosrun('rosbots_description', 'article', ArticleTest, sys.argv)
