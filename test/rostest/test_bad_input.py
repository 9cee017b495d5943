#!/usr/bin/env python3
"""Invalid input is answered with Gazebo's text or an error message; other robots drive on."""

import math
import sys

import rospy
import rostest
from gazebo_msgs.srv import GetLinkState, GetModelProperties
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from rosgraph_msgs.msg import Clock
from simulator import BOX, COMMANDS, SimulatorTest, pose, proxy, topics_of, wait_until

LINK = (
    '<link name="{}"><inertial><mass value="1"/>'
    '<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>{}</link>'
)
MESH = '<collision><geometry><mesh filename="{}"/></geometry></collision>'


def robot(*parts):
    return f'<robot name="bad">{"".join(parts)}</robot>'


# Input, and words that the error message must contain: location, fault or cure.
REFUSED = {
    'unclosed tags': ('<robot name="bad"><link name="a">', ['line']),
    'mesh path out of its package': (
        robot(LINK.format('a', MESH.format('package://rosbots_description/%2e%2e/m.stl'))),
        ['leads out of package'],
    ),
    'crossed tags': ('<robot name="bad"><link name="a"></robot></link>', ['line']),
    'endless comment': (robot('<!-- ', LINK.format('a', '')), ['<!--', '-->']),
    'no inertial': (robot('<link name="a"/>'), ["'a'", '<inertial>']),
    'mass of zero': (robot(LINK.format('a', '').replace('value="1"', 'value="0"')), ['mass']),
    'no links': (robot(), ['link']),
    'unexpanded xacro': (
        '<robot name="bad" xmlns:xacro="http://ros.org/wiki/xacro"><xacro:wheel/></robot>',
        ['xacro'],
    ),
    'two roots': (robot(LINK.format('a', ''), LINK.format('b', '')), ['a', 'b']),
    'duplicate names': (robot(LINK.format('a', ''), LINK.format('a', '')), ["'a'"]),
    'joint to a missing link': (
        robot(
            LINK.format('a', ''),
            '<joint name="j" type="fixed"><parent link="a"/><child link="gone"/></joint>',
        ),
        ['gone'],
    ),
    'mass of nan': (robot(LINK.format('a', '').replace('value="1"', 'value="nan"')), ['nan']),
    'negative mass': (robot(LINK.format('a', '').replace('value="1"', 'value="-1"')), ['-1']),
}
CALL_ERRORS = {
    'text': ('hello world', 'entity format is invalid'),
    'nothing': ('', 'entity format is invalid'),
    'sdf': ('<sdf version="1.6"><model name="m"/></sdf>', 'entity format is invalid'),
    'unknown package': (
        robot(LINK.format('a', MESH.format('package://no_such_pkg/m.dae'))),
        'no_such_pkg',
    ),
}
UNKNOWN_JOINT = (
    '<gazebo><plugin name="d" filename="libgazebo_ros_diff_drive.so">'
    '<leftJoint>nojoint</leftJoint></plugin></gazebo>'
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

    def _assert_rejected(self, response, *words):
        self.assertFalse(response.success)
        self.assertTrue(response.status_message.startswith('SpawnModel: Failure - '))
        for word in words:
            self.assertIn(word, response.status_message)
        self.assertNotIn('\n', response.status_message)
        self.assertEqual(self.world().model_names, ['ground_plane', 'neighbour'])

    def test_descriptions_that_cannot_be_simulated_are_rejected(self):
        for case, (xml, words) in REFUSED.items():
            with self.subTest(case):
                self._assert_rejected(self.spawn('bad', xml), *words)
        self._assert_neighbour_drives()

    def test_other_texts_than_descriptions_are_rejected(self):
        for case, (xml, words) in CALL_ERRORS.items():
            with self.subTest(case):
                with self.assertRaises(rospy.ServiceException) as raised:
                    self.spawn('bad', xml)
                self.assertIn(words, str(raised.exception))
        self._assert_neighbour_drives()

    def test_failing_spawn_while_paused_is_answered_without_a_step(self):
        self.pause()
        before = self.world().sim_time
        for xml, words in REFUSED.values():
            self._assert_rejected(self.spawn('bad', xml), *words)
        self.assertEqual(self.world().sim_time, before)
        self.unpause()
        self._assert_neighbour_drives()

    def test_irregular_models_accepted_by_gazebo_are_spawned(self):
        massless = ''.join(
            (
                LINK.format('base', ''),
                '<link name="ghost"/>',
                '<joint name="j" type="continuous"><parent link="base"/><child '
                'link="ghost"/></joint>',
            )
        )
        self.assertTrue(self.spawn('half', robot(massless), pose(x=5.0)).success)
        properties = proxy('get_model_properties', GetModelProperties)('half')
        self.assertEqual((properties.body_names, properties.joint_names), (['base'], []))
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

    def test_empty_name_and_invalid_pose(self):
        self._assert_rejected(self.spawn('', BOX), 'name')
        self._assert_rejected(self.spawn('bad', BOX, pose(x=math.nan)), 'bad', 'not finite')
        self._assert_rejected(self.spawn('bad', BOX, pose(z=math.inf)), 'bad', 'not finite')
        self._assert_neighbour_drives()

    def test_model_is_spawned_without_a_failing_plugin(self):
        xml = BOX.replace('</robot>', UNKNOWN_JOINT + '</robot>')
        self.assertTrue(self.spawn('bad', xml).success)
        unknown = BOX.replace(
            '</robot>', '<gazebo><plugin name="n" filename="libnope.so"/></gazebo></robot>'
        )
        self.assertTrue(self.spawn('worse', unknown, pose(x=5.0)).success)
        self._assert_neighbour_drives()

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
        publisher = rospy.Publisher(COMMANDS, Twist, queue_size=1)
        wait_until(publisher.get_num_connections, 'a subscriber')
        self._drive(0.0)
        wait_until(lambda: abs(odometry[-1].twist.twist.linear.x) < 0.01, 'a stop')
        publisher.unregister()


if __name__ == '__main__':
    rospy.init_node('test_bad_input', disable_rostime=True)
    rostest.rosrun('rosbots_description', 'bad_input', BadInputTest, sys.argv)
