#!/usr/bin/env python3
"""spawn_model waits for a simulator, and ends on Ctrl-C."""

import os
import select
import signal
import subprocess
import sys
import time
import unittest

import rospy
import rostest
from gazebo_msgs.srv import DeleteModel, DeleteModelResponse, SpawnModel, SpawnModelResponse
from programs import end, find_program
from simulator import DEADLINE


class SpawnModelTest(unittest.TestCase):
    """The test node offers the simulator's two services."""

    def setUp(self):
        self._process = None
        self._output = ''
        self._requests = []
        self._services = []

    def tearDown(self):
        end(self._process)
        self._process.stdout.close()
        for service in self._services:
            service.shutdown()

    def _start(self, *arguments):
        self._process = subprocess.Popen(
            [find_program('gazebo_ros', 'spawn_model'), '-urdf', '-model', 'box', *arguments],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
        )

    def _serve(self, name, service_class, answer):
        def handle(request):
            self._requests.append(request)
            return answer(request)

        self._services.append(rospy.Service(name, service_class, handle))

    def _assert_shows(self, line):
        """Wait until the program has written the line."""
        end = time.monotonic() + DEADLINE
        while line not in self._output and time.monotonic() < end:
            if select.select([self._process.stdout], [], [], 0.1)[0]:
                piece = os.read(self._process.stdout.fileno(), 4096)
                if not piece:
                    break
                self._output += piece.decode()
        self.assertIn(line, self._output)

    def _assert_ends(self, code):
        self.assertEqual(self._process.wait(DEADLINE), code)
        self._assert_shows('')
        self.assertNotIn('Traceback', self._output)

    def test_waits_for_the_simulator_and_then_spawns(self):
        self._start('-param', 'robot', '-z', '0.5', '-x', '-1e-1')
        self._assert_shows('Loading model XML from ros parameter robot')
        self._assert_shows('Waiting for service /gazebo/spawn_urdf_model')
        self._serve(
            '/gazebo/spawn_urdf_model',
            SpawnModel,
            lambda request: SpawnModelResponse(True, 'SpawnModel: Successfully spawned entity'),
        )
        self._assert_shows('Calling service /gazebo/spawn_urdf_model')
        self._assert_shows('Spawn status: SpawnModel: Successfully spawned entity')
        self._assert_ends(0)
        (request,) = self._requests
        self.assertEqual((request.model_name, request.robot_namespace), ('box', '/'))
        position = request.initial_pose.position
        self.assertEqual((position.x, position.z), (-0.1, 0.5))
        self.assertEqual(request.model_xml, "<robot name='box'><link name='body'/></robot>")

    def test_ctrl_c_ends_the_wait(self):
        self._start('-param', 'robot')
        self._assert_shows('Waiting for service /gazebo/spawn_urdf_model')
        self._process.send_signal(signal.SIGINT)
        self._assert_ends(130)

    def test_ctrl_c_ends_a_hanging_call(self):
        def hang(_):
            end = time.monotonic() + DEADLINE
            while self._process.poll() is None and time.monotonic() < end:
                time.sleep(0.05)
            return SpawnModelResponse(False, 'late')

        self._serve('/gazebo/spawn_urdf_model', SpawnModel, hang)
        self._start('-param', 'robot')
        self._assert_shows('Calling service /gazebo/spawn_urdf_model')
        self._process.send_signal(signal.SIGINT)
        self._assert_ends(130)

    def test_rejection_is_shown_and_exits_with_1(self):
        self._serve(
            '/gazebo/spawn_urdf_model',
            SpawnModel,
            lambda request: SpawnModelResponse(
                False, 'SpawnModel: Failure - entity already exists.'
            ),
        )
        self._start('-param', 'robot')
        self._assert_shows('Spawn status: SpawnModel: Failure - entity already exists.')
        self._assert_shows('Spawn service failed. Exiting.')
        self._assert_ends(1)

    def test_missing_parameter_is_named_and_exits_with_1(self):
        self._start('-param', 'no_such_param')
        self._assert_shows('Error: param does not exist or is empty: /no_such_param')
        self._assert_ends(1)

    def test_bound_model_is_deleted_at_exit(self):
        self._serve(
            '/gazebo/spawn_urdf_model',
            SpawnModel,
            lambda request: SpawnModelResponse(True, 'spawned'),
        )
        self._serve(
            '/gazebo/delete_model',
            DeleteModel,
            lambda request: DeleteModelResponse(True, 'deleted'),
        )
        self._start('-param', 'robot', '-b')
        self._assert_shows('Waiting for shutdown to delete model box')
        self._process.send_signal(signal.SIGINT)
        self._assert_ends(0)
        self.assertEqual([request.model_name for request in self._requests], ['box', 'box'])


if __name__ == '__main__':
    rospy.init_node('test_spawn_model')
    rostest.rosrun('rosbots_description', 'spawn_model', SpawnModelTest, sys.argv)
