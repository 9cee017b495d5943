"""A model that crashes the engine is rejected with a message; other clients are not affected."""

import signal
from collections.abc import Mapping
from concurrent.futures import ThreadPoolExecutor

from crashing_server import HANGING
from gazebo_msgs.srv import SpawnModel, SpawnModelRequest
from raw_client import request_bytes, service_connection, vanish
from server_process import OwnServerTest
from simulator import BOX, DEADLINE, pose, wait_until
from support.crashing import CRASHING

TIMES = 10
SPARE = 5  # files and threads of calls between nodes and master
SENTENCE = (
    "SpawnModel: Failure - model 'bad' is rejected: tested in a process of its own, "
    'it crashed the physics engine (SIGSEGV)'
)
# More surfaces on one body than PyBullet can report.
ROUGH = BOX.replace(
    '</robot>',
    ''.join(
        f"""<link name="l{i}"><collision><geometry><box size="1 1 1"/></geometry></collision></link>
        <joint name="j{i}" type="fixed"><parent link="body"/><child link="l{i}"/></joint>
        <gazebo reference="l{i}"><mu1>{i / 200}</mu1></gazebo>"""
        for i in range(200)
    )
    + '</robot>',
)


class CrashSandboxTest(OwnServerTest):
    program: Mapping[str, str] = {'package': 'rosbots_description', 'program': 'crashing_server.py'}

    def test_crash_in_the_sandbox_does_not_affect_other_robots(self):
        self.drive_neighbour()
        crashing = BOX.replace('"body"', f'"{CRASHING}"')
        self.assertIn(SENTENCE, self.spawn('bad', crashing).status_message)
        files, threads = self.server.open_files(), self.server.threads()
        for _ in range(TIMES):
            response = self.spawn('bad', crashing, pose(x=5.0))
            self.assertFalse(response.success)
            self.assertIn(SENTENCE, response.status_message)
        self.assertEqual(self.server.sandbox_runs(), [])
        self.assert_no_more_than(files + SPARE, threads + SPARE)
        self.assert_neighbour_drives()
        self.assertTrue(self.spawn('good', BOX, pose(x=5.0)).success)
        self.assertEqual(self.server.end()[0], 0)

    def test_spawn_in_progress_is_answered_at_shutdown(self):
        for number in (signal.SIGTERM, signal.SIGINT):
            with self.subTest(number), ThreadPoolExecutor() as pool:
                answer = pool.submit(self.spawn, 'slow', BOX.replace('"body"', f'"{HANGING}"'))
                wait_until(self.server.sandbox_runs, 'the sandbox run')
                self.server.process.send_signal(number)
                response = answer.result(DEADLINE)
                self.assertFalse(response.success)
                self.assertEqual(
                    response.status_message, 'SpawnModel: Failure - the simulator is shutting down'
                )
                self.assertEqual(self.server.wait()[0], 0)
            self.doCleanups()
            self.setUp()

    def test_hanging_model_delays_nobody_and_its_test_ends_with_the_client(self):
        slow = BOX.replace('"body"', f'"{HANGING}"')
        clients = [service_connection('spawn_urdf_model', SpawnModel) for _ in range(3)]
        for i, client in enumerate(clients):
            heavier = slow.replace('value="1"', f'value="{i + 1}"')
            client.sendall(request_bytes(SpawnModelRequest(f'slow{i}', heavier, '/', pose(), '')))
        wait_until(lambda: len(self.server.sandbox_runs()) == len(clients), 'all sandbox runs')
        began = self.server.sandbox_runs()
        self.assertTrue(self.spawn('box', BOX, pose(x=5.0)).success)
        # it was answered before any of the others
        self.assertEqual(self.server.sandbox_runs(), began)
        for client in clients:
            vanish(client)
        wait_until(lambda: not self.server.sandbox_runs(), 'the end of the runs')
        self.assertNotIn('slow0', self.world().model_names)

    def test_model_with_more_surfaces_than_the_engine_reports_is_rejected(self):
        self.drive_neighbour()
        self.assertFalse(self.spawn('rough', ROUGH, pose(x=5.0)).success)
        self.assert_neighbour_drives()
