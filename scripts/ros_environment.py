#!/usr/bin/env python3
"""The task rosbots/GoToGoal-v0 over ROS: pause, step and reset the simulator by its services.

For learning with ROS in the loop: a node under test, or a navigation stack between the agent and
the robot. Without, rosbots/GoToGoal-v0 is faster. /gazebo/step comes after what was sent before it.

Publishes:
    cmd_vel (geometry_msgs/Twist): the action.
Subscribes:
    scan (sensor_msgs/LaserScan), odom (nav_msgs/Odometry): the observation.
    bumper_states (gazebo_msgs/ContactsState): whether one of the decks touches something.
Calls:
    /gazebo/pause_physics, /gazebo/unpause_physics, /gazebo/reset_world, /gazebo/set_model_state,
    /gazebo/get_model_state, and /gazebo/step (rosbots_msgs/Step), which Gazebo does not have.
Parameters:
    ~policy: path of a policy for follow_policy.py, which drives as an example.
    ~episodes: how many.
    ~exact: advance by /gazebo/step; false: run for a control period between unpause and pause.
    ~bumper: end an episode when the robot touches something; steps take three times as long.
"""

import json
import math
import threading
import time
import warnings
from pathlib import Path

import gymnasium
import numpy as np
import rospy
from follow_policy import inputs, outputs
from gazebo_msgs.msg import ContactsState, ModelState
from gazebo_msgs.srv import GetModelState, SetModelState
from geometry_msgs.msg import Point, Pose, Quaternion, Twist
from gymnasium import spaces
from nav_msgs.msg import Odometry
from rosbots_msgs.srv import Step
from sensor_msgs.msg import LaserScan
from std_srvs.srv import Empty

from rosbots_description.ros_api.clients.node_program import run_node

PERIOD, STEPS = 0.1, 100  # of control [s], simulated; in steps of 1 ms
REACHED, BUMPED = 0.4, -1.0  # distance to the goal [m]; reward for touching something
SPEED, TURN = 0.8, 0.8  # what an action of 1 means [m/s], [rad/s]
AT_REST = -0.12  # height of base_footprint [m]
STILL, STOPPING = 0.01, 20  # speed [m/s] or [rad/s]; control periods, twice what it takes at most
START, GOAL = (0.8, 0.6), (2.0, 0.4)  # where nothing stands: x and y, from -most to most [m]
PATIENCE = 10.0  # [s, wall] for what is under way
TOPICS = {  # with their periods [s], simulated
    'scan': (LaserScan, 0.1),
    'odom': (Odometry, 0.01),
    'bumper_states': (ContactsState, 0.02),
}
FAR = np.array([1e9, 1e9, math.pi, 1e9, 1e9, 1e9], 'f')  # odometry has no bounds of its own
WAY = np.array([1e3, 1.0, 1.0], 'f')


class RosGoToGoal(gymnasium.Env):
    """Spaces, rewards and options are those of rosbots/GoToGoal-v0."""

    observation_space = spaces.Dict(
        {
            'goal': spaces.Box(-WAY, WAY),
            'laser': spaces.Box(0.1, 10.0, (361,), np.float32),
            'odometry': spaces.Box(-FAR, FAR),
        }
    )
    action_space = spaces.Box(-1.0, 1.0, (2,), np.float32)

    def __init__(self, exact=True, bumper=True, model='rosbots'):
        def service(name, kind):
            rospy.wait_for_service(f'/gazebo/{name}')
            return rospy.ServiceProxy(f'/gazebo/{name}', kind, persistent=True)

        self._exact, self._model = exact, model
        self._step, self._reset_world = service('step', Step), service('reset_world', Empty)
        self._pause = service('pause_physics', Empty)
        self._unpause = service('unpause_physics', Empty)
        self._place = service('set_model_state', SetModelState)
        self._state = service('get_model_state', GetModelState)
        self._newest, self._arrived = {}, threading.Condition()
        with warnings.catch_warnings(action='ignore'):  # that publishing waits: it is meant to
            self._commands = rospy.Publisher('cmd_vel', Twist, queue_size=None, tcp_nodelay=True)
        self._periods = {
            topic: period
            for topic, (kind, period) in TOPICS.items()
            if bumper or topic != 'bumper_states'
        }
        for topic in self._periods:
            rospy.Subscriber(
                topic, TOPICS[topic][0], self._keep, topic, queue_size=1, tcp_nodelay=True
            )
        end = time.monotonic() + PATIENCE
        while not self._commands.get_num_connections():  # what is published now is lost
            if time.monotonic() > end:
                raise TimeoutError(f'no robot subscribes to {self._commands.resolved_name}')
            rospy.rostime.wallsleep(0.01)

    def _keep(self, message, topic):
        with self._arrived:
            self._newest[topic] = message
            self._arrived.notify()

    def reset(self, *, seed=None, options=None):
        """Stop the robot and start an episode; that takes a control period, for a scan at rest."""
        super().reset(seed=seed)
        draw, options = self.np_random.uniform, options or {}
        x, y, yaw = options.get('start', draw(-1.0, 1.0, 3) * (*START, math.pi))
        self._goal = np.array(options.get('goal', draw(-1.0, 1.0, 2) * GOAL))
        self._pause()
        self._commands.publish(Twist())
        for _ in range(STOPPING):  # reset_world leaves the wheels their speed
            moving, _ = self._advance()
            if np.abs(moving['odometry'][3:]).max() < STILL:
                break
        self._reset_world()
        done(
            self._place(
                ModelState(
                    self._model,
                    Pose(
                        Point(x, y, AT_REST),
                        Quaternion(0.0, 0.0, math.sin(yaw / 2), math.cos(yaw / 2)),
                    ),
                    Twist(),
                    'world',
                )
            )
        )
        seen, info = self._advance()
        self._left = seen['goal'][0]
        return seen, info

    def step(self, action):
        """Drive for a control period."""
        if not np.isfinite(action).all():
            raise ValueError(f'an action is two finite numbers from -1 to 1; it got {action}')
        command = Twist()
        command.linear.x, command.angular.z = np.clip(action, -1.0, 1.0) * (SPEED, TURN)
        self._commands.publish(command)
        before, (seen, info) = self._left, self._advance()
        self._left = seen['goal'][0]
        if 'bumper_states' in self._newest and self._newest['bumper_states'].states:
            return seen, BUMPED, True, False, info
        reward = float(before - self._left + info['is_success'])
        return seen, reward, info['is_success'], False, info

    def close(self):
        """Stop the robot, and let the simulation run."""
        self._commands.publish(Twist())
        self._unpause()

    def _advance(self):
        """Let a control period pass; return observation and info at its end."""
        if self._exact:
            done(self._step(STEPS))
        else:
            self._unpause()
            rospy.sleep(PERIOD)
            self._pause()
        state = done(self._state(self._model, 'world'))
        with self._arrived:
            if not self._arrived.wait_for(lambda: self._is_complete(state.header.stamp), PATIENCE):
                raise TimeoutError(
                    f'no messages on {", ".join(self._periods)}; spawn the robot '
                    'with laser:=true bumper:=true'
                )
            return self._read(state)

    def _is_complete(self, now):
        return all(
            topic in self._newest
            and (now - self._newest[topic].header.stamp).to_sec() < period - 1e-9
            for topic, period in self._periods.items()
        )

    def _read(self, state):
        """Return observation and info; `state` is the robot's true pose."""
        scan, odom = self._newest['scan'], self._newest['odom']
        (x, y, yaw), twist = pose_of(state.pose), odom.twist.twist
        dx, dy = self._goal - (x, y)
        distance, bearing = math.hypot(dx, dy), math.atan2(dy, dx) - yaw
        seen = {
            'goal': np.array((distance, math.cos(bearing), math.sin(bearing)), 'f'),
            'laser': np.clip(scan.ranges, scan.range_min, scan.range_max).astype('f'),
            'odometry': np.array(
                (*pose_of(odom.pose.pose), twist.linear.x, twist.linear.y, twist.angular.z), 'f'
            ),
        }
        return seen, {
            'time': state.header.stamp.to_sec(),
            'pose': np.array((x, y, yaw)),
            'goal': self._goal,
            'is_success': distance < REACHED,
        }


def done(answer):
    """Return the answer of a service that did what it was asked."""
    if not answer.success:
        raise RuntimeError(answer.status_message)
    return answer


def pose_of(pose):
    """Return x, y [m] and yaw [rad] of a Pose message."""
    q = pose.orientation
    yaw = math.atan2(2 * (q.w * q.z + q.x * q.y), 1 - 2 * (q.y**2 + q.z**2))
    return pose.position.x, pose.position.y, yaw


def main():
    """Drive episodes by a policy, and tell how each ended."""
    rospy.init_node('ros_environment')
    layers = json.loads(Path(rospy.get_param('~policy')).read_text(encoding='utf-8'))['layers']
    exact, bumper = rospy.get_param('~exact', True), rospy.get_param('~bumper', True)
    environment = gymnasium.wrappers.TimeLimit(RosGoToGoal(exact, bumper), 400)
    for number in range(rospy.get_param('~episodes', 3)):
        seen, info = environment.reset(seed=number)
        total, steps, ended = 0.0, 0, False
        while not ended:
            seen, reward, terminated, truncated, info = environment.step(
                outputs(layers, inputs(seen['laser'], *seen['goal']))
            )
            total, steps, ended = total + reward, steps + 1, terminated or truncated
        rospy.loginfo(
            'Episode %d: %s after %d steps, return %.2f',
            number,
            'reached the goal' if info['is_success'] else 'ended elsewhere',
            steps,
            total,
        )
    environment.close()


if __name__ == '__main__':
    run_node(main)
