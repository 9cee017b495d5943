"""The window: quiet, with its own TF topics, and a notice when the simulator ends or returns."""

import os
import re
import signal
import subprocess
import tempfile
import unittest
from contextlib import suppress
from pathlib import Path

import numpy as np
import rosnode
import rospy
from gazebo_msgs.msg import ModelState
from gazebo_msgs.srv import SetModelState, SpawnModel
from PIL import Image
from programs import find_program
from simulator import BOX, GROUND, pose, process_of, proxy, wait_until
from terminal import Terminal, open_display
from tf2_msgs.msg import TFMessage
from visualization_msgs.msg import Marker, MarkerArray

from rosbots_description.cli.launched import descendants

STEP = 90.0  # [s, wall] timeout of the start of a program
GONE, BACK = 'gzclient: the simulator has ended', 'gzclient: the simulator is running again'
CRASHED = 'gzclient: RViz crashed as it '  # opened, or was closed: see cli/display.py


PICTURES = Path(__file__).resolve().parents[2] / 'tools' / 'make_pictures.py'
# Colours in the room, and normals of faces that the camera sees. Of the first three, the robot
# is a mesh, and all are movable.
SEEN = [
    ('the plate of the robot', (0.16, 0.47, 0.86), [(0, 0, 1)]),
    ('the crate', (0.25, 0.55, 0.6), [(0, 0, 1), (1, 0, 0)]),
    ('the barrel', (0.9, 0.45, 0.35), [(0, 0, 1)]),
    ('the bookcase', (0.6, 0.42, 0.26), [(0, 0, 1), (1, 0, 0), (0, -1, 0)]),
    ('the wall', (0.85, 0.75, 0.55), [(0, 0, 1), (1, 0, 0)]),
]
TO_SUN = np.array([0.5, -0.1, 0.9]) / np.linalg.norm([0.5, -0.1, 0.9])  # direction of Gazebo's sun
CLOSE = 8  # of 255: the image has few colours
ENOUGH = 200  # pixels; the smallest of those faces has 350

LATE_MASTER = re.compile(r'(Failed to contact|Connected to) master at \[')


def said_by(window):
    """Return the lines on the screen since the last crash of RViz.

    Without those of roscpp about a master that answered late: it asks again.
    """
    lines = [line for line in window.shown().splitlines() if not LATE_MASTER.search(line)]
    crashes = [i + 1 for i, line in enumerate(lines) if line.startswith(CRASHED)]
    return lines[max(crashes, default=0) :]


class WindowTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.addClassCleanup(open_display())

    def open(self, program, *arguments):
        terminal = Terminal(find_program('gazebo_ros', program), *arguments)
        self.addCleanup(terminal.close)
        return terminal

    def server(self):
        terminal = self.open('gzserver')
        rospy.wait_for_service('/gazebo/spawn_urdf_model', STEP)
        return terminal

    def window(self):
        """Open the window and wait until it subscribes to the simulator's markers and frames."""
        terminal = self.open('gzclient', f'__name:={self._testMethodName}')
        self.wait_for_rviz(f'/{self._testMethodName}')
        return terminal

    def wait_for_rviz(self, node):
        wait_until(
            lambda: (
                {'/gazebo/view/markers', '/gazebo/view/frames'} <= self.read_by(node)
                and rosnode.rosnode_ping(node, max_count=1, skip_cache=True)
            ),
            f'the window {node}',
            STEP,
        )

    @staticmethod
    def read_by(node):
        _, readers, _ = rospy.get_master().getSystemState()[2]
        return {topic for topic, nodes in readers if node in nodes}

    @staticmethod
    def rviz_of(terminal):
        """Return the process ids of RViz below a terminal."""
        found = []
        for process in descendants(terminal.process.pid):
            with suppress(OSError):  # it has ended
                if Path(f'/proc/{process}/comm').read_text() == 'rviz\n':
                    found.append(process)
        return found

    def see(self, terminal, text):
        wait_until(lambda: text in terminal.shown(), text, STEP)

    def collect(self, topic, message_class):
        messages = []
        subscriber = rospy.Subscriber(topic, message_class, messages.append)
        self.addCleanup(subscriber.unregister)
        return messages

    def test_window_reads_no_tf_and_prints_nothing(self):
        self.server()
        window = self.window()
        self.assertEqual(self.read_by(f'/{self._testMethodName}') & {'/tf', '/tf_static'}, set())
        window.process.send_signal(signal.SIGINT)
        wait_until(lambda: window.process.poll() is not None, 'the end', STEP)
        self.assertEqual((window.process.returncode, said_by(window)), (0, []))

    def test_window_restarts_rviz_after_a_crash_at_its_start(self):
        self.server()
        node = f'/{self._testMethodName}'
        window = self.open('gzclient', f'__name:={node[1:]}')
        wait_until(lambda: self.rviz_of(window), 'RViz', STEP)
        (first,) = self.rviz_of(window)  # long before it is open, as an open one is not restarted
        os.kill(first, signal.SIGSEGV)
        self.see(window, f'{CRASHED}opened')
        self.wait_for_rviz(node)
        self.assertNotEqual(process_of(node), first)

    def test_second_window_opens_beside_the_first(self):
        self.server()
        first, node = self.window(), f'/{self._testMethodName}'
        second = self.open('gzclient', f'__name:={self._testMethodName}')
        self.see(second, f'a window has the name {node} already; this one is ')
        self.wait_for_rviz(re.search(r'this one is (\S+)', second.shown())[1])
        self.assertIsNone(first.process.poll())
        self.wait_for_rviz(node)

    def test_frames_follow_the_models(self):
        self.server()
        proxy('spawn_urdf_model', SpawnModel)('box', BOX, '/', pose(), '')
        messages = self.collect('/gazebo/view/frames', TFMessage)

        def places():
            return {
                edge.child_frame_id: edge.transform.translation.x
                for message in messages
                for edge in message.transforms
                if edge.header.frame_id == 'world'
            }

        wait_until(lambda: set(places()) == {GROUND, 'box'}, 'all models', STEP)
        state = ModelState(model_name='box', pose=pose(x=7.0))
        self.assertTrue(proxy('set_model_state', SetModelState)(state).success)
        wait_until(lambda: abs(places()['box'] - 7.0) < 0.01, 'the box at its new pose', STEP)

    def test_picture_of_the_readme_is_lit_by_the_sun(self):
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([PICTURES, folder, 'gzclient.png'], check=True, timeout=2.0 * STEP)
            (made,) = Path(folder).iterdir()
            pixels = np.asarray(Image.open(made).convert('RGB')).astype(float)
        for thing, colour, normals in SEEN:
            for normal in normals:
                lit = 255.0 * np.array(colour) * (0.62 + 0.38 * np.dot(normal, TO_SUN))
                there = (np.abs(pixels - lit) <= CLOSE).all(axis=2).sum()
                self.assertGreater(there, ENOUGH, (thing, normal, lit))

    def test_notice_when_the_simulator_ends_and_returns(self):
        server, window = self.server(), self.window()
        markers = self.collect('/gazebo/view/markers', MarkerArray)
        wait_until(lambda: markers, 'the scene', STEP)
        markers.clear()
        server.process.send_signal(signal.SIGKILL)
        self.see(window, GONE)
        wait_until(
            lambda: any(
                marker.type == Marker.TEXT_VIEW_FACING and marker.text == 'the simulator has ended'
                for message in list(markers)
                for marker in message.markers
            ),
            'the notice in the scene',
            STEP,
        )
        self.assertIsNone(window.process.poll())
        self.server()
        self.see(window, BACK)
        window.process.send_signal(signal.SIGTERM)
        wait_until(lambda: window.process.poll() is not None, 'the end', STEP)
        self.assertEqual(window.process.returncode, 0, window.shown())
        self.assertNotIn('Traceback', window.shown())
        # RViz itself may report that time has jumped back
        logged = [line for line in said_by(window) if line.startswith('gzclient:')]
        self.assertEqual(len(logged), 2, window.shown())
