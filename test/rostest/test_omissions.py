"""Clients are informed of omissions of a spawned model; Gazebo's response is unchanged."""

import rospy
from rosbots_msgs.srv import GetModelOmissions
from simulator import SENSOR_BOX, SimulatorTest, proxy, spawn_model

PARTS = ["mesh 'file:///nowhere/nope.stl'", "plugin 'libgazebo_ros_imu.so'", "sonar 'sonar1'"]


class OmissionsTest(SimulatorTest):
    def setUp(self):
        super().setUp()
        self._omissions = proxy('get_model_omissions', GetModelOmissions)

    def test_spawn_model_prints_omissions_in_one_line(self):
        done = spawn_model('box', SENSOR_BOX)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn('Spawn status: SpawnModel: Successfully spawned entity\n', done.stdout)
        (line,) = [line for line in done.stderr.splitlines() if 'spawned without' in line]
        self.assertIn(f'spawned without: {", ".join(PARTS)}; see doc/gazebo_compatibility.md', line)
        self.assertEqual(self._omissions('box').omissions, PARTS)

    def test_spawn_model_prints_nothing_about_a_complete_model(self):
        done = spawn_model('rosbots', rospy.get_param('robot_description'))
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertNotIn('without', done.stdout + done.stderr)
        self.assertEqual(self._omissions('rosbots').omissions, [])

    def test_omissions_of_a_missing_model_are_an_error(self):
        response = self._omissions('nobody')
        self.assertFalse(response.success)
        self.assertEqual(response.status_message, 'GetModelOmissions: model does not exist')
