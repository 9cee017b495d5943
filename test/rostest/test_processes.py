"""The programs as processes: start, waiting, exit, and output."""

import re
import signal
import sys
import tempfile
import unittest
from pathlib import Path
from types import SimpleNamespace
from urllib.parse import urlsplit
from xmlrpc.server import SimpleXMLRPCServer

import rosgraph
import rospy
from gazebo_msgs.srv import GetWorldProperties, SpawnModel
from network import services_of
from rosgraph_msgs.msg import Clock
from server_process import ServerProcess
from simulator import BOX, hears, pose, proxy, topics_of, wait_until
from std_srvs.srv import Empty

sys.path.append(str(Path(__file__).resolve().parents[1]))
from support.serving import serving

NO_MASTER = 'No ROS master - start roscore to continue...'
ROS_LINE = re.compile(r'(\x1b\[\d+m)?\[(INFO|WARN)\] \[')
UNUSED_MASTER = 'http://localhost:1'  # nothing listens on port 1


class ProcessTest(unittest.TestCase):
    def setUp(self):
        self.addCleanup(wait_until, lambda: not services_of(), 'the simulator being unregistered')

    def start(self, *arguments, **options):
        """Start gzserver or another program, which ends with the test."""
        process = ServerProcess(*arguments, **options)
        self.addCleanup(process.__exit__)
        return process

    def assert_ends(self, process, number=signal.SIGINT):
        """Send a signal; return the output of the process."""
        code, printed = process.end(number)
        self.assertEqual(code, 0)
        return printed

    def clock(self):
        """Return a list of the times on /clock [ns], once they are heard."""
        ticks = []
        subscriber = rospy.Subscriber('/clock', Clock, lambda m: ticks.append(m.clock.to_nsec()))
        self.addCleanup(subscriber.unregister)
        wait_until(lambda: hears(subscriber), '/clock')
        return ticks

    def set_parameter(self, name, value):
        rospy.set_param(f'/gazebo/{name}', value)
        self.addCleanup(rospy.delete_param, f'/gazebo/{name}')

    def test_first_clock_is_one_step_and_sent_only_when_unpaused(self):
        server = self.start('-u').wait_ready()
        ticks = self.clock()
        for _ in range(10):
            self.assertEqual(server.world().sim_time, 0.0)
        self.assertEqual(ticks, [])
        proxy('unpause_physics', Empty)()
        wait_until(lambda: len(ticks) > 3, 'ticks')
        self.assertEqual(ticks[:3], [1_000_000, 2_000_000, 3_000_000])
        self.assert_ends(server)

    def test_ends_by_ctrl_c_and_sigterm_even_while_paused_with_ros_log_lines_only(self):
        for arguments, number in (
            ((), signal.SIGINT),
            (('-u',), signal.SIGINT),
            ((), signal.SIGTERM),
        ):
            server = self.start(*arguments).wait_ready()
            xml = rospy.get_param('robot_description')
            spawn = proxy('spawn_urdf_model', SpawnModel)
            self.assertTrue(spawn('rosbots', xml, '/', pose(), '').success)
            lines = self.assert_ends(server, number).splitlines()
            with self.assertRaises(rosgraph.MasterError):  # else it would keep the address
                rosgraph.Master(rospy.get_name()).lookupNode('/gazebo')
            self.assertIn('Finished loading Gazebo ROS API Plugin.', lines[0])
            self.assertEqual([line for line in lines if not ROS_LINE.match(line)], [])

    def test_ends_while_it_waits_for_a_master(self):
        server = self.start(master=UNUSED_MASTER)
        self.assertIn(NO_MASTER, server.process.stdout.readline())
        self.assert_ends(server)

    def test_ends_after_the_requested_steps(self):
        self.assertEqual(self.start('--iters', '50').wait()[0], 0)

    def test_verbose_shows_debug_messages(self):
        with tempfile.NamedTemporaryFile('w', suffix='.world') as world:
            world.write(
                '<sdf version="1.6"><world name="w">'
                '<audio><device>none</device></audio></world></sdf>'
            )
            world.flush()
            for options, shown in (((), False), (('--verbose',), True)):
                _, printed = self.start(*options, '--iters', '50', world.name).wait()
                self.assertEqual('[DEBUG] [' in printed, shown, printed)
                self.assertIn('Finished loading', printed)

    def test_second_server_does_not_start_while_one_runs(self):
        first = self.start().wait_ready()
        code, printed = self.start().wait()
        self.assertEqual(code, 1)
        (line,) = printed.splitlines()
        self.assertIn(f'the node /gazebo, process {first.process.pid} on ', line)
        self.assertIn('--replace', line)
        self.assert_ends(first)

    def test_second_server_takes_over_on_request_and_both_report_it(self):
        first = self.start().wait_ready()
        proxy('spawn_urdf_model', SpawnModel)('box', BOX, '/', pose(), '')
        second = self.start('--replace')
        code, printed = first.wait()
        self.assertEqual(code, 0)
        self.assertRegex(
            printed, rf'this simulator ends: process {second.process.pid} on .* taken over the name'
        )
        wait_until(self._has_only_the_ground, 'a response of the second server')
        self.assertIn(
            f'replaces the node /gazebo, process {first.process.pid} on ', self.assert_ends(second)
        )

    def test_server_starts_after_one_was_killed_and_ends_nobody_at_its_address(self):
        first = self.start().wait_ready()
        port = urlsplit(rosgraph.Master(rospy.get_name()).lookupNode('/gazebo')).port
        first.process.kill()
        first.process.wait()
        asked = []
        stranger = SimpleXMLRPCServer(('', port), logRequests=False)
        stranger.register_instance(SimpleNamespace(_dispatch=lambda call, _: asked.append(call)))
        with serving(stranger):
            second = self.start().wait_ready()
            wait_until(self._has_only_the_ground, 'a response of the second server')
            self.assert_ends(second)
        self.assertIn('getPid', asked)
        self.assertNotIn('shutdown', asked)

    @staticmethod
    def _has_only_the_ground():
        try:
            world = proxy('get_world_properties', GetWorldProperties)()
        except rospy.ServiceException:
            return False
        return world.model_names == ['ground_plane']

    def test_only_the_clock_is_published_without_the_ros_network(self):
        self.set_parameter('enable_ros_network', False)
        server = self.start()
        ticks = self.clock()
        wait_until(lambda: len(ticks) > 10, 'ticks')
        self.assertEqual(topics_of(), {'/clock', '/rosout'})
        self.assertEqual(services_of(), {'get_loggers', 'set_logger_level'})
        self.assert_ends(server)

    def test_throttled_clock_has_its_frequency(self):
        self.set_parameter('pub_clock_frequency', 100)
        server = self.start('-u').wait_ready()
        ticks = self.clock()
        proxy('unpause_physics', Empty)()
        wait_until(lambda: len(ticks) > 3, 'ticks')
        self.assertEqual(ticks[:3], [10_000_000, 20_000_000, 30_000_000])
        ticks.clear()
        proxy('reset_simulation', Empty)()
        wait_until(lambda: 10_000_000 in ticks, '/clock after time jumped back')
        self.assert_ends(server)

    def test_window_without_a_display_prints_one_line_and_does_not_fail(self):
        for display in ('', ':97'):
            code, printed = self.start('--verbose', program='gzclient', DISPLAY=display).wait()
            self.assertEqual(code, 0)
            (line,) = printed.splitlines()
            self.assertIn('no display', line)

    def test_simulator_starts_while_spawn_model_waits(self):
        options = ['-urdf', '-param', 'robot_description', '-model', 'rosbots', '-z', '0.5']
        spawn = self.start(*options, program='spawn_model')
        while 'Waiting for service /gazebo/spawn_urdf_model' not in spawn.process.stdout.readline():
            self.assertIsNone(spawn.process.poll())
        server = self.start().wait_ready()
        code, printed = spawn.wait()
        self.assertEqual(code, 0)
        self.assertIn('Spawn status: SpawnModel: Successfully spawned entity', printed)
        self.assert_ends(server)
