#!/usr/bin/env python3
"""The window: quiet, with frames of its own, and it says when the simulator goes and comes."""

import signal
import sys
import unittest

import rospy
import rostest
from gazebo_msgs.msg import ModelState
from gazebo_msgs.srv import SetModelState, SpawnModel
from simulator import BOX, GROUND, pose, proxy, wait_until
from terminal import Terminal, open_display
from tf2_msgs.msg import TFMessage
from visualization_msgs.msg import Marker, MarkerArray

STEP = 40.0  # [s, wall] for a program to come up on a slow machine
GONE, BACK = 'gzclient: the simulator has gone', 'gzclient: there is a simulator again'


class WindowTest(unittest.TestCase):

    @classmethod
    def setUpClass(cls):
        cls.addClassCleanup(open_display())

    def open(self, program, *arguments):
        terminal = Terminal('rosrun', 'gazebo_ros', program, *arguments)
        self.addCleanup(terminal.close)
        return terminal

    def server(self):
        terminal = self.open('gzserver')
        rospy.wait_for_service('/gazebo/spawn_urdf_model', STEP)
        return terminal

    def window(self):
        """Open the window and wait until it takes markers and frames of the simulator."""
        terminal = self.open('gzclient', f'__name:={self._testMethodName}')
        wait_until(lambda: {'/gazebo/visual_markers', '/gazebo/view/frames'} <= self.read_by_rviz(),
                   'the window', STEP)
        return terminal

    def read_by_rviz(self):
        _, readers, _ = rospy.get_master().getSystemState()[2]
        return {topic for topic, nodes in readers if f'/{self._testMethodName}' in nodes}

    def see(self, terminal, text):
        wait_until(lambda: text in terminal.shown(), text, STEP)

    def collect(self, topic, message_class):
        messages = []
        subscriber = rospy.Subscriber(topic, message_class, messages.append)
        self.addCleanup(subscriber.unregister)
        return messages

    def test_it_reads_no_tf_and_says_nothing(self):
        self.server()
        window = self.window()
        self.assertEqual(self.read_by_rviz() & {'/tf', '/tf_static'}, set())
        window.process.send_signal(signal.SIGINT)
        wait_until(lambda: window.process.poll() is not None, 'the end', STEP)
        self.assertEqual((window.process.returncode, window.shown()), (0, ''))

    def test_frames_follow_the_models(self):
        self.server()
        proxy('spawn_urdf_model', SpawnModel)('box', BOX, '/', pose(), '')
        messages = self.collect('/gazebo/view/frames', TFMessage)

        def places():
            return {edge.child_frame_id: edge.transform.translation.x
                    for message in messages for edge in message.transforms
                    if edge.header.frame_id == 'world'}

        wait_until(lambda: set(places()) == {GROUND, 'box'}, 'all models', STEP)
        state = ModelState(model_name='box', pose=pose(x=7.0))
        self.assertTrue(proxy('set_model_state', SetModelState)(state).success)
        wait_until(lambda: abs(places()['box'] - 7.0) < 0.01, 'the box where it was set', STEP)

    def test_it_says_when_the_simulator_has_gone_and_when_there_is_one_again(self):
        server, window = self.server(), self.window()
        markers = self.collect('/gazebo/visual_markers', MarkerArray)
        wait_until(lambda: markers, 'the scene', STEP)
        markers.clear()
        server.process.send_signal(signal.SIGKILL)
        self.see(window, GONE)
        wait_until(lambda: any(marker.type == Marker.TEXT_VIEW_FACING
                               and marker.text == 'the simulator has gone'
                               for message in list(markers) for marker in message.markers),
                   'the notice in the scene', STEP)
        self.assertIsNone(window.process.poll())
        self.server()
        self.see(window, BACK)
        window.process.send_signal(signal.SIGTERM)
        wait_until(lambda: window.process.poll() is not None, 'the end', STEP)
        self.assertEqual(window.process.returncode, 0, window.shown())
        self.assertNotIn('Traceback', window.shown())
        # RViz itself may say that time has jumped back
        said = [line for line in window.shown().splitlines() if line.startswith('gzclient:')]
        self.assertEqual(len(said), 2, window.shown())


if __name__ == '__main__':
    rospy.init_node('test_window', disable_rostime=True)
    rostest.rosrun('rosbots_description', 'window', WindowTest, sys.argv)
