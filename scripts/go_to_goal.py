#!/usr/bin/env python3
"""Drive to a goal: turn towards it, slow down near it, stop there, and end.

Where the robot is, the simulator tells. A real robot would take this from its localisation.

Publishes:
    cmd_vel (geometry_msgs/Twist): forward speed and rate of turn.
Calls:
    /gazebo/get_model_state (gazebo_msgs/GetModelState): the robot's pose in the world frame.
Parameters:
    ~x, ~y: the goal in the world frame [m].
    ~model: the robot's name in the simulator.
    ~tolerance: how near is near enough [m].
    ~speed, ~turn: limits of the command [m/s], [rad/s].
"""

import math

import rospy
from gazebo_msgs.srv import GetModelState
from geometry_msgs.msg import Twist

from rosbots_description.ros_api.clients.node_program import run_node

RATE = 20.0  # [Hz], simulated time
SLOW_DOWN = 0.8  # speed per distance to the goal [1/s]
TURN = 2.0  # rate of turn per heading error [1/s]


def yaw_of(q):
    """Return the rotation about z of a quaternion [rad], from -pi to pi."""
    return math.atan2(2 * (q.w * q.z + q.x * q.y), 1 - 2 * (q.y**2 + q.z**2))


def steer(dx, dy, yaw, speed, turn):
    """Return the command (forward [m/s], turn [rad/s]) for a goal dx, dy [m] away at a yaw [rad].

    The cosine lets the robot turn on the spot until the goal is ahead.
    """
    error = math.remainder(math.atan2(dy, dx) - yaw, math.tau)
    forward = min(speed, SLOW_DOWN * math.hypot(dx, dy)) * max(0.0, math.cos(error)) ** 3
    return forward, max(-turn, min(turn, TURN * error))


def main():
    """Drive until the goal is reached or the node is stopped; then stop the robot."""
    rospy.init_node('go_to_goal')
    x, y = rospy.get_param('~x', 3.0), rospy.get_param('~y', 2.0)
    model = rospy.get_param('~model', 'rosbots')
    tolerance = rospy.get_param('~tolerance', 0.1)
    speed, turn = rospy.get_param('~speed', 0.8), rospy.get_param('~turn', 0.8)
    commands = rospy.Publisher('cmd_vel', Twist, queue_size=1)
    rospy.on_shutdown(lambda: commands.publish(Twist()))
    rospy.on_shutdown(lambda: rospy.rostime.wallsleep(0.5))  # or it may get lost with the topic
    rospy.wait_for_service('/gazebo/get_model_state')
    model_state = rospy.ServiceProxy('/gazebo/get_model_state', GetModelState)
    rate = rospy.Rate(RATE, reset=True)  # reset: go on after a reset of the simulation
    while not rospy.is_shutdown():
        state = model_state(model, 'world')
        if not state.success:
            rospy.logwarn_once('There is no model %s yet.', model)
            rospy.sleep(1.0)
            continue
        dx, dy = x - state.pose.position.x, y - state.pose.position.y
        if math.hypot(dx, dy) < tolerance:
            rospy.loginfo('Arrived: the goal is %.2f m away.', math.hypot(dx, dy))
            return
        command = Twist()
        command.linear.x, command.angular.z = steer(
            dx, dy, yaw_of(state.pose.orientation), speed, turn
        )
        if not rospy.core.is_shutdown_requested():  # otherwise the last word was to stop
            commands.publish(command)
        rate.sleep()


if __name__ == '__main__':
    run_node(main)
