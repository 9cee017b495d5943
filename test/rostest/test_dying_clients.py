"""Clients that crash, stop reading, send invalid data or call all at once do not affect others."""

import os
import signal
import struct
import subprocess
import time
from concurrent.futures import ThreadPoolExecutor

import rospy
from gazebo_msgs.msg import LinkStates, ModelStates
from gazebo_msgs.srv import (
    GetModelState,
    GetWorldProperties,
    GetWorldPropertiesRequest,
    SpawnModel,
    SpawnModelRequest,
)
from nav_msgs.msg import Odometry
from programs import find_program, kill_node
from raw_client import (
    answer,
    connection,
    deaf_subscriber,
    request_bytes,
    service_connection,
    unsent_bytes,
    vanish,
)
from rosgraph_msgs.msg import Clock
from server_process import OwnServerTest
from simulator import BOX, DEADLINE, pose, wait_until

MANY = 20
SPARE = 5  # files and threads of calls between nodes and master, open for a while
SIMULTANEOUS = 200
FULL = 2048  # [bytes] in the send queue: the subscriber's buffer is full
TOPICS = {
    '/clock': Clock,
    '/gazebo/model_states': ModelStates,
    '/gazebo/link_states': LinkStates,
    '/odom': Odometry,
}


def spawn_request(name, x):
    return request_bytes(SpawnModelRequest(name, BOX, '/', pose(x=x), ''))


class DyingClientsTest(OwnServerTest):
    def setUp(self):
        super().setUp()
        self.drive_neighbour()
        rospy.wait_for_service('/gazebo/set_parameters', DEADLINE)  # the last service
        self.files, self.threads = self.server.open_files(), self.server.threads()

    def _assert_server_is_unaffected(self):
        self.assert_no_more_than(self.files + SPARE, self.threads + SPARE)
        self.assert_neighbour_drives()

    @staticmethod
    def _deaf_subscribers():
        """Return subscribers that do not read, with full buffers."""
        deaf = [deaf_subscriber(topic, kind) for topic, kind in TOPICS.items()]
        wait_until(lambda: all(unsent_bytes(client) > FULL for client in deaf), 'full buffers')
        return deaf

    def test_clients_killed_during_a_call(self):
        # What is known is not tested again, for a client that has gone, on a busy machine.
        self.assertTrue(self.spawn('tested', BOX, pose(x=-5.0)).success)
        for i in range(MANY):
            request = spawn_request(f'box_{i}', 5.0 + 2.0 * i)
            vanish(connection())
            vanish(service_connection('spawn_urdf_model', SpawnModel))
            for length in (2, len(request) // 2, len(request)):
                client = service_connection('spawn_urdf_model', SpawnModel)
                client.sendall(request[:length])
                vanish(client)
        # Complete requests are executed, as in Gazebo.
        wanted = {f'box_{i}' for i in range(MANY)}
        wait_until(lambda: wanted <= set(self.world().model_names), 'all boxes')
        self._assert_server_is_unaffected()

    def test_processes_killed_during_a_spawn(self):
        for i in range(5):
            with subprocess.Popen(
                [
                    find_program('gazebo_ros', 'spawn_model'),
                    '-urdf',
                    '-param',
                    'robot_description',
                    '-model',
                    f'robot_{i}',
                    '-robot_namespace',
                    f'robot_{i}',
                    '-y',
                    str(3 * i + 3),
                    f'__name:=killed_{i}',
                ],
                stdout=subprocess.PIPE,
                stderr=subprocess.STDOUT,
                text=True,
            ) as client:
                while 'Calling service' not in client.stdout.readline():
                    self.assertIsNone(client.poll())
                time.sleep(0.01 * i)  # each one at a later phase
                kill_node(client, f'/killed_{i}')
        self.assert_neighbour_drives()
        self.assertTrue(self.spawn('another', BOX, pose(x=-8.0)).success)

    def test_connections_without_a_complete_header(self):
        request = spawn_request('never', 5.0)
        clients = [connection() for _ in range(MANY)]
        clients += [service_connection('spawn_urdf_model', SpawnModel) for _ in range(2 * MANY)]
        for client in clients[:MANY]:
            client.sendall(b'\x10')  # a quarter of a header's length
        for client in clients[-MANY:]:
            client.sendall(request[:-1])
        odometry = self.collect('/odom', Odometry)
        wait_until(lambda: len(odometry) > 50, 'half a second of driving')
        self.assert_neighbour_drives()
        self._connections.pop().unregister()
        for client in clients:
            client.close()
        self._assert_server_is_unaffected()
        self.assertNotIn('never', self.world().model_names)

    def test_malformed_requests(self):
        for request in (
            struct.pack('<I', 0xFFFFFFFF),  # four gigabytes are to follow
            struct.pack('<II', 4, 0xFFFFFFFF),  # four bytes, of which as many are a name
            struct.pack('<I', 3) + b'abc',
        ):
            for persistent in '01':
                client = service_connection('get_model_state', GetModelState, persistent=persistent)
                client.sendall(request)
                with client.makefile('rb') as file:
                    self.assertNotIn(b'\x01', file.read()[:1])  # the byte of success
                client.close()
        self._assert_server_is_unaffected()
        code, printed = self.server.end()
        self.assertEqual(code, 0)
        self.assertNotIn('Traceback', printed)

    def test_subscribers_that_do_not_read(self):
        deaf = self._deaf_subscribers()
        odometry = self.collect('/odom', Odometry)
        wait_until(lambda: len(odometry) > 50, 'half a second of driving')
        self.assert_neighbour_drives()
        self.assertTrue(self.delete('neighbour').success)
        self.drive_neighbour()
        for _ in range(3):
            for client in deaf:
                vanish(client)
            deaf = self._deaf_subscribers()
        for client in deaf:
            client.close()
        self._assert_server_is_unaffected()

    def test_ctrl_c_ends_a_server_whose_subscribers_do_not_read(self):
        deaf = self._deaf_subscribers()
        self.assertEqual(self.server.end()[0], 0)
        for client in deaf:
            client.close()

    def test_a_stopped_process(self):
        with subprocess.Popen(
            ['rostopic', 'echo', '/gazebo/link_states', '__name:=stopped'],
            stdout=subprocess.PIPE,
            text=True,
        ) as client:
            while 'name' not in client.stdout.readline():
                self.assertIsNone(client.poll())
            os.kill(client.pid, signal.SIGSTOP)
            self.assert_neighbour_drives()
            kill_node(client, '/stopped')
        self._assert_server_is_unaffected()

    def test_many_clients_calling_at_once(self):
        def ask(_):
            client = service_connection('get_world_properties', GetWorldProperties)
            client.sendall(request_bytes(GetWorldPropertiesRequest()))
            response = answer(client, GetWorldProperties)
            client.close()
            return response.success

        with ThreadPoolExecutor(SIMULTANEOUS) as pool:
            answers = list(pool.map(ask, range(SIMULTANEOUS), timeout=6 * DEADLINE))
        self.assertEqual(answers, [True] * SIMULTANEOUS)
        self._assert_server_is_unaffected()
