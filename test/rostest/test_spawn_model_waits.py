"""spawn_model waits for a simulator, and ends on Ctrl-C."""

import signal
import time
import unittest

import rospy
from gazebo_msgs.srv import DeleteModel, DeleteModelResponse, SpawnModel, SpawnModelResponse
from programs import find_program
from simulator import DEADLINE, wait_until
from terminal import Terminal


class SpawnModelTest(unittest.TestCase):
    """The test node offers the simulator's two services."""

    def setUp(self):
        self._requests = []

    def _start(self, *arguments):
        spawn_model = find_program('gazebo_ros', 'spawn_model')
        self._terminal = Terminal(spawn_model, '-urdf', '-model', 'box', *arguments)
        self.addCleanup(self._terminal.close)

    def _serve(self, name, service_class, answer):
        def handle(request):
            self._requests.append(request)
            return answer(request)

        self.addCleanup(rospy.Service(name, service_class, handle).shutdown)

    def _assert_shows(self, line):
        """Wait until the program has written the line."""
        wait_until(lambda: line in self._terminal.shown(), line)

    def _assert_ends(self, code):
        self.assertEqual(self._terminal.process.wait(DEADLINE), code)
        self.assertNotIn('Traceback', self._terminal.shown())

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
        self._terminal.process.send_signal(signal.SIGINT)
        self._assert_ends(130)

    def test_ctrl_c_ends_a_hanging_call(self):
        def hang(_):
            end = time.monotonic() + DEADLINE
            while self._terminal.process.poll() is None and time.monotonic() < end:
                time.sleep(0.05)
            return SpawnModelResponse(False, 'late')

        self._serve('/gazebo/spawn_urdf_model', SpawnModel, hang)
        self._start('-param', 'robot')
        self._assert_shows('Calling service /gazebo/spawn_urdf_model')
        self._terminal.process.send_signal(signal.SIGINT)
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
        self._terminal.process.send_signal(signal.SIGINT)
        self._assert_ends(0)
        self.assertEqual([request.model_name for request in self._requests], ['box', 'box'])
