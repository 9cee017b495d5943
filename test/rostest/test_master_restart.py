"""The simulator survives the end of the ROS master, and registers with the next one."""

import subprocess
import sys
import unittest
from pathlib import Path

import rosgraph
import rospy
from dynamic_reconfigure.msg import Config, DoubleParameter
from dynamic_reconfigure.srv import Reconfigure, ReconfigureRequest
from gazebo_msgs.srv import (
    DeleteModel,
    DeleteModelRequest,
    GetModelState,
    GetWorldProperties,
    GetWorldPropertiesRequest,
    SpawnModel,
    SpawnModelRequest,
)
from programs import ran
from raw_client import answer, request_bytes, service_connection
from server_process import MasterProcess, ServerProcess
from simulator import BOX, LAST_TOPICS, page_address, pose, wait_until

sys.path.append(str(Path(__file__).resolve().parents[1]))
from support.browser import Browser

LATE = {'/late/odom', '/late/joint_states'}


class MasterRestartTest(unittest.TestCase):
    def setUp(self):
        self.master = MasterProcess()
        address = self.master.__enter__()
        self.addCleanup(self.master.__exit__)
        self.server = ServerProcess(master=address)
        self.addCleanup(self.server.__exit__)
        self.graph = rosgraph.Master('/test', address)
        self.server.wait_ready()
        self.server.spawn('rosbots', rospy.get_param('robot_description'))
        wait_until(lambda: self._of_server()[0] >= LAST_TOPICS, 'dynamic_reconfigure')

    def _run(self, *command):
        """Run a ROS program with the server's master; return what it prints."""
        return ran(*command, env=self.server.environment, check=True).stdout

    def _of_server(self):
        """Return the server's registrations: published topics, subscribed topics, services."""
        return [
            {name for name, nodes in entries if '/gazebo' in nodes}
            for entries in self.graph.getSystemState()
        ]

    def _client(self, service, service_class):
        """Return a function that calls the service on a persistent connection."""
        client = service_connection(service, service_class, self.server.master, persistent='1')
        self.addCleanup(client.close)

        def call(request):
            client.sendall(request_bytes(request))
            return answer(client, service_class)

        return call

    def _time_query(self):
        """Return a function that returns the simulated time [s]."""
        ask = self._client('get_world_properties', GetWorldProperties)
        return lambda: ask(GetWorldPropertiesRequest()).sim_time

    def _spawn_late(self):
        """Kill the master, and spawn a robot with its own topics."""
        spawn = self._client('spawn_urdf_model', SpawnModel)
        self.master.kill()
        response = spawn(
            SpawnModelRequest(
                'late', rospy.get_param('robot_description'), '/late', pose(y=5.0), ''
            )
        )
        self.assertTrue(response.success, response.status_message)

    def _window(self):
        """Open the window in the browser, and look; return the browser."""
        window = ServerProcess('--port', '0', program='gzweb', master=self.server.master)
        self.addCleanup(window.__exit__)
        browser = Browser(page_address(window.process.stdout.readline))
        self.addCleanup(browser.__exit__)
        wait_until(self._is_shown, 'the window to look')
        return browser

    def _is_shown(self):
        return any(
            topic == '/gazebo/view/motion' and '/gzweb' in nodes
            for topic, nodes in self.graph.getSystemState()[1]
        )

    def test_simulator_and_window_register_with_a_new_master(self):
        before, now = self._of_server(), self._time_query()
        browser = self._window()
        for topic, where in (('/odom', 0), ('/part2_cmr/cmd_vel', 1)):
            self.assertIn(topic, before[where])
        step = self.graph.getParam('/gazebo/time_step')
        self._assert_it_needs_no_answers(now)
        self.master.kill()
        gone = now()
        wait_until(lambda: now() > gone + 0.2, 'advance of time without a master')
        self.master.start()
        wait_until(lambda: self._of_server() == before, 'the same topics and services')
        wait_until(lambda: self.graph.hasParam('/use_sim_time'), 'the parameters')
        self.assertTrue(self.graph.getParam('/use_sim_time'))
        wait_until(lambda: self.graph.hasParam('/gazebo/time_step'), 'the parameters')
        self.assertEqual(self.graph.getParam('/gazebo/time_step'), step)
        wait_until(self._is_shown, 'the window among the new registrations')
        browser.wait_until(lambda: browser.control('Pause'))
        browser.click('Pause')  # the buttons find the services again
        browser.wait_until(lambda: browser.control('Play'))
        browser.click('Play')
        browser.wait_until(lambda: browser.control('Pause'))
        self._assert_it_works()

    def _assert_it_needs_no_answers(self, now):
        delete = self._client('delete_model', DeleteModel)
        with self.master.silenced():
            self.assertFalse(delete(DeleteModelRequest('nobody')).success)  # which is logged
            begin = now()
            wait_until(lambda: now() > begin + 0.2, 'advance of time')

    def test_robot_spawned_without_a_master_is_registered_with_the_next(self):
        topics_out, topics_in, services = self._of_server()
        self._spawn_late()
        self.master.start()
        wait_until(
            lambda: self._of_server() == [topics_out | LATE, topics_in, services],
            'the topics of both robots, and all services',
        )
        self._assert_it_works()

    def test_settings_changed_without_a_master_are_on_the_next(self):
        change = self._client('set_parameters', Reconfigure)
        self.master.kill()
        gravity = DoubleParameter('gravity_z', -3.5)
        updated = change(ReconfigureRequest(Config(doubles=[gravity]))).config
        self.assertIn(gravity, updated.doubles)
        self.master.start()
        wait_until(lambda: self.graph.hasParam('/gazebo/gravity_z'), 'the parameters')
        self.assertEqual(self.graph.getParam('/gazebo/gravity_z'), -3.5)
        self.assertNotIn('Traceback', self.server.end()[1])

    def _assert_it_works(self):
        self.assertIn('rosbots', self.server.world().model_names)
        drive = ['rostopic', 'pub', '-r', '10', '/part2_cmr/cmd_vel', 'geometry_msgs/Twist']
        with subprocess.Popen(
            [*drive, '{linear: {x: 0.3}}'],
            env=self.server.environment,
            stdout=subprocess.DEVNULL,
        ) as driving:
            try:
                wait_until(lambda: self._x() > 0.1, 'a drive')
            finally:
                driving.terminate()
        self.assertIn('odom', self._run('rostopic', 'echo', '-n1', '/odom'))
        self.server.spawn('box', BOX)
        code, printed = self.server.end()
        self.assertEqual(code, 0)
        self.assertNotIn('Traceback', printed)
        self.assertIn('registered with a new ROS master', printed)
        self.assertEqual(self._of_server(), [set(), set(), set()])

    def _x(self):
        return self.server.call('get_model_state', GetModelState, 'rosbots', '').pose.position.x

    def test_ctrl_c_ends_the_server_without_a_master(self):
        self.master.kill()
        self._assert_it_ends()

    def test_ctrl_c_ends_the_server_with_unregistered_topics(self):
        self._spawn_late()
        self._assert_it_ends()

    def _assert_it_ends(self):
        code, printed = self.server.end()
        self.assertEqual(code, 0, printed)
        self.assertNotIn('Traceback', printed)
