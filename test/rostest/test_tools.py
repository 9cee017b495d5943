"""The ROS tools listed in doc/interface.md are found by rosrun and work with the simulator."""

import re
import signal
import subprocess
import tempfile
from pathlib import Path

import rospy
from programs import ran
from simulator import DEADLINE, SimulatorTest, pose, wait_until

ROOT = Path(__file__).resolve().parents[2]
TOOLS = (ROOT / 'doc' / 'interface.md').read_text(encoding='utf-8')
PRINTED = re.compile(r'Translation: \[(\S+), (\S+), ')  # by tf_echo: x and y [m]
# Documented there as missing, or as part of further packages.
NOT_THERE = {'rqt_graph'}
OPTIONAL = {
    'image_view': ('ros-image-view', 'libimage-view-dev'),
    'topic_tools': ('topic-tools', 'libtopic-tools-dev'),
}


def rosrun(*arguments, **options):
    return ran('rosrun', *arguments, check=True, **options).stdout


def succeeds(*command):
    return ran(*command).returncode == 0


class ToolsTest(SimulatorTest):
    def test_rosrun_finds_every_program_that_is_listed(self):
        named = set(re.findall(r'rosrun (\w+) ([\w.]+)', TOOLS))
        self.assertLessEqual({('tf', 'tf_echo'), ('dynamic_reconfigure', 'dynparam')}, named)
        for package, program in sorted(named):
            if package in OPTIONAL and not succeeds('dpkg', '-s', *OPTIONAL[package]):
                continue
            with self.subTest(package, program=program):
                found = succeeds('rosrun', '--prefix', 'true', package, program)
                self.assertEqual(found, package not in NOT_THERE)

    def test_tf_echo_prints_the_pose_of_the_robot(self):
        self.spawn(at=pose(x=1.0, y=-2.0))
        echo = subprocess.Popen(
            ['rosrun', 'tf', 'tf_echo', 'odom', 'base_link'], stdout=subprocess.PIPE, text=True
        )
        self.addCleanup(echo.stdout.close)
        self.addCleanup(echo.wait)
        self.addCleanup(echo.send_signal, signal.SIGINT)  # at others it stays registered
        shown = wait_until(lambda: PRINTED.search(echo.stdout.readline()), 'a transform')
        for printed, spawned in zip(shown.groups(), (1.0, -2.0), strict=True):
            self.assertAlmostEqual(float(printed), spawned, delta=0.1)  # it rocks as it lands

    def test_view_frames_draws_the_tree(self):
        self.spawn()
        with tempfile.TemporaryDirectory() as folder:
            rosrun('tf2_tools', 'view_frames.py', cwd=folder)
            tree = Path(folder, 'frames.gv').read_text()
            self.assertIn('"odom" -> "base_link"', tree)
            self.assertTrue(Path(folder, 'frames.pdf').read_bytes().startswith(b'%PDF'))

    def test_dynparam_shows_and_changes_the_physics(self):
        rospy.wait_for_service('/gazebo/set_parameters', DEADLINE)
        self.assertIn('/gazebo', rosrun('dynamic_reconfigure', 'dynparam', 'list').split())
        for gravity in ('-3.7', '-9.8'):
            rosrun('dynamic_reconfigure', 'dynparam', 'set', '/gazebo', 'gravity_z', '--', gravity)
            output = rosrun('dynamic_reconfigure', 'dynparam', 'get', '/gazebo')
            self.assertIn(f"'gravity_z': {gravity}", output)
