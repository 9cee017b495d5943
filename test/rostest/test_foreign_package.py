#!/usr/bin/env python3
"""A package with all dependencies of a Gazebo machine builds, and its C++ reads messages."""

import io
import os
import shutil
import sys
import tempfile
import unittest
from pathlib import Path

import rostest
from gazebo_msgs.msg import LinkStates
from gazebo_msgs.srv import SpawnModel
from geometry_msgs.msg import Point, Pose, Quaternion, Twist
from programs import ran_merged

SOURCE = Path(__file__).resolve().parents[1] / 'data' / 'foreign_package'
BUILD_LIMIT = 600.0  # [s, wall]; usually a tenth of that


class ForeignPackageTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory(prefix='foreign_')
        cls.workspace = Path(cls.enterClassContext(folder))
        shutil.copytree(SOURCE, cls.workspace / 'source')
        cls.run_command(
            'cmake',
            '-S',
            'source',
            '-B',
            'build',
            '-DCATKIN_ENABLE_TESTING=OFF',
            f'-DPYTHON_EXECUTABLE={sys.executable}',
        )
        cls.run_command('cmake', '--build', 'build')

    @classmethod
    def run_command(cls, *command):
        ended = ran_merged(*command, cwd=cls.workspace, timeout=BUILD_LIMIT)
        if ended.returncode != 0:
            raise AssertionError(f'{" ".join(command)} failed:\n{ended.stdout}')
        return ended.stdout

    def test_a_cpp_program_reads_our_messages(self):
        states = LinkStates(
            name=['ground_plane::link', 'box::body'],
            pose=[Pose(Point(0, 0, z), Quaternion(0, 0, 0, 1)) for z in (0.0, 0.25)],
            twist=[Twist(), Twist()],
        )
        buffer = io.BytesIO()
        states.serialize(buffer)
        (self.workspace / 'states').write_bytes(buffer.getvalue())
        program = 'build/devel/lib/foreign_package/link_names'
        self.assertEqual(
            self.run_command(f'./{program}', 'states').splitlines(),
            ['ground_plane::link 0', 'box::body 0.25', SpawnModel._md5sum],
        )

    def test_a_plugin_of_gazebo_stops_with_one_sentence(self):
        with self.assertRaisesRegex(AssertionError, 'There is no Gazebo here, so its plugins'):
            self.run_command('cmake', '--build', 'build', '--target', 'gazebo_plugin')

    def test_its_launch_files_find_ours(self):
        # ROS's word for a metapackage
        for tool, package, path in (
            ('rospack', 'gazebo_dev', 'package.xml'),
            ('rospack', 'gazebo_plugins', 'test/test_worlds/gazebo_ros_range.world'),
            ('rospack', 'gazebo_ros', 'launch/empty_world.launch'),
            ('rosstack', 'gazebo_ros_pkgs', 'package.xml'),
        ):
            found = self.run_command(tool, 'find', package).strip()
            self.assertTrue(os.path.isfile(os.path.join(found, path)), f'{found}/{path}')


if __name__ == '__main__':
    rostest.rosrun('rosbots_description', 'foreign_package', ForeignPackageTest, sys.argv)
