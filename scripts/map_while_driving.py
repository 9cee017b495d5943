#!/usr/bin/env python3
"""Draw an occupancy grid from scans and odometry, while somebody else drives the robot.

A cell holds its log-odds, log(p / (1 - p)) with p the probability that it is occupied. The
odometry is trusted, so its errors end up in the map.

Publishes:
    map (nav_msgs/OccupancyGrid): latched, every second; 0 (free) to 100 (occupied), -1 (unknown).
Subscribes:
    scan (sensor_msgs/LaserScan), /tf, /tf_static: the distances, and where the laser was.
Parameters:
    ~frame: the frame of the map, which is that of the odometry.
    ~size, ~resolution: length of the map and of a cell [m]; the middle is the frame's origin.
"""

import numpy as np
import rospy
import tf2_ros
from nav_msgs.msg import OccupancyGrid
from sensor_msgs.msg import LaserScan

from rosbots_description.ros_api.clients.node_program import run_node

CROSSED, HIT = -0.4, 0.9  # added to the log-odds of a cell that a ray crosses or ends in
LIMIT = 5.0  # of the log-odds, so that a few scans can change a cell again


def mask(grid, x, y):
    """Return which cells of a square grid [row, column] hold a point x, y [cells]."""
    cells, held = np.floor([y, x]).astype(int) + len(grid) // 2, np.zeros_like(grid, bool)
    held[tuple(cells[:, np.all((cells >= 0) & (cells < len(grid)), axis=0)])] = True
    return held


def add_scan(grid, x, y, directions, ranges, farthest):
    """Return the grid after rays from x, y at directions [rad]; all lengths in cells."""
    cos, sin = np.cos(directions), np.sin(directions)
    steps = np.arange(0, farthest, 0.5)
    ray, step = np.nonzero(steps < ranges[:, None])  # the points along all rays at once
    crossed = mask(grid, x + steps[step] * cos[ray], y + steps[step] * sin[ray])
    end = ranges < farthest  # a ray that hits nothing has range inf, an invalid one nan
    hit = mask(grid, x + ranges[end] * cos[end], y + ranges[end] * sin[end])
    return np.clip(grid + np.where(hit, HIT, np.where(crossed, CROSSED, 0)), -LIMIT, LIMIT)


def main():
    """Add each scan to the grid, and publish the grid every second."""
    rospy.init_node('map_while_driving')
    size, cell = rospy.get_param('~size', 30.0), rospy.get_param('~resolution', 0.1)
    grid = np.zeros((round(size / cell),) * 2)
    message = OccupancyGrid()
    message.header.frame_id = rospy.get_param('~frame', 'odom')
    message.info.width, message.info.height = grid.shape
    message.info.resolution, message.info.origin.orientation.w = cell, 1.0
    message.info.origin.position.x = message.info.origin.position.y = -(len(grid) // 2) * cell
    maps = rospy.Publisher('map', OccupancyGrid, queue_size=1, latch=True)
    transforms = tf2_ros.Buffer()
    tf2_ros.TransformListener(transforms)

    def add(scan):
        nonlocal grid
        pose = message.header.frame_id, scan.header.frame_id, scan.header.stamp
        if transforms.can_transform(*pose, rospy.Duration(0.5)):  # not so at the very beginning
            laser = transforms.lookup_transform(*pose).transform
            yaw = 2 * np.arctan2(laser.rotation.z, laser.rotation.w)
            ranges = np.where(np.array(scan.ranges) > scan.range_min, scan.ranges, np.nan) / cell
            directions = yaw + scan.angle_min + scan.angle_increment * np.arange(len(ranges))
            grid = add_scan(
                grid,
                laser.translation.x / cell,
                laser.translation.y / cell,
                directions,
                ranges,
                scan.range_max / cell,
            )

    def publish(_event):
        percent = np.where(grid == 0, -1, 100 / (1 + np.exp(-grid)))
        maps.publish(message.header, message.info, percent.astype(int).ravel().tolist())

    rospy.Subscriber('scan', LaserScan, add, queue_size=10)
    rospy.Timer(rospy.Duration(1.0), publish, reset=True)
    rospy.spin()


if __name__ == '__main__':
    run_node(main)
