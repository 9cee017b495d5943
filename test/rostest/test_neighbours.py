#!/usr/bin/env python3
"""Several simulators on one machine do not disturb each other."""

import os
import sys
import tempfile
import unittest

import rospy
import rostest
from gazebo_msgs.srv import GetWorldProperties, SpawnModel
from server_process import MasterProcess, ServerProcess
from simulator import BOX, DEADLINE, pose, wait_until
from std_srvs.srv import Empty

GROUND = ['ground_plane']
SHAPES = ['ground_plane', 'box', 'sphere', 'cylinder']


def service(server, name, service_type):
    rospy.wait_for_service(f'/{server.name}/{name}', DEADLINE)
    return rospy.ServiceProxy(f'/{server.name}/{name}', service_type)


def models(server):
    return service(server, 'get_world_properties', GetWorldProperties)().model_names


def time_of(server):
    return service(server, 'get_world_properties', GetWorldProperties)().sim_time


class NeighboursTest(unittest.TestCase):

    def test_two_names_on_one_master(self):
        with ServerProcess('__name:=one') as one, \
                ServerProcess('worlds/shapes.world', '__name:=two') as two:
            one.wait_ready()
            two.wait_ready()
            self.assertEqual((models(one), models(two)), (GROUND, SHAPES))
            spawn = service(one, 'spawn_urdf_model', SpawnModel)
            self.assertTrue(spawn('crate', BOX, '/', pose(), '').success)
            service(one, 'pause_physics', Empty)()
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
        with tempfile.TemporaryDirectory() as folder, MasterProcess() as address, \
                ServerProcess(TMPDIR=folder) as here, \
                ServerProcess(TMPDIR=folder, master=address) as there:
            here.wait_ready()
            there.wait_ready()
            spawn = service(here, 'spawn_urdf_model', SpawnModel)
            self.assertTrue(spawn('rosbots', xml, '/', pose(), '').success)
            self.assertEqual(there.world()['model_names'], GROUND)
            with ServerProcess('-urdf', '-stdin', '-model', 'rosbots', program='spawn_model',
                               master=address) as client:
                printed, _ = client.process.communicate(xml, timeout=DEADLINE)
            self.assertEqual(client.process.returncode, 0, printed)
            self.assertEqual(here.end()[0], 0)
            # meshes are read from files again
            there.call('reset_simulation')
            self.assertEqual(there.world()['model_names'], [*GROUND, 'rosbots'])
            self.assertEqual(there.end()[0], 0)
            self.assertEqual(os.listdir(folder), [])


if __name__ == '__main__':
    rospy.init_node('test_neighbours', disable_rostime=True)
    rostest.rosrun('rosbots_description', 'neighbours', NeighboursTest, sys.argv)
