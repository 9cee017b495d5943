"""Delete and spawn again, often, and half of the time while driving."""

from pathlib import Path

from nav_msgs.msg import Odometry
from programs import memory_of
from simulator import SimulatorTest, process_of, topics_of, wait_until

CYCLES = 200
WARM_UP = 10  # cycles after which caches are filled
GROWTH = 20e6  # [bytes] promised
THREADS = 2  # that may be handling a connection


def threads_of(pid):
    return len(list(Path(f'/proc/{pid}/task').iterdir()))


class SpawnDeleteTest(SimulatorTest):
    def test_two_hundred_times(self):
        bare = topics_of()
        process = process_of()
        before = None
        for cycle in range(CYCLES):
            self.assertTrue(self.spawn().success)
            if cycle % 20 == 0:
                self.assertIn('/odom', topics_of())
                self._drive_a_bit()
            elif cycle % 2:
                self.driver()(0.5)
            self.disconnect()
            self.assertTrue(self.delete('rosbots').success)
            if cycle == WARM_UP:
                before = memory_of(process), threads_of(process)
        self.assertEqual(topics_of(), bare)
        self.assertLess(memory_of(process) - before[0], GROWTH)
        wait_until(lambda: threads_of(process) <= before[1] + THREADS, 'threads to end')
        self.assertTrue(self.spawn().success)
        self._drive_a_bit()

    def _drive_a_bit(self):
        odometry = self.collect('/odom', Odometry)
        drive = self.driver()

        def moves():
            drive(0.5)  # repeated: the first may reach the previous model
            return odometry and odometry[-1].twist.twist.linear.x > 0.05

        wait_until(moves, 'driving')
