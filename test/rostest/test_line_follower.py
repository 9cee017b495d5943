#!/usr/bin/env python3
"""The example node follows the line of line.world by the camera's pictures, for one lap."""

import sys
from xml.etree import ElementTree

import numpy as np
import rospy
import rostest
from dynamic_reconfigure.client import Client
from example_nodes import WORLDS, ExampleNodeTest
from simulator import DEADLINE

FOLLOWER = '/line_follower'
INSIDE = 0.0, 1.2  # a point that the line goes round [m]
PICTURES = 10.0  # [Hz]
PICTURE = 100  # steps
# Of the axle's middle to that of the line, at most [m]. The camera is 0.04 m beside it, and sees a
# bend 0.7 m before the axle reaches it.
CLOSE = 0.15


def pieces():
    """Return the pieces of the line: arrays of centres (n, 2), directions (n, 2), lengths (n)."""
    visuals = list(ElementTree.parse(WORLDS / 'line.world').getroot().iter('visual'))
    pose = np.array([visual.findtext('pose').split() for visual in visuals], float)
    size = np.array([visual.findtext('.//size').split() for visual in visuals], float)
    return pose[:, :2], np.stack([np.cos(pose[:, 5]), np.sin(pose[:, 5])], axis=1), size[:, 0]


class LineFollowerTest(ExampleNodeTest):
    def laps(self):
        """Return how often the robot has gone round, counter-clockwise."""
        _, x, y = self.axle_track(every=50).T
        angles = np.unwrap(np.arctan2(y - INSIDE[1], x - INSIDE[0]))
        return (angles[-1] - angles[0]) / (2 * np.pi)

    def test_the_robot_follows_the_line_for_a_lap_and_stops_with_the_node(self):
        camera = Client('/camera1', DEADLINE)  # unthrottled, the simulator draws every picture
        camera.update_configuration({'imager_rate': PICTURES})
        self.drive(FOLLOWER, '/camera1/image_raw', PICTURE, lambda: self.laps() >= 1)
        self.kill_and_expect_rest(FOLLOWER)
        centres, directions, lengths = pieces()
        track = self.axle_track()[:, None, 1:] - centres
        along = np.clip(np.sum(track * directions, axis=2), -lengths / 2, lengths / 2)
        distances = np.hypot(*np.moveaxis(track - along[..., None] * directions, 2, 0))
        print(
            f'{self.laps():.2f} laps in {self.seconds():.1f} s, '
            f'at most {distances.min(axis=1).max():.3f} m from the line'
        )
        self.assertLess(distances.min(axis=1).max(), CLOSE)
        self.assertEqual(set(distances.argmin(axis=1)), set(range(len(centres))))


if __name__ == '__main__':
    rospy.init_node('test_line_follower', disable_rostime=True)
    rostest.rosrun('rosbots_description', 'example_line_follower', LineFollowerTest, sys.argv)
