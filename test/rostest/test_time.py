"""Simulated time: /clock, pause and the two resets."""

import itertools
import time

from gazebo_msgs.msg import LinkStates, ModelStates
from nav_msgs.msg import Odometry
from rosgraph_msgs.msg import Clock
from simulator import GROUND, SimulatorTest, wait_until

from rosbots_description.ros_api.server.loop import MAX_LAG

STEP = 1_000_000  # [ns]
SPAWN_HEIGHT, REST_HEIGHT = 0.5, -0.12  # [m]
REST_TOLERANCE = 0.002  # [m] promised
RATE_TOLERANCE = 0.02  # relative; 0.01 is promised over long times


class TimeTest(SimulatorTest):
    def test_clock_has_every_step_and_is_not_faster_than_real_time(self):
        clock = self.collect('/clock', Clock)
        wait_until(clock.__len__, 'a first message')
        # A busy machine may be slower; the benchmark real_time measures that.
        begin, first = time.monotonic(), self.world().sim_time
        wait_until(lambda: len(clock) > 3000, 'three seconds of /clock')
        simulated = self.world().sim_time - first
        passed = time.monotonic() - begin
        self.assertLess(simulated, (passed + MAX_LAG) * (1.0 + RATE_TOLERANCE))
        ticks = [m.clock.to_nsec() for m in clock]
        steps = {b - a for a, b in itertools.pairwise(ticks)}
        self.assertEqual(min(steps), STEP)

    def test_states_have_every_step_and_all_names(self):
        self.spawn()
        models = self.collect('/gazebo/model_states', ModelStates)
        links = self.collect('/gazebo/link_states', LinkStates)
        wait_until(lambda: len(models) > 500 and len(links) > 500, 'half a second of states')
        self.assertEqual(models[-1].name, [GROUND, 'rosbots'])
        self.assertEqual(
            links[-1].name,
            [
                'ground_plane::link',
                'rosbots::base_footprint',
                'rosbots::wheel_left_link',
                'rosbots::wheel_right_link',
            ],
        )
        self.assertEqual(len(models[-1].pose), 2)
        self.assertEqual(len(links[-1].twist), 4)

    def test_nothing_is_published_while_paused(self):
        self.spawn()
        self.pause()
        self.pause()
        stood = self.world().sim_time
        # Subscribed to now, so that nothing is on its way that was published before the pause.
        heard = [
            self.collect('/clock', Clock),
            self.collect('/odom', Odometry),
            self.collect('/gazebo/model_states', ModelStates),
        ]
        for _ in range(20):  # services are answered, and time does not advance
            self.assertEqual(self.world().sim_time, stood)
        self.assertEqual(heard, [[], [], []])
        self.unpause()
        wait_until(lambda: all(heard), 'messages of each topic')
        self.assertEqual(heard[0][0].clock.to_nsec(), round(stood * 1e9) + STEP)

    def test_reset_world_resets_poses_and_keeps_time(self):
        drive = self._at_rest_then_drive()
        before = self.world().sim_time
        self.reset_world()
        self.assertGreater(self.world().sim_time, before)
        self._assert_back_at_spawn_and_at_rest()
        drive(0.5)
        wait_until(lambda: self.x_of() > 0.2, 'motion by a new command')

    def test_reset_simulation_resets_poses_and_time(self):
        drive = self._at_rest_then_drive()
        clock, odometry = self.collect('/clock', Clock), self.collect('/odom', Odometry)
        wait_until(lambda: self.world().sim_time > 1.0, 'one second')
        clock.clear()
        self.reset_simulation()
        wait_until(
            lambda: STEP in [message.clock.to_nsec() for message in list(clock)], 'the first step'
        )
        self._assert_back_at_spawn_and_at_rest()
        odometry.clear()
        wait_until(odometry.__len__, 'odometry after the reset')
        self.assertEqual(self.world().model_names, [GROUND, 'rosbots'])
        drive(0.5)
        wait_until(lambda: self.x_of() > 0.2, 'motion by a new command')

    def _at_rest_then_drive(self):
        self.spawn()
        drive = self.driver()
        drive(0.5)
        wait_until(lambda: self.x_of() > 0.3, 'motion of the robot')
        return drive

    def _assert_back_at_spawn_and_at_rest(self):
        self.assertLess(self.x_of(), 0.1)
        wait_until(lambda: abs(self._height() - REST_HEIGHT) < REST_TOLERANCE, 'standing')
        self.assertLess(self.x_of(), 0.1, 'the robot still drives: the command was not cleared')

    def _height(self):
        return self.model_state('rosbots', '').pose.position.z
