"""World files of users: valid, partly valid, and missing ones."""

import tempfile
import unittest
from functools import partial
from pathlib import Path

import rospy
from gazebo_msgs.srv import (
    GetModelState,
    GetPhysicsProperties,
    GetWorldProperties,
    SpawnModel,
)
from server_process import ServerProcess
from simulator import pose, proxy, wait_until

NAME = '__name:=other'  # beside the server that the launch file has started
WORLD = """<sdf version="1.6"><world name="moon">
  <physics type="ode">
    <max_step_size>0.002</max_step_size><real_time_update_rate>500</real_time_update_rate>
  </physics>
  <gravity>0 0 -1.62</gravity>
  <include><uri>model://ground_plane</uri></include>
  <include><uri>model://nowhere</uri></include>
  <model name="wall"><static>true</static><pose>3 0 0.5 0 0 0</pose><link name="link">
    <collision name="c"><geometry><box><size>0.2 4 1</size></box></geometry></collision>
  </link></model>
  <model name="weightless"><link name="link"><inertial><mass>-1</mass></inertial></link></model>
  <plugin name="weather" filename="libweather.so"/>
</world></sdf>"""


other = partial(proxy, node='/other')


class WorldFilesTest(unittest.TestCase):
    def setUp(self):
        folder = self.enterContext(tempfile.TemporaryDirectory())
        self.world = Path(folder, 'moon.world')
        self.world.write_text(WORLD, encoding='utf-8')

    def test_robot_is_spawned_in_the_users_world(self):
        with ServerProcess(str(self.world), NAME) as server:
            server.wait_ready()
            physics = other('get_physics_properties', GetPhysicsProperties)()
            self.assertEqual(
                (physics.time_step, physics.max_update_rate, physics.gravity.z),
                (0.002, 500.0, -1.62),
            )
            answer = other('spawn_urdf_model', SpawnModel)(
                'rosbots', rospy.get_param('robot_description'), '/', pose(), ''
            )
            self.assertTrue(answer.success, answer.status_message)
            self.assertEqual(
                other('get_world_properties', GetWorldProperties)().model_names,
                ['ground_plane', 'wall', 'rosbots'],
            )
            state = other('get_model_state', GetModelState)
            wait_until(lambda: state('rosbots', '').pose.position.z < 0.4, 'fall of the robot')
            code, printed = server.end()
        self.assertEqual(code, 0)
        for fault in (
            f"{self.world}, line 7: 'model://nowhere'",
            f'{self.world}, line 11: link',
            "world plugin 'weather' (libweather.so, line 12) is not run",
        ):
            self.assertIn(fault, printed)

    def test_missing_world_is_an_error_and_does_not_affect_other_servers(self):
        before = proxy('get_world_properties', GetWorldProperties)()
        for name in ('worlds/mud.world', '/no/such.world'):
            # under the name of the running server
            with ServerProcess(name) as server:
                code, printed = server.wait()
            self.assertEqual(code, 1)
            (line,) = printed.splitlines()
            for words in (name, 'GAZEBO_RESOURCE_PATH', 'worlds/empty.world, worlds/line.world'):
                self.assertIn(words, line)
        after = proxy('get_world_properties', GetWorldProperties)()
        self.assertEqual(after.model_names, before.model_names)
        self.assertGreater(after.sim_time, before.sim_time)

    def test_invalid_world_is_an_error(self):
        self.world.write_text(WORLD[:-20], encoding='utf-8')
        with ServerProcess(str(self.world), NAME) as server:
            code, printed = server.wait()
        self.assertEqual(code, 1)
        (line,) = printed.splitlines()
        self.assertIn(f'{self.world}, line ', line)

    def test_perf_prints_a_profile(self):
        with ServerProcess('--iters', '50', NAME, program='perf') as server:
            code, printed = server.wait()
        self.assertEqual(code, 0)
        self.assertIn('tottime', printed)
        self.assertIn('pybullet', printed)
