"""Importing the environments is cheap, and registers them."""

from support.programs import python

PROGRAM = """
import sys
sys.modules['rospy'] = None
import rosbots_description.gym
import gymnasium
print(*sorted(name for name in gymnasium.registry if name.startswith('rosbots/')))
print(*(name for name in sys.modules if name.startswith(('pybullet', 'rosbots_description.sim'))))
"""


def test_import_registers_the_tasks_and_loads_neither_ros_nor_the_simulator():
    ended = python(PROGRAM)
    assert ended.stderr == ''
    assert ended.stdout.splitlines() == [
        'rosbots/FollowLine-v0 rosbots/GoToGoal-v0 rosbots/Maze-v0 rosbots/Wander-v0',
        '',
    ]
