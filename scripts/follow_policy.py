#!/usr/bin/env python3
"""Drive to a goal by a policy that learn_by_cma.py has learned without ROS; stop there, and end.

Publishes:
    cmd_vel (geometry_msgs/Twist): forward speed and rate of turn.
Subscribes:
    scan (sensor_msgs/LaserScan): distances ahead; each scan is answered with a command.
    odom (nav_msgs/Odometry): where the robot is, in the frame in which the goal is given.
Parameters:
    ~policy: path of the file that holds the layers of the policy.
    ~x, ~y: the goal in the frame of odom [m].
"""

import json
import math
from pathlib import Path

import numpy as np

SECTORS = 9  # into which the rays of the laser scanner are divided
SPEED, TURN = 0.8, 0.8  # what an output of 1 means [m/s], [rad/s]
REACHED = 0.4  # distance to the goal at which it is reached [m]


def inputs(ranges, distance, cos, sin):
    """Return what the policy sees, from -1 to 1: nearness of each sector, distance and bearing.

    Ranges and distance are in metres; cos and sin are those of the bearing, positive to the left.
    """
    near = [math.exp(-part.min()) for part in np.array_split(ranges, SECTORS)]
    return np.array([*near, min(distance, 1.0), cos, sin])


def outputs(layers, values):
    """Return forward speed, from 0 to 1 as nothing looks back, and rate of turn, from -1 to 1.

    A layer is a matrix: a row for each output, a column for each input, and one for the bias.
    """
    for layer in layers:
        values = np.tanh(np.asarray(layer) @ np.append(values, 1.0))
    return np.array([(1.0 + values[0]) / 2, values[1]])


def main():
    """Answer each scan until the goal is reached or the node is stopped; then stop the robot."""
    import rospy  # not above: learning takes these functions to where there is no ROS
    from geometry_msgs.msg import Twist
    from nav_msgs.msg import Odometry
    from sensor_msgs.msg import LaserScan

    rospy.init_node('follow_policy')
    layers = json.loads(Path(rospy.get_param('~policy')).read_text(encoding='utf-8'))['layers']
    x, y = rospy.get_param('~x', 2.0), rospy.get_param('~y', 1.0)
    commands = rospy.Publisher('cmd_vel', Twist, queue_size=1)
    rospy.on_shutdown(lambda: commands.publish(Twist()))
    rospy.on_shutdown(lambda: rospy.rostime.wallsleep(0.5))  # or it may get lost with the topic
    newest = Odometry()

    def answer(scan):
        at, q = newest.pose.pose.position, newest.pose.pose.orientation
        distance, yaw = math.hypot(x - at.x, y - at.y), 2 * math.atan2(q.z, q.w)
        command = Twist()
        if distance < REACHED:
            rospy.signal_shutdown(f'arrived: the goal is {distance:.2f} m away')
        else:
            bearing = math.atan2(y - at.y, x - at.x) - yaw
            # Nothing within reach is inf, too near is -inf, and invalid is nan (REP-117).
            ranges = np.clip(np.nan_to_num(scan.ranges, nan=np.inf), scan.range_min, scan.range_max)
            forward, left = outputs(
                layers, inputs(ranges, distance, math.cos(bearing), math.sin(bearing))
            )
            command.linear.x, command.angular.z = SPEED * forward, TURN * left
        if not rospy.core.is_shutdown_requested():  # otherwise the last word was to stop
            commands.publish(command)

    def keep(odometry):
        nonlocal newest
        newest = odometry

    rospy.Subscriber('odom', Odometry, keep, queue_size=1)
    rospy.wait_for_message('odom', Odometry)
    rospy.Subscriber('scan', LaserScan, answer, queue_size=1)
    rospy.spin()


if __name__ == '__main__':
    from rosbots_description.ros_api.clients.node_program import run_node

    run_node(main)
