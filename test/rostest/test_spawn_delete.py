#!/usr/bin/env python3
"""Delete and spawn again, often, and half of the time while driving."""

import sys
from pathlib import Path
from xmlrpc.client import ServerProxy

import rosgraph
import rospy
import rostest
from nav_msgs.msg import Odometry
from simulator import SimulatorTest, topics_of, wait_until

CYCLES = 200
WARM_UP = 10  # cycles after which caches are filled
GROWTH = 20.0  # [MB] promised
THREADS = 2  # that may be handling a connection


class SpawnDeleteTest(SimulatorTest):
    def test_two_hundred_times(self):
        bare = topics_of()
        process = self._process()
        before = None
        for cycle in range(CYCLES):
            self.assertTrue(self.spawn().success)
            if cycle % 20 == 0:
                self.assertIn('/odom', topics_of())
                self._drive_a_bit()
            elif cycle % 2:
                self._send_commands()
            self.disconnect()
            self.assertTrue(self.delete('rosbots').success)
            if cycle == WARM_UP:
                before = self._memory(process), self._threads(process)
        self.assertEqual(topics_of(), bare)
        self.assertLess(self._memory(process) - before[0], GROWTH)
        wait_until(lambda: self._threads(process) <= before[1] + THREADS, 'threads to end')
        self.assertTrue(self.spawn().success)
        self._drive_a_bit()

    def _drive_a_bit(self):
        odometry = self.collect('/odom', Odometry)
        drive = self.driver()

        def moves():
            drive(0.5)  # repeated: the first may reach the previous model
            return odometry and odometry[-1].twist.twist.linear.x > 0.05

        wait_until(moves, 'driving')

    def _send_commands(self):
        self.driver()(0.5)

    @staticmethod
    def _process():
        uri = rosgraph.Master('/test').lookupNode('/gazebo')
        return Path('/proc', str(ServerProxy(uri).getPid('/test')[2]))

    @staticmethod
    def _memory(process):
        """Return the resident memory [MB]."""
        pages = int((process / 'statm').read_text().split()[1])
        return pages * 4096 / 1e6

    @staticmethod
    def _threads(process):
        return len(list((process / 'task').iterdir()))


if __name__ == '__main__':
    rospy.init_node('test_spawn_delete', disable_rostime=True)
    rostest.rosrun('rosbots_description', 'spawn_delete', SpawnDeleteTest, sys.argv)
