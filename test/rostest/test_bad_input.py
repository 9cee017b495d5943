"""Other robots drive on beside irregular models, plugins, topics and commands.

Descriptions, names and numbers that are rejected are in test_hostile.py.
"""

import math

import rospy
from gazebo_msgs.srv import GetLinkState, GetModelProperties
from nav_msgs.msg import Odometry
from rosgraph_msgs.msg import Clock
from simulator import BOX, SimulatorTest, pose, proxy, topics_of, wait_until

MASSLESS = (
    '<link name="ghost"/><joint name="j" type="continuous"><parent link="body"/>'
    '<child link="ghost"/></joint>'
)
REFUSED = (  # unclosed, without a mass, without a link
    '<robot name="bad"><link name="a">',
    '<robot name="bad"><link name="a"/></robot>',
    '<robot name="bad"/>',
)


class BadInputTest(SimulatorTest):
    """During every invalid request a robot drives, and continues."""

    def setUp(self):
        super().setUp()
        self.spawn('neighbour', at=pose(y=5.0))
        self._drive = self.driver()
        self._drive(0.3)
        wait_until(lambda: self.x_of('neighbour') > 0.05, 'motion of the neighbour')

    def _assert_neighbour_drives(self):
        here = self.x_of('neighbour')
        wait_until(lambda: self.x_of('neighbour') > here + 0.02, 'motion of the neighbour')

    def test_failing_spawn_while_paused_is_answered_without_a_step(self):
        self.pause()
        before = self.world().sim_time
        for xml in REFUSED:
            self.assertFalse(self.spawn('bad', xml).success)
        self.assertEqual(self.world().sim_time, before)
        self.assertEqual(self.world().model_names, ['ground_plane', 'neighbour'])
        self.unpause()
        self._assert_neighbour_drives()

    def test_irregular_models_accepted_by_gazebo_are_spawned(self):
        self.assertTrue(
            self.spawn('half', BOX.replace('</robot>', f'{MASSLESS}</robot>'), pose(x=5.0)).success
        )
        properties = proxy('get_model_properties', GetModelProperties)('half')
        self.assertEqual((properties.body_names, properties.joint_names), (['body'], []))
        unturnable = BOX.replace('ixx="1" iyy="1" izz="1"', 'ixx="0" iyy="0" izz="0"')
        self.assertTrue(self.spawn('stiff', unturnable, pose(x=8.0, z=1.0)).success)
        wait_until(lambda: self.model_state('stiff', '').pose.position.z < 0.502, 'the box at rest')
        self._assert_neighbour_drives()

    def test_reduced_link_is_not_found(self):
        link_state = proxy('get_link_state', GetLinkState)
        for name in ('base_link', 'neighbour::base_link', 'caster'):
            response = link_state(name, '')
            self.assertEqual(
                (response.success, response.status_message),
                (
                    False,
                    'GetLinkState: link not found, did you forget to scope the link by model name?',
                ),
            )
        self.assertTrue(link_state('neighbour::base_footprint', '').success)

    def test_invalid_topics_are_left_out(self):
        before, clock = topics_of(), self.collect('/clock', Clock)
        self.assertTrue(self.spawn('spaced', at=pose(y=10.0), namespace='a b').success)
        self.assertEqual(topics_of(), before)
        xml = rospy.get_param('robot_description').replace('>odom<', '>/clock<', 1)
        self.assertIn('<odometryTopic>/clock<', xml)
        self.assertTrue(self.spawn('loud', xml, pose(y=15.0), namespace='/loud').success)
        self.assertEqual(topics_of(), before | {'/loud/joint_states'})
        count = len(clock)
        wait_until(lambda: len(clock) > count + 100, 'advance of time')
        times = [message.clock.to_nsec() for message in list(clock)]
        self.assertEqual(times, sorted(times))
        self._assert_neighbour_drives()

    def test_command_that_is_not_finite_is_dropped_and_the_last_one_kept(self):
        odometry = self.collect('/odom', Odometry)
        wait_until(lambda: odometry and odometry[-1].twist.twist.linear.x > 0.25, 'full speed')
        for bad in (math.nan, math.inf, -math.inf):
            self._drive(bad)
            self._drive(0.3, bad)
        odometry.clear()
        wait_until(lambda: len(odometry) > 50, 'half a second of driving')
        self.assertTrue(all(m.twist.twist.linear.x > 0.2 for m in odometry))
        self._drive(0.0)
        wait_until(lambda: abs(odometry[-1].twist.twist.linear.x) < 0.01, 'a stop')
