#!/usr/bin/env python3
"""Wander without touching anything: drive while the way ahead is free, else turn on the spot.

The robot is taken as a disc about the middle of its axle. Turning on the spot does not move the
disc, so a laser that looks ahead is enough.

Publishes:
    cmd_vel (geometry_msgs/Twist): forward speed and rate of turn.
Subscribes:
    scan (sensor_msgs/LaserScan): distances ahead of the robot.
Parameters:
    ~radius: radius of the disc [m].
    ~laser_x: how far the laser is in front of the axle [m].
    ~gap: the robot turns when the way left to the disc is shorter than this [m].
    ~speed, ~turn: forward speed [m/s] and rate of turn [rad/s].
"""

import numpy as np
import rospy
from geometry_msgs.msg import Twist
from sensor_msgs.msg import LaserScan

from rosbots_description.ros_api.clients.node_program import run_node

ROOM = 1.0  # free way after which a turning robot drives again [m]


def free_way(x, y, radius):
    """Return how far a disc at the origin can go along x before it touches a point x, y [m]."""
    ahead = (np.abs(y) < radius) & (x > 0)
    return np.min(x[ahead] - np.sqrt(radius**2 - y[ahead] ** 2), initial=np.inf)


class Wanderer:
    """Answer scans with commands; between them it remembers which way it is turning."""

    def __init__(self, radius, laser_x, gap, speed, turn):
        self.radius, self.laser_x, self.gap = radius, laser_x, gap
        self.speed, self.turn = speed, turn
        self.turning = 0.0  # rate of turn while the way is blocked [rad/s]

    def command(self, ranges, angles):
        """Return the command (forward [m/s], turn [rad/s]) for ranges [m] at angles [rad]."""
        x, y = self.laser_x + ranges * np.cos(angles), ranges * np.sin(angles)
        way = free_way(x, y, self.radius)
        if way > (ROOM if self.turning else self.gap):
            self.turning = 0.0
            return min(self.speed, way), 0.0  # [m/s]: what is left is enough for a second
        if not self.turning:  # to the side with more room, until the way is free
            left, right = np.sum(ranges[y > 0]), np.sum(ranges[y < 0])  # 0 where it sees nothing
            self.turning = self.turn if left > right else -self.turn
        return 0.0, self.turning


def main():
    """Answer each scan with a command; stop the robot when the node is stopped."""
    rospy.init_node('wander')
    wanderer = Wanderer(
        rospy.get_param('~radius', 0.9),
        rospy.get_param('~laser_x', 0.4),
        rospy.get_param('~gap', 0.2),
        rospy.get_param('~speed', 0.5),
        rospy.get_param('~turn', 0.6),
    )
    commands = rospy.Publisher('cmd_vel', Twist, queue_size=1)
    rospy.on_shutdown(lambda: commands.publish(Twist()))
    rospy.on_shutdown(lambda: rospy.rostime.wallsleep(0.5))  # or it may get lost with the topic

    def answer(scan):
        # Nothing within reach is inf, or nan if invalid; too near is -inf (REP-117).
        ranges = np.clip(np.nan_to_num(scan.ranges, nan=np.inf), scan.range_min, scan.range_max)
        angles = scan.angle_min + scan.angle_increment * np.arange(len(ranges))
        command = Twist()
        command.linear.x, command.angular.z = wanderer.command(ranges, angles)
        if not rospy.core.is_shutdown_requested():  # otherwise the last word was to stop
            commands.publish(command)

    rospy.Subscriber('scan', LaserScan, answer, queue_size=1)
    rospy.spin()


if __name__ == '__main__':
    run_node(main)
