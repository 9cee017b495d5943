"""Several simulators on one machine do not disturb each other."""

import contextlib
import os
import tempfile
import unittest
from pathlib import Path

import rospy
from gazebo_msgs.srv import GetWorldProperties, SpawnModel
from server_process import MasterProcess, ServerProcess
from simulator import BOX, pose, proxy, wait_until
from std_srvs.srv import Empty

GROUND = ['ground_plane']
EIGHT = 8
SHAPES = ['ground_plane', 'box', 'sphere', 'cylinder']


def models(server):
    return proxy('get_world_properties', GetWorldProperties, f'/{server.name}')().model_names


def time_of(server):
    return proxy('get_world_properties', GetWorldProperties, f'/{server.name}')().sim_time


def is_running(pid):
    """Tell whether a process runs; a zombie does not."""
    try:
        return Path(f'/proc/{pid}/stat').read_text().rpartition(')')[2].split()[0] != 'Z'
    except OSError:
        return False


class NeighboursTest(unittest.TestCase):
    def test_two_names_on_one_master(self):
        with (
            ServerProcess('__name:=one') as one,
            ServerProcess('worlds/shapes.world', '__name:=two') as two,
        ):
            one.wait_ready()
            two.wait_ready()
            self.assertEqual((models(one), models(two)), (GROUND, SHAPES))
            spawn = proxy('spawn_urdf_model', SpawnModel, '/one')
            self.assertTrue(spawn('crate', BOX, '/', pose(), '').success)
            proxy('pause_physics', Empty, '/one')()
            self.assertEqual((models(one), models(two)), ([*GROUND, 'crate'], SHAPES))
            stopped, running = time_of(one), time_of(two)
            wait_until(lambda: time_of(two) > running + 0.1, 'advance of the other server')
            self.assertEqual(time_of(one), stopped)
            self.assertEqual(one.end()[0], 0)
            running = time_of(two)
            wait_until(lambda: time_of(two) > running + 0.1, 'advance after the end of the first')
            self.assertEqual(models(two), SHAPES)
            self.assertEqual(two.end()[0], 0)

    def test_one_name_on_two_masters_with_the_same_temporary_directory(self):
        xml = rospy.get_param('robot_description')
        with (
            tempfile.TemporaryDirectory() as folder,
            MasterProcess() as address,
            ServerProcess(TMPDIR=folder) as here,
            ServerProcess(TMPDIR=folder, master=address) as there,
        ):
            here.wait_ready()
            there.wait_ready()
            spawn = proxy('spawn_urdf_model', SpawnModel)
            self.assertTrue(spawn('rosbots', xml, '/', pose(), '').success)
            self.assertEqual(there.world().model_names, GROUND)
            there.spawn('rosbots', xml)
            self.assertEqual(here.end()[0], 0)
            # meshes are read from files again
            there.call('reset_simulation', Empty)
            self.assertEqual(there.world().model_names, [*GROUND, 'rosbots'])
            self.assertEqual(there.end()[0], 0)
            self.assertEqual(os.listdir(folder), [])

    def test_eight_as_learning_scripts_start_them(self):
        # Own masters, GAZEBO_MASTER_URI of their own, the same user, home and temporary folder.
        xml = rospy.get_param('robot_description')
        with tempfile.TemporaryDirectory() as folder, contextlib.ExitStack() as stack:
            shared = {'TMPDIR': folder, 'HOME': folder, 'ROS_HOME': f'{folder}/.ros'}
            servers = []
            for number in range(EIGHT):
                address = stack.enter_context(MasterProcess())
                servers.append(
                    stack.enter_context(
                        ServerProcess(
                            master=address,
                            GAZEBO_MASTER_URI=f'http://localhost:{11400 + number}',
                            **shared,
                        )
                    )
                )
            for server in servers:
                server.wait_ready()
            for number, server in enumerate(servers):
                server.spawn(f'robot_{number}', xml)
            killed, *others = servers
            families = [int(pid) for pid in killed.children()]
            self.assertGreater(len(families), 0)
            killed.process.kill()
            killed.process.wait()
            wait_until(lambda: not any(map(is_running, families)), 'the end of its processes')
            for number, server in enumerate(others, 1):
                self.assertEqual(server.world().model_names, [*GROUND, f'robot_{number}'])
                before = server.world().sim_time
                wait_until(
                    lambda: server.world().sim_time > before,  # noqa: B023 (called here)
                    'advance of the others',
                )
                self.assertEqual(server.end()[0], 0)
            left = [name for name in os.listdir(folder) if not name.startswith('.')]
            self.assertEqual(left, [])
