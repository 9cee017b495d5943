"""What the tests of the example nodes share: the robot's true track, and its rest at the end."""

import unittest
from pathlib import Path

import numpy as np
import rosnode
import rospy
from gazebo_msgs.srv import GetPhysicsProperties, SetPhysicsProperties
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from rosbots_msgs.srv import Step
from simulator import COMMANDS, hears, proxy, sends, wait_until
from std_srvs.srv import Empty

WORLDS = Path(__file__).resolve().parents[2] / 'src' / 'rosbots_description' / 'worlds'
AXLE = 0.15, 0.0725  # middle of the axle in base_footprint [m]
LIMIT = 600.0  # [s, wall] for what takes a tenth of it on an idle machine
REAL_TIME = 1000.0  # steps of 1 ms per second
AT_REST, MOVING = 0.01, 0.1  # [m/s], [rad/s]


class ExampleNodeTest(unittest.TestCase):
    """Records the robot's track while a node drives it."""

    def setUp(self):
        self.track = []  # (time [s], x, y [m], yaw [rad]) of base_footprint in the world
        self.is_tracked = True
        self.speed = np.inf  # [m/s] or [rad/s], whichever is more
        odometry = rospy.Subscriber('/odom', Odometry, self._record, tcp_nodelay=True)
        wait_until(lambda: hears(odometry), 'the robot', LIMIT)

    def _record(self, odometry):
        pose, twist = odometry.pose.pose, odometry.twist.twist
        if self.is_tracked:
            self.track.append(
                (
                    odometry.header.stamp.to_sec(),
                    pose.position.x,
                    pose.position.y,
                    2 * np.arctan2(pose.orientation.z, pose.orientation.w),
                )
            )
        self.speed = max(abs(twist.linear.x), abs(twist.angular.z))

    def limit_rate(self, rate):
        """Let the simulator make at most so many steps per second; 0 is as many as it can."""
        now = proxy('get_physics_properties', GetPhysicsProperties)()
        done = proxy('set_physics_properties', SetPhysicsProperties)(
            now.time_step, rate, now.gravity, now.ode_config
        )
        self.assertTrue(done.success)

    def drive(self, node, topic, steps, is_over):
        """Let a node drive that answers each message of a topic, every so many steps, by a command.

        Physics is paused from the start, and time waits for each answer: a late node would not
        steer in time on a busy machine.
        """
        commands = []
        subscriber = rospy.Subscriber(COMMANDS, Twist, commands.append)
        wait_until(
            lambda: (
                sends('/gazebo', topic, node)
                and sends(node, COMMANDS, '/gazebo')
                and hears(subscriber, node)
            ),
            f'{node} to be connected',
            LIMIT,
        )
        step = proxy('step', Step)
        while not (self.track and is_over()):
            heard = len(commands)
            self.assertTrue(step(steps).success)
            wait_until(lambda heard=heard: len(commands) > heard, 'a command', LIMIT)
        subscriber.unregister()
        self.is_tracked = False
        proxy('unpause_physics', Empty)()

    def seconds(self):
        """Return how long the track is [s], simulated time."""
        return self.track[-1][0] - self.track[0][0]

    def axle_track(self, every=1):
        """Return every nth point of the track of the axle's middle, as (time [s], x, y [m])."""
        time, x, y, yaw = np.array(self.track[::every]).T
        cos, sin = np.cos(yaw), np.sin(yaw)
        return np.stack(
            [time, x + AXLE[0] * cos - AXLE[1] * sin, y + AXLE[0] * sin + AXLE[1] * cos], axis=1
        )

    def kill_and_expect_rest(self, node):
        """Stop a node as rosnode kill does; the robot must not drive on."""
        self.limit_rate(REAL_TIME)  # so that it does not get far meanwhile
        wait_until(lambda: self.speed > MOVING, 'the robot moving')
        self.assertEqual(rosnode.kill_nodes([node]), ([node], []))
        wait_until(lambda: self.speed < AT_REST, 'the robot stopping')
