#!/usr/bin/env python3
"""Two example nodes in rooms.world: one wanders without touching anything, one draws the map."""

import sys
from xml.etree import ElementTree

import numpy as np
import rospy
import rostest
from example_nodes import WORLDS, ExampleNodeTest
from nav_msgs.msg import OccupancyGrid
from simulator import sends, wait_until

MAPPER, WANDERER, SCAN = '/map_while_driving', '/wander', '/scan'
DURATION = 60.0  # [s]
PERIOD = 100  # steps from one scan to the next
# The robot seen from above, in base_footprint [m]: its decks, and the left wheel beside them
OUTLINE = (-0.52, 0.58, -0.4, 0.6), (-0.08, 0.38, 0.4, 0.6125)
OCCUPIED, FREE = 65, 25  # [%] as map_server reads a map: above and below


def obstacle_distance(points):
    """Return the distance [m] of points (..., 2) from the obstacles of rooms.world, 0 inside."""
    nearest = np.full(points.shape[:-1], np.inf)
    for model in ElementTree.parse(WORLDS / 'rooms.world').getroot().iter('model'):
        x, y, *_, yaw = map(float, model.findtext('pose', '0 0 0 0 0 0').split())
        turned = (points - (x, y)) @ [[np.cos(yaw), -np.sin(yaw)], [np.sin(yaw), np.cos(yaw)]]
        for collision in model.iter('collision'):
            local = turned - np.array(collision.findtext('pose').split()[:2], float)
            radius = float(collision.findtext('.//radius', '0'))
            size = np.array(collision.findtext('.//size', '0 0 0').split()[:2], float)
            outside = np.maximum(np.abs(local) - size / 2, 0)
            nearest = np.minimum(nearest, np.maximum(np.hypot(*outside.T).T - radius, 0))
    return nearest


def outline():
    """Return points on the robot's outline, at most 2 cm apart [m]."""
    share = np.linspace(0, 1, 56)
    return np.concatenate(
        [
            np.concatenate(
                [np.stack([x0 + share * (x1 - x0), 0 * share + y], 1) for y in (y0, y1)]
                + [np.stack([0 * share + x, y0 + share * (y1 - y0)], 1) for x in (x0, x1)]
            )
            for x0, x1, y0, y1 in OUTLINE
        ]
    )


class MapWhileDrivingTest(ExampleNodeTest):
    def test_the_robot_wanders_without_touching_and_the_map_is_right(self):
        maps = []
        rospy.Subscriber('/map', OccupancyGrid, maps.append)
        wait_until(lambda: sends('/gazebo', SCAN, MAPPER), 'the node that draws the map')
        self.drive(WANDERER, SCAN, PERIOD, lambda: self.seconds() >= DURATION)
        self.kill_and_expect_rest(WANDERER)
        latest = maps[-1]
        self.check_track()
        self.check_map(latest)
        late = []  # a reader that comes late gets the map at once
        rospy.Subscriber('/map', OccupancyGrid, late.append)
        wait_until(lambda: late, 'the latched map')

    def check_track(self):
        track = np.array(self.track)
        cos, sin = np.cos(track[:, 3, None]), np.sin(track[:, 3, None])
        x, y = outline().T
        touched = np.stack(
            [track[:, 1, None] + x * cos - y * sin, track[:, 2, None] + x * sin + y * cos], axis=-1
        )
        gap = obstacle_distance(touched[::5]).min()
        way = np.hypot(*np.diff(self.axle_track()[:, 1:], axis=0).T).sum()
        print(f'{way:.1f} m in {self.seconds():.1f} s, {gap:.3f} m from the nearest obstacle')
        self.assertGreater(gap, 0)
        self.assertGreater(way, 10)

    def check_map(self, message):
        info = message.info
        self.assertEqual(message.header.frame_id, 'odom')
        cells = np.array(message.data).reshape(info.height, info.width)
        row, column = np.indices(cells.shape)
        origin = info.origin.position
        distance = obstacle_distance(
            np.stack(
                [
                    origin.x + (column + 0.5) * info.resolution,
                    origin.y + (row + 0.5) * info.resolution,
                ],
                axis=-1,
            )
        )
        occupied, free = cells > OCCUPIED, (cells >= 0) & (cells < FREE)
        right = np.mean(distance[occupied] < info.resolution)
        clear = np.mean(distance[free] > 0)
        print(
            f'{np.count_nonzero(occupied)} cells occupied, {right:.1%} of them at an obstacle; '
            f'{np.count_nonzero(free)} cells free, {clear:.2%} of them outside obstacles'
        )
        self.assertGreater(right, 0.95)
        self.assertGreater(clear, 0.99)
        self.assertGreater(np.count_nonzero(occupied), 200)
        self.assertGreater(np.count_nonzero(free), 3000)


if __name__ == '__main__':
    rospy.init_node('test_map_while_driving', disable_rostime=True)
    rostest.rosrun('rosbots_description', 'example_map', MapWhileDrivingTest, sys.argv)
