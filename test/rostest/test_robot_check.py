"""A robot is built, what its launch file starts is simulated, and its rostests run."""

import sys
import tempfile
import unittest
from pathlib import Path
from xml.etree import ElementTree

from programs import ran_merged

ROOT = Path(__file__).resolve().parents[2]
CHECK = ROOT / 'tools' / 'robot_check' / 'check.py'
PATIENCE = 400.0  # [s, wall]; usually a tenth of that
MANIFEST = """<package format="2"><name>box_robot</name><version>0.0.0</version>
<description>A box.</description><maintainer email="a@example.org">a</maintainer>
<license>BSD</license><buildtool_depend>catkin</buildtool_depend></package>"""
BUILD = """cmake_minimum_required(VERSION 3.5)
project(box_robot)
find_package(catkin REQUIRED)
catkin_package()
"""
BOX = """<robot name="box"><link name="box"><inertial><mass value="1"/>
<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
<collision><geometry><box size="1 1 1"/></geometry></collision></link></robot>"""
LAUNCH = """<launch>
  <arg name="height" default="0.5"/>
  <include file="$(find gazebo_ros)/launch/empty_world.launch">
    <arg name="gui" value="false"/>
  </include>
  <param name="robot_description" textfile="$(find box_robot)/box.urdf"/>
  <node name="spawn" pkg="gazebo_ros" type="spawn_model"
        args="-urdf -param robot_description -model box -z $(arg height)"/>
</launch>"""
WORLD_ONLY = """<launch>
  <include file="$(find gazebo_ros)/launch/empty_world.launch">
    <arg name="gui" value="false"/>
  </include>
  <test test-name="clock" pkg="rostest" type="publishtest">
    <rosparam>
      topics:
        - {name: /clock, timeout: 100, negative: False}
    </rosparam>
  </test>
</launch>"""


class RobotCheckTest(unittest.TestCase):
    def setUp(self):
        holder = self.enterContext(tempfile.TemporaryDirectory(prefix='box robot '))
        self.folder = Path(holder, 'sources')
        self.package = self.folder / 'box_robot'
        for name, content in (
            ('package.xml', MANIFEST),
            ('CMakeLists.txt', BUILD),
            ('box.urdf', BOX),
            ('box.launch', LAUNCH),
            ('test/world.test', WORLD_ONLY),
        ):
            path = self.package / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(content, encoding='utf-8')

    def check(self, *arguments):
        done = ran_merged(sys.executable, str(CHECK), *map(str, arguments), timeout=PATIENCE)
        return done.returncode, done.stdout

    def test_robot_is_built_simulated_and_tested(self):
        results = self.folder / 'results'
        code, output = self.check(
            '--results', results, self.folder, 'box_robot/box.launch', 'height:=2'
        )
        self.assertEqual(code, 0, output)
        self.assertTrue(output.endswith('2 passed, 0 failed\n'), output)
        cases = [
            case.get('name')
            for report in results.rglob('rosunit-*.xml')
            for case in ElementTree.parse(report).iter('testcase')
        ]
        self.assertIn('test_a_model_is_simulated', cases)

    def test_robot_that_does_not_build_fails(self):
        (self.package / 'CMakeLists.txt').write_text(BUILD + 'message(FATAL_ERROR "no")\n')
        self.assertEqual(self.check(self.folder)[0], 1)

    def test_wrong_arguments_are_named(self):
        empty = self.folder / 'empty'
        empty.mkdir()
        for arguments, sentence in (
            ((empty,), f'there is no package.xml in {empty}'),
            ((self.folder, 'far.launch'), 'there is no launch file far.launch'),
            ((self.folder, 'x:=1'), 'x:=1 precedes the launch file that it belongs to'),
        ):
            code, output = self.check(*arguments)
            self.assertNotEqual(code, 0)
            self.assertIn(sentence, output)
