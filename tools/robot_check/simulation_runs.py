#!/usr/bin/env python3
"""A rostest: a model besides the ground plane is simulated for a second.

Subscribes:
    /clock (rosgraph_msgs/Clock)
    /gazebo/model_states (gazebo_msgs/ModelStates)
Parameters:
    ~patience: seconds of wall time to wait for it, by default 120
"""

import threading
import time
import unittest

import rospy
import rostest
from gazebo_msgs.msg import ModelStates
from rosgraph_msgs.msg import Clock

NAME = 'simulation_runs'
SIMULATED = 1.0  # [s]


class SimulationRunsTest(unittest.TestCase):
    """What the launch file has started simulates a model."""

    def test_a_model_is_simulated(self) -> None:
        """Wait for a model and for a second of simulated time with it."""
        rospy.init_node(NAME)
        patience = rospy.get_param('~patience', 120)
        self._since: float | None = None  # simulated time when the model was seen first [s]
        self._models: list[str] = []
        self._done = threading.Event()
        rospy.Subscriber('/gazebo/model_states', ModelStates, self._see, queue_size=1)
        rospy.Subscriber('/clock', Clock, self._tick, queue_size=1)
        start = time.monotonic()
        while not self._done.wait(1.0) and time.monotonic() - start < patience:
            pass
        self.assertTrue(self._done.is_set(), self._reason(patience))
        print(f'simulated: {", ".join(self._models)}')

    def _see(self, message: ModelStates) -> None:
        self._models = [name for name in message.name if name != 'ground_plane']

    def _tick(self, message: Clock) -> None:
        now = message.clock.to_sec()
        if self._models and self._since is None:
            self._since = now
        if self._since is not None and now > self._since + SIMULATED:
            self._done.set()

    def _reason(self, patience: float) -> str:
        if self._models:
            return f'in {patience} s the simulation did not advance by {SIMULATED} s'
        return f'in {patience} s no model was spawned besides the ground plane'


if __name__ == '__main__':
    # mypy takes test/rostest for that package
    rostest.rosrun('rosbots_check', NAME, SimulationRunsTest)  # type: ignore[attr-defined]
