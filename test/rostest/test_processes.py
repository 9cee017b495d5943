#!/usr/bin/env python3
"""The programs as processes: start, waiting, exit, and output."""

import os
import re
import signal
import subprocess
import sys
import tempfile
import unittest

import rosgraph
import rospy
import rostest
from gazebo_msgs.srv import GetWorldProperties, SpawnModel
from network import services_of
from programs import end, find_program
from rosgraph_msgs.msg import Clock
from simulator import BOX, DEADLINE, hears, pose, proxy, topics_of, wait_until
from std_srvs.srv import Empty

NO_MASTER = 'No ROS master - start roscore to continue...'
ROS_LINE = re.compile(r'(\x1b\[\d+m)?\[(INFO|WARN)\] \[')
UNUSED_MASTER = 'http://localhost:1'  # nothing listens on port 1


class ProcessTest(unittest.TestCase):
    def setUp(self):
        self._started = []

    def tearDown(self):
        for process in self._started:
            end(process)
            process.stdout.close()
        wait_until(lambda: not self._registered(), 'the simulator being unregistered')

    def _start(self, program, *arguments, **environment):
        process = subprocess.Popen(
            [find_program('gazebo_ros', program), *arguments],
            env={**os.environ, **environment},
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            start_new_session=True,
        )
        self._started.append(process)
        return process

    def _server(self, *arguments):
        process = self._start('gzserver', *arguments)
        rospy.wait_for_service('/gazebo/spawn_urdf_model', DEADLINE)
        return process

    def _end(self, process, number=signal.SIGINT, code=0):
        """Send the signal; return the output of the process."""
        process.send_signal(number)
        printed, _ = process.communicate(timeout=DEADLINE)
        self.assertEqual(process.returncode, code)
        return printed

    @staticmethod
    def _registered():
        """Return whether a simulator is registered; unregister that of a killed one."""
        try:
            proxy_uri = rosgraph.Master('/test').lookupService('/gazebo/pause_physics')
        except rosgraph.MasterError:
            return False
        return bool(proxy_uri)

    def test_first_clock_is_one_step_and_sent_only_when_unpaused(self):
        server = self._server('-u')
        ticks = []
        subscriber = rospy.Subscriber('/clock', Clock, lambda m: ticks.append(m.clock.to_nsec()))
        wait_until(lambda: hears(subscriber), '/clock')
        for _ in range(10):
            self.assertEqual(proxy('get_world_properties', GetWorldProperties)().sim_time, 0.0)
        self.assertEqual(ticks, [])
        proxy('unpause_physics', Empty)()
        wait_until(lambda: len(ticks) > 3, 'ticks')
        subscriber.unregister()
        self.assertEqual(ticks[:3], [1_000_000, 2_000_000, 3_000_000])
        self._end(server)

    def test_ends_by_ctrl_c_and_sigterm_even_while_paused_with_ros_log_lines_only(self):
        for arguments, number in (
            ((), signal.SIGINT),
            (('-u',), signal.SIGINT),
            ((), signal.SIGTERM),
        ):
            server = self._server(*arguments)
            xml = rospy.get_param('robot_description')
            spawn = proxy('spawn_urdf_model', SpawnModel)
            self.assertTrue(spawn('rosbots', xml, '/', pose(), '').success)
            printed = self._end(server, number)
            lines = printed.splitlines()
            self.assertIn('Finished loading Gazebo ROS API Plugin.', lines[0])
            foreign = [line for line in lines if not ROS_LINE.match(line)]
            self.assertEqual(foreign, [])

    def test_ends_while_it_waits_for_a_master(self):
        server = self._start('gzserver', ROS_MASTER_URI=UNUSED_MASTER)
        self.assertIn(NO_MASTER, server.stdout.readline())
        self._end(server)

    def test_ends_after_the_requested_steps(self):
        server = self._start('gzserver', '--iters', '50')
        server.communicate(timeout=DEADLINE)
        self.assertEqual(server.returncode, 0)

    def test_verbose_shows_debug_messages(self):
        with tempfile.NamedTemporaryFile('w', suffix='.world') as world:
            world.write(
                '<sdf version="1.6"><world name="w">'
                '<audio><device>none</device></audio></world></sdf>'
            )
            world.flush()
            for options, shown in (((), False), (('--verbose',), True)):
                server = self._start('gzserver', *options, '--iters', '50', world.name)
                printed, _ = server.communicate(timeout=DEADLINE)
                self.assertEqual('[DEBUG] [' in printed, shown, printed)
                self.assertIn('Finished loading', printed)

    def test_second_server_does_not_start_while_one_runs(self):
        first = self._server()
        second = self._start('gzserver')
        printed, _ = second.communicate(timeout=DEADLINE)
        self.assertEqual(second.returncode, 1)
        (line,) = printed.splitlines()
        self.assertIn(f'the node /gazebo, process {first.pid} on ', line)
        self.assertIn('--replace', line)
        self._end(first)

    def test_second_server_takes_over_on_request_and_both_report_it(self):
        first = self._server()
        proxy('spawn_urdf_model', SpawnModel)('box', BOX, '/', pose(), '')
        second = self._start('gzserver', '--replace')
        printed, _ = first.communicate(timeout=DEADLINE)
        self.assertEqual(first.returncode, 0)
        self.assertRegex(
            printed, rf'this simulator ends: process {second.pid} on .* taken over the name'
        )
        wait_until(self._has_only_the_ground, 'a response of the second server')
        self.assertIn(f'replaces the node /gazebo, process {first.pid} on ', self._end(second))

    def test_server_starts_after_one_was_killed(self):
        first = self._server()
        first.kill()
        first.wait()
        second = self._start('gzserver')
        wait_until(self._has_only_the_ground, 'a response of the second server')
        self._end(second)

    @staticmethod
    def _has_only_the_ground():
        try:
            world = proxy('get_world_properties', GetWorldProperties)()
        except rospy.ServiceException:
            return False
        return world.model_names == ['ground_plane']

    def test_only_the_clock_is_published_without_the_ros_network(self):
        rospy.set_param('/gazebo/enable_ros_network', False)
        try:
            server = self._start('gzserver')
            ticks = []
            subscriber = rospy.Subscriber('/clock', Clock, ticks.append)
            wait_until(lambda: len(ticks) > 10, 'ticks')
            subscriber.unregister()
            self.assertEqual(topics_of(), {'/clock', '/rosout'})
            self.assertEqual(services_of(), {'get_loggers', 'set_logger_level'})
            self._end(server)
        finally:
            rospy.delete_param('/gazebo/enable_ros_network')

    def test_throttled_clock_has_its_frequency(self):
        rospy.set_param('/gazebo/pub_clock_frequency', 100)
        try:
            server = self._server('-u')
            ticks = []
            subscriber = rospy.Subscriber(
                '/clock', Clock, lambda m: ticks.append(m.clock.to_nsec())
            )
            wait_until(lambda: hears(subscriber), '/clock')
            proxy('unpause_physics', Empty)()
            wait_until(lambda: len(ticks) > 3, 'ticks')
            self.assertEqual(ticks[:3], [10_000_000, 20_000_000, 30_000_000])
            ticks.clear()
            proxy('reset_simulation', Empty)()
            wait_until(lambda: 10_000_000 in ticks, '/clock after time jumped back')
            subscriber.unregister()
            self._end(server)
        finally:
            rospy.delete_param('/gazebo/pub_clock_frequency')

    def test_window_without_a_display_prints_one_line_and_does_not_fail(self):
        for display in ('', ':97'):
            window = self._start('gzclient', '--verbose', DISPLAY=display)
            printed, _ = window.communicate(timeout=DEADLINE)
            self.assertEqual(window.returncode, 0)
            (line,) = printed.splitlines()
            self.assertIn('no display', line)

    def test_simulator_starts_while_spawn_model_waits(self):
        spawn = self._start(
            'spawn_model', '-urdf', '-param', 'robot_description', '-model', 'rosbots', '-z', '0.5'
        )
        while 'Waiting for service /gazebo/spawn_urdf_model' not in spawn.stdout.readline():
            self.assertIsNone(spawn.poll())
        server = self._server()
        printed, _ = spawn.communicate(timeout=DEADLINE)
        self.assertEqual(spawn.returncode, 0)
        self.assertIn('Spawn status: SpawnModel: Successfully spawned entity', printed)
        self._end(server)


if __name__ == '__main__':
    rospy.init_node('test_processes', disable_rostime=True)
    rostest.rosrun('rosbots_description', 'processes', ProcessTest, sys.argv)
