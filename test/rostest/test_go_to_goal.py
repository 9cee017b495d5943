#!/usr/bin/env python3
"""The robot drives to goals: by the example node, and by a policy that was learned without ROS."""

import json
import math
import subprocess
import sys
from pathlib import Path

import gymnasium
import numpy as np
import rosnode
import rospy
import rostest
from example_nodes import AT_REST, LIMIT, REAL_TIME, ExampleNodeTest
from gazebo_msgs.srv import GetModelState
from geometry_msgs.msg import Twist
from rosbots_msgs.srv import Step
from simulator import COMMANDS, proxy, wait_until

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / 'scripts'))
from follow_policy import REACHED, inputs, outputs  # noqa: E402
from ros_environment import RosGoToGoal  # noqa: E402

GOAL = -1.5, 0.5  # [m], see the launch file
POLICY = ROOT / 'config' / 'go_to_goal_policy.json'
# An episode [m, rad] that small differences do not change: starts that vary by 1 cm and 0.02 rad
# lead to ways within 0.05 m, a command that is late by a period to one within 0.06 m.
LEARNED = {'start': (1.0, -0.5, 1.0), 'goal': (-1.5, 0.5)}
NEAR = 0.1  # [m] between the ways in both worlds: over ROS, a scan is up to a period old
STEPS = 200  # of an episode, at most
PERIOD = 100  # steps between scans


def track(environment):
    """Drive an episode by the learned policy; return the robot's track (x, y) [m], and success."""
    layers = json.loads(POLICY.read_text())['layers']
    seen, info = environment.reset(options=LEARNED)
    points, ended = [info['pose'][:2]], False
    while not ended and len(points) < STEPS:
        seen, _, ended, _, info = environment.step(
            outputs(layers, inputs(seen['laser'], *seen['goal']))
        )
        points.append(info['pose'][:2])
    return np.array(points), info['is_success']


class GoToGoalTest(ExampleNodeTest):
    def distance(self, goal):
        at = proxy('get_model_state', GetModelState)('rosbots', '').pose.position
        return math.dist((at.x, at.y), goal)

    def test_1_the_robot_stands_at_the_goal_when_the_node_ends(self):
        self.limit_rate(REAL_TIME)  # faster, the node may steer too late, and circle the goal
        wait_until(lambda: '/go_to_goal' not in rosnode.get_node_names(), 'the goal', LIMIT)
        wait_until(lambda: self.speed < AT_REST, 'the robot stopping')
        self.assertLess(self.distance(GOAL), 0.15)

    def test_2_a_learned_policy_drives_alike_in_both_worlds(self):
        ros = RosGoToGoal()
        self.addCleanup(ros.close)  # which lets the simulation run
        over_ros, arrives = track(ros)
        self.assertTrue(arrives)
        environment = gymnasium.make('rosbots_description.gym:rosbots/GoToGoal-v0')
        self.addCleanup(environment.close)
        without, arrives = track(environment)
        self.assertTrue(arrives)
        between = np.linalg.norm(over_ros[:, None] - without, axis=-1)
        self.assertLess(max(between.min(axis=0).max(), between.min(axis=1).max()), NEAR)

    def test_3_the_learned_policy_drives_the_robot_by_its_node(self):
        environment = RosGoToGoal()
        environment.reset(options=LEARNED)
        environment.step((1.0, 1.0))
        _, info = environment.reset(options=LEARNED)  # of a robot that drives
        self.assertLess(np.abs(info['pose'] - LEARNED['start']).max(), 0.005)
        self.track.clear()
        commands = []
        rospy.Subscriber(COMMANDS, Twist, commands.append, tcp_nodelay=True)
        script = ROOT / 'scripts' / 'follow_policy.py'
        x, y = LEARNED['goal']
        arguments = f'_policy:={POLICY} _x:={x} _y:={y} cmd_vel:={COMMANDS}'.split()
        node = subprocess.Popen([script, *arguments])
        self.addCleanup(node.kill)
        while node.poll() is None:
            seen = len(commands)
            self.assertTrue(proxy('step', Step)(PERIOD).success)
            if seen:  # the node is ready: it answers each scan
                wait_until(
                    lambda seen=seen: len(commands) > seen or node.poll() is not None,
                    'a command',
                    LIMIT,
                )
        self.assertEqual(node.returncode, 0)
        environment.close()
        wait_until(lambda: self.speed < AT_REST, 'the robot stopping')
        # Where it stops depends on how late the last command is; where it has been does not.
        nearest = min(math.dist((x, y), LEARNED['goal']) for _, x, y, _ in self.track)
        self.assertLess(nearest, REACHED)


if __name__ == '__main__':
    rospy.init_node('test_go_to_goal', disable_rostime=True)
    rostest.rosrun('rosbots_description', 'example_go_to_goal', GoToGoalTest, sys.argv)
