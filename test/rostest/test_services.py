"""Services in a running world, as gazebo_ros 2.9.2 has them; test_outcomes.py has the texts."""

import math

from geometry_msgs.msg import Point, Pose, Quaternion
from simulator import BOX, GROUND, SimulatorTest, pose, topics_of, wait_until

SPAWNED = 'SpawnModel: Successfully spawned entity'


class ServicesTest(SimulatorTest):
    def _assert_outcome(self, response, success, text):
        self.assertEqual((response.success, response.status_message), (success, text))

    def test_world_properties(self):
        response = self.world()
        self._assert_outcome(response, True, 'GetWorldProperties: got properties')
        self.assertEqual(response.model_names, [GROUND])
        self.assertTrue(response.rendering_enabled)
        self.assertGreater(response.sim_time, 0.0)

    def test_spawn_in_frames(self):
        self.pause()
        turned = Pose(Point(1.0, 0.0, 5.0), Quaternion(0.0, 0.0, math.sqrt(0.5), math.sqrt(0.5)))
        self._assert_outcome(self.spawn('a', BOX, turned), True, SPAWNED)
        for frame in ('a', 'a::body', 'body'):
            self._assert_outcome(self.spawn('b', BOX, pose(2.0, 0.0, 0.0), frame), True, SPAWNED)
            position = self.model_state('b', '').pose.position
            self.assertAlmostEqual(position.x, 1.0, places=6)
            self.assertAlmostEqual(position.y, 2.0, places=6)
            self.assertAlmostEqual(position.z, 5.0, places=6)
            self.delete('b')
        for frame in ('', 'world', 'map', '/map'):
            self._assert_outcome(self.spawn('b', BOX, pose(2.0, 0.0, 0.0), frame), True, SPAWNED)
            self.delete('b')
        self.assertFalse(self.spawn('b', BOX, pose(), 'odom').success)

    def test_spawn_and_delete_while_paused(self):
        self.pause()
        self._assert_outcome(self.spawn(), True, SPAWNED)
        self.assertAlmostEqual(self.model_state('rosbots', '').pose.position.z, 0.5)
        self.assertIn('/odom', topics_of())
        self._assert_outcome(
            self.delete('rosbots'), True, 'DeleteModel: successfully deleted model'
        )
        self.assertNotIn('/odom', topics_of())

    def test_model_state(self):
        self.pause()
        self.spawn('box', BOX, pose(1.0, 2.0, 3.0))
        response = self.model_state('box', '')
        self._assert_outcome(response, True, 'GetModelState: got properties')
        self.assertEqual(response.pose.position.y, 2.0)
        self.assertAlmostEqual(response.header.stamp.to_sec(), self.world().sim_time, places=9)
        self.assertEqual(response.header.frame_id, '')
        # Successful look-ups are counted for each model.
        self.model_state(GROUND, '')
        self.model_state('nope', '')
        relative = self.model_state('box', 'ground_plane::link')
        self.assertEqual(relative.header.seq, response.header.seq + 1)
        self.assertEqual(relative.header.frame_id, 'ground_plane::link')

    def test_state_of_a_missing_model_has_no_pose(self):
        for response in (self.model_state('nope', ''), self.model_state(GROUND, 'nope')):
            self.assertFalse(response.success)
            self.assertEqual(response.pose, Pose())
        self.assertEqual(response.header.frame_id, 'nope')

    def test_repeated_pause_and_unpause_succeed(self):
        for _ in range(2):
            self.pause()
        stopped = self.world().sim_time
        self.spawn('box', BOX, pose())  # far longer than a step
        self.assertEqual(self.world().sim_time, stopped)
        for _ in range(2):
            self.unpause()
        wait_until(lambda: self.world().sim_time > stopped, 'advance of time')
