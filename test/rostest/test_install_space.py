#!/usr/bin/env python3
"""Everything works from the install space, without the source tree."""

import os
import signal
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import rospy
import rostest
from gazebo_msgs.srv import GetModelState
from simulator import wait_until

BUILD = Path(__file__).resolve().parents[2] / '.ws' / 'build'
PATIENCE = 300.0  # [s, wall] timeout of installation and of a start
OURS = ('ROS_PACKAGE_PATH', 'PYTHONPATH', 'CMAKE_PREFIX_PATH', 'LD_LIBRARY_PATH')


class InstallSpaceTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.root = Path(cls.enterClassContext(tempfile.TemporaryDirectory()))
        subprocess.run(
            ['cmake', '--install', str(BUILD)],  # ./rosbots setup has built everything
            env={**os.environ, 'DESTDIR': str(cls.root)},
            stdout=subprocess.DEVNULL,
            check=True,
            timeout=PATIENCE,
        )
        (cls.setup,) = cls.root.rglob('install/setup.bash')

    def start(self, command):
        """Run a command in an environment with the install space and without the source tree."""
        environment = {name: value for name, value in os.environ.items() if name not in OURS}
        return subprocess.Popen(
            ['bash', '-c', f'. "{self.setup}" && exec {command}'],
            env=environment,
            text=True,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            start_new_session=True,
        )

    def output(self, command):
        printed, _ = self.start(command).communicate(timeout=PATIENCE)
        return printed.strip()

    def test_packages_and_modules_are_found_in_the_install_space(self):
        for package in (
            'rosbots_description',
            'rosbots_simulator',
            'gazebo_ros',
            'gazebo_msgs',
            'xacro',
        ):
            self.assertTrue(self.output(f'rospack find {package}').startswith(str(self.root)))
        code = (
            'import rosbots_description, gazebo_ros.gazebo_interface as g; '
            'import rosbots_simulator.cli.gzclient as c; '
            'print(rosbots_description.__file__, g.__file__, c.__file__)'
        )
        for path in self.output(f'python3 -c "{code}"').split():
            self.assertTrue(path.startswith(str(self.root)), path)

    def test_files_of_the_window_are_installed(self):
        code = 'import rosbots_simulator.cli.gzclient as c; print(c.config_file())'
        config = self.output(f'python3 -c "{code}"')
        self.assertTrue(config.startswith(str(self.root)), config)
        self.assertTrue(Path(config).is_file(), config)
        media = self.output('rospack plugins --attrib=ogre_media_path media_export')
        (folder,) = (
            line.split()[1] for line in media.splitlines() if line.startswith('rosbots_simulator ')
        )
        self.assertTrue(folder.startswith(str(self.root)), folder)
        self.assertTrue(Path(folder, 'sunlit.material').is_file(), folder)

    def test_robot_can_be_driven(self):
        launched = self.start('roslaunch rosbots_description simulation.launch gui:=false')
        try:
            for line in launched.stdout:
                if 'Successfully spawned entity' in line:
                    break
            else:
                self.fail('nothing was spawned')
            rospy.wait_for_service('/gazebo/get_model_state', PATIENCE)
            state = rospy.ServiceProxy('/gazebo/get_model_state', GetModelState)
            wait_until(lambda: state('rosbots', '').pose.position.z < -0.11, 'the robot', PATIENCE)
        finally:
            os.killpg(launched.pid, signal.SIGINT)
            launched.communicate(timeout=PATIENCE)


if __name__ == '__main__':
    rospy.init_node('test_install_space', disable_rostime=True)
    rostest.rosrun('rosbots_description', 'install_space', InstallSpaceTest, sys.argv)
