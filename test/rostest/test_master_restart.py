#!/usr/bin/env python3
"""A ROS master that dies takes nothing along: the next one finds the simulator in its graph."""

import subprocess
import sys
import time
import unittest

import rosgraph
import rospy
import rostest
from gazebo_msgs.srv import GetWorldProperties, GetWorldPropertiesRequest
from raw_client import answer, request_bytes, service_connection
from server_process import MasterProcess, ServerProcess
from simulator import BOX, DEADLINE, wait_until

CTRL_C_LIMIT = 2.0  # [s] promised


class MasterRestartTest(unittest.TestCase):

    def setUp(self):
        self.master = MasterProcess()
        address = self.master.__enter__()
        self.addCleanup(self.master.__exit__)
        self.server = ServerProcess(master=address)
        self.addCleanup(self.server.__exit__)
        self.graph = rosgraph.Master('/test', address)
        self.server.wait_ready()
        self._spawn('rosbots', rospy.get_param('robot_description'))
        wait_until(lambda: self._has('/gazebo/set_parameters'), 'dynamic_reconfigure')

    def _spawn(self, name, xml):
        with ServerProcess('-urdf', '-stdin', '-model', name, program='spawn_model',
                           master=self.server.master) as client:
            printed, _ = client.process.communicate(xml, timeout=2 * DEADLINE)
            self.assertEqual(client.process.returncode, 0, printed)

    def _run(self, *command):
        """Run a ROS program with the server's master; return what it prints."""
        return subprocess.run(command, env=self.server.environment, capture_output=True, text=True,
                              timeout=DEADLINE, check=True).stdout

    def _has(self, service):
        return any(service == name for name, _ in self.graph.getSystemState()[2])

    def _of_server(self):
        """Return what the master knows of the server: topics out, topics in, services."""
        return [{name for name, nodes in entries if '/gazebo' in nodes}
                for entries in self.graph.getSystemState()]

    def _asked(self):
        """Return a function that asks the server for the time on a connection that lasts."""
        client = service_connection('get_world_properties', GetWorldProperties,
                                    self.server.master, persistent='1')
        self.addCleanup(client.close)

        def now():
            client.sendall(request_bytes(GetWorldPropertiesRequest()))
            return answer(client, GetWorldProperties).sim_time

        return now

    def test_a_new_master_knows_the_simulator_again(self):
        before, now = self._of_server(), self._asked()
        for topic, where in (('/odom', 0), ('/part2_cmr/cmd_vel', 1)):
            self.assertIn(topic, before[where])
        step = self.graph.getParam('/gazebo/time_step')
        self.master.kill()
        gone = now()
        wait_until(lambda: now() > gone + 0.2, 'time going on without a master')
        self.master.start()
        wait_until(lambda: self._of_server() == before, 'the same topics and services')
        wait_until(lambda: self.graph.hasParam('/use_sim_time'), 'the parameters')
        self.assertTrue(self.graph.getParam('/use_sim_time'))
        wait_until(lambda: self.graph.hasParam('/gazebo/time_step'), 'the parameters')
        self.assertEqual(self.graph.getParam('/gazebo/time_step'), step)
        self._assert_it_works()

    def _assert_it_works(self):
        self.assertIn('rosbots', self.server.world()['model_names'])
        self._run('rostopic', 'pub', '-1', '/part2_cmr/cmd_vel', 'geometry_msgs/Twist',
                  '{linear: {x: 0.3}}')
        wait_until(lambda: self._x() > 0.1, 'a drive')
        self.assertIn('odom', self._run('rostopic', 'echo', '-n1', '/odom'))
        self._spawn('box', BOX)
        code, printed = self.server.end()
        self.assertEqual(code, 0)
        self.assertNotIn('Traceback', printed)
        self.assertIn('registered with a new ROS master', printed)
        self.assertEqual(self._of_server(), [set(), set(), set()])

    def _x(self):
        return self.server.call('get_model_state', 'rosbots', '')['pose']['position']['x']

    def test_ctrl_c_ends_the_server_while_there_is_no_master(self):
        self.master.kill()
        begin = time.monotonic()
        code, printed = self.server.end()
        self.assertEqual(code, 0, printed)
        self.assertLess(time.monotonic() - begin, CTRL_C_LIMIT)


if __name__ == '__main__':
    rospy.init_node('test_master_restart', disable_rostime=True)
    rostest.rosrun('rosbots_description', 'master_restart', MasterRestartTest, sys.argv)
