#!/usr/bin/env python3
"""Follow a yellow line: find it in the camera's picture and steer towards its middle.

Publishes:
    cmd_vel (geometry_msgs/Twist): forward speed and rate of turn.
Subscribes:
    image (sensor_msgs/Image): the road ahead; encoding rgb8 or bgr8.
Parameters:
    ~top: rows above this share of the picture's height are not looked at, 0 to 1.
    ~speed: forward speed on a straight line [m/s]; half of it with the line at the edge.
    ~gain: curvature of the path with the line at the edge [1/m]. It is 2 w / d^2 if the rows show
        the ground d [m] ahead of the axle, and w [m] to each side (pure pursuit).
"""

import numpy as np
import rospy
from geometry_msgs.msg import Twist
from sensor_msgs.msg import Image

from rosbots_description.ros_api.clients.node_program import run_node

FEWEST = 20  # yellow pixels that are a line
SEARCH = 0.4  # rate of turn while there is no line [rad/s]


def pixels_of(image):
    """Return the pixels of an Image, height x width x (red, green, blue), 0 to 255."""
    rows = np.frombuffer(image.data, np.uint8).reshape(image.height, image.step)
    pixels = rows[:, : 3 * image.width].reshape(image.height, image.width, 3)
    return pixels if image.encoding == 'rgb8' else pixels[:, :, ::-1]


def line_offset(pixels, top):
    """Return where the line is, from -1 (left edge) to 1 (right edge), or None without a line.

    Yellow is much red and green, and little blue. Only rows below the share `top` are looked at.
    """
    red, green, blue = np.moveaxis(pixels[int(top * len(pixels)) :].astype(int), 2, 0)
    yellow = (np.minimum(red, green) > 80) & (2 * blue < np.minimum(red, green))
    columns = np.nonzero(yellow)[1]
    if len(columns) < FEWEST:
        return None
    return 2 * columns.mean() / (pixels.shape[1] - 1) - 1


def steer(offset, last, speed, gain):
    """Return the command (forward [m/s], turn [rad/s]) for the offset of the line.

    Without a line (None) turn on the spot to the side where it was last.
    """
    if offset is None:
        return 0.0, -SEARCH if last > 0 else SEARCH
    forward = speed * (1 - abs(offset) / 2)
    return forward, -gain * offset * forward


def main():
    """Answer each picture with a command; stop the robot when the node is stopped."""
    rospy.init_node('line_follower')
    top = rospy.get_param('~top', 0.75)
    speed, gain = rospy.get_param('~speed', 0.8), rospy.get_param('~gain', 1.2)
    commands = rospy.Publisher('cmd_vel', Twist, queue_size=1)
    rospy.on_shutdown(lambda: commands.publish(Twist()))
    rospy.on_shutdown(lambda: rospy.rostime.wallsleep(0.5))  # or it may get lost with the topic
    last = 0.0  # offset when the line was seen last

    def answer(image):
        nonlocal last
        offset = line_offset(pixels_of(image), top)
        command = Twist()
        command.linear.x, command.angular.z = steer(offset, last, speed, gain)
        if not rospy.core.is_shutdown_requested():  # otherwise the last word was to stop
            commands.publish(command)
        last = last if offset is None else offset

    rospy.Subscriber('image', Image, answer, queue_size=1, buff_size=2**24)
    rospy.spin()


if __name__ == '__main__':
    run_node(main)
