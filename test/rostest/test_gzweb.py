"""The browser's window looks only when it is looked at, and acts by the simulator's services."""

import math
import re
import signal
import sys
import unittest
from pathlib import Path
from urllib.parse import urlsplit

import rospy
from gazebo_msgs.srv import (
    DeleteModel,
    GetJointProperties,
    GetLinkProperties,
    GetModelState,
    GetPhysicsProperties,
    GetWorldProperties,
    SpawnModel,
)
from geometry_msgs.msg import PoseStamped, TransformStamped, Twist
from nav_msgs.msg import OccupancyGrid
from programs import find_program
from rosbots_msgs.srv import GetFriction
from sensor_msgs.msg import LaserScan
from server_process import ServerProcess
from simulator import page_address, pose, proxy, wait_until
from terminal import Terminal
from tf2_msgs.msg import TFMessage

sys.path.append(str(Path(__file__).resolve().parents[1]))
from support.browser import Browser

START = 90.0  # [s, wall] for a program
TOPICS = {'/gazebo/view/scene', '/gazebo/view/motion'}
BALL = """<robot name="ball"><link name="body">
  <inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
  <visual><geometry><sphere radius="0.5"/></geometry></visual>
  <collision><geometry><sphere radius="0.5"/></geometry></collision>
</link></robot>"""
ARM = """<robot name="arm"><link name="world"/><link name="body">
  <inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
</link><joint name="hinge" type="continuous">
  <parent link="world"/><child link="body"/><axis xyz="0 0 1"/></joint></robot>"""
LINK = '/models/ball/body'
UPLOAD = 'Upload URDF, xacro or SDF'


def subscribed():
    """Return the topics that the window subscribes to."""
    _, readers, _ = rospy.get_master().getSystemState()[2]
    return {topic for topic, nodes in readers if '/gzweb' in nodes}


def pace():
    now = proxy('get_physics_properties', GetPhysicsProperties)()
    return now.time_step * now.max_update_rate


class GzwebTest(unittest.TestCase):
    def open(self, *arguments):
        window = Terminal(find_program('gazebo_ros', 'gzweb'), *arguments)
        self.addCleanup(window.close)
        return window

    def test_world_is_shown_and_controlled(self):
        window = self.open('--port', '0')
        with ServerProcess() as server:
            server.wait_ready()
            address = page_address(window.shown, START)
            self.assertEqual(subscribed(), set())  # not even to /clock
            with Browser(address) as browser:
                browser.wait_until(lambda: '/models/ground_plane/link' in browser.nodes)
                self.assertEqual(subscribed(), TOPICS)
                self.follow_a_ball(browser)
                self.control_time(browser)
                self.drive(browser)
                self.turn_a_joint(browser)
                self.change_a_ball(browser)
                self.show_contacts(browser)
                self.edit(browser)
                self.sense(browser)
                self.navigate(browser)
                server.process.kill()
                browser.wait_until(
                    lambda: any('does not answer' in text for text in browser.texts())
                )
            wait_until(lambda: subscribed() == set(), 'the window to look no more')
        with ServerProcess() as server, Browser(address) as browser:
            server.wait_ready()
            browser.wait_until(lambda: '/models/ground_plane/link' in browser.nodes)
            browser.wait_until(lambda: LINK not in browser.nodes)  # of the one before
            browser.wait_until(
                lambda: not any('does not answer' in text for text in browser.texts())
            )
        window.process.send_signal(signal.SIGINT)
        wait_until(lambda: window.process.poll() is not None, 'the end')
        self.assertEqual(window.process.returncode, 0)
        # It said both addresses, and what the simulator refused.
        said = re.sub(r'\x1b\[\d*m', '', window.shown()).split('\r\n')[2:]
        refused = [line for line in said if line]
        self.assertEqual(len(refused), 2, refused)
        self.assertIn('mass is -1.0', refused[0])
        self.assertIn('InsertModel: Failure - model_xml, line 5', refused[1])

    def follow_a_ball(self, browser):
        spawned = proxy('spawn_urdf_model', SpawnModel)('ball', BALL, '', pose(z=3.0), '')
        self.assertTrue(spawned.success, spawned.status_message)
        browser.wait_until(lambda: LINK in browser.nodes)
        browser.wait_until(lambda: abs(browser.nodes[LINK][1][2] - 0.5) < 0.01)  # it has fallen

    def control_time(self, browser):
        time = proxy('get_world_properties', GetWorldProperties)
        browser.click('Pause')
        browser.wait_until(lambda: browser.control('Play'))
        before = time().sim_time
        browser.choose('Steps', 7)
        browser.click('Step')
        browser.wait_until(lambda: time().sim_time > before + 0.0065)
        self.assertAlmostEqual(time().sim_time, before + 0.007, places=9)
        browser.click('Reset world')
        browser.wait_until(lambda: browser.nodes[LINK][1][2] == 3.0)
        self.assertAlmostEqual(time().sim_time, before + 0.007, places=9)
        browser.click('Reset time and world')
        browser.wait_until(lambda: time().sim_time == 0.0)
        browser.choose('Speed', '10x')
        browser.wait_until(lambda: abs(pace() - 10.0) < 1e-9)
        browser.click('Play')
        browser.wait_until(lambda: time().sim_time > 0.1)
        proxy('delete_model', DeleteModel)('ball')
        browser.wait_until(lambda: LINK not in browser.nodes)
        proxy('spawn_urdf_model', SpawnModel)('ball', BALL, '', pose(z=3.0), '')
        browser.wait_until(lambda: LINK in browser.nodes)

    def drive(self, browser):
        commands = []
        subscriber = rospy.Subscriber('/robot/cmd_vel', Twist, commands.append)
        browser.wait_until(
            lambda: any(
                '/robot/cmd_vel' in props.get('options', ())
                for _, props in browser.controls.values()
            )
        )
        browser.press('I')
        browser.wait_until(lambda: len(commands) == 2)
        self.assertEqual(
            [(one.linear.x, one.angular.z) for one in commands], [(0.5, 0.0), (0.0, 0.0)]
        )
        subscriber.unregister()

    def change_a_ball(self, browser):
        browser.click('ball')
        browser.wait_until(lambda: f'{LINK}/selected' in browser.nodes)
        browser.wait_until(lambda: '/gizmo' in browser.nodes)  # made after the fields are filled in
        browser.choose('Position [m]', [2.0, 1.0, 4.0])
        browser.click('Set pose')
        browser.wait_until(lambda: browser.nodes[LINK][1][:2] == [2.0, 1.0])
        browser.wait_until(lambda: '2.000' in browser.tables())  # by get_model_state
        browser.choose('Mass [kg]', 2.5)
        browser.click('Set mass')
        properties = proxy('get_link_properties', GetLinkProperties)
        browser.wait_until(lambda: properties('ball::body').mass == 2.5)
        self.assertEqual(properties('ball::body').ixx, 2.5)
        browser.choose('mu', 0.25)
        browser.click('Set friction')
        friction = proxy('get_friction', GetFriction)
        browser.wait_until(lambda: friction('ball').mu == (0.25,))
        browser.choose('Mass [kg]', -1.0)
        browser.click('Set mass')
        browser.wait_until(lambda: any('mass is -1.0; link' in note for note in browser.notes()))

    def show_contacts(self, browser):
        browser.choose('Contacts and forces', True)
        browser.wait_until(lambda: '/contacts/forces' in browser.nodes)
        self.assertEqual(subscribed(), TOPICS | {'/gazebo/view/contacts'})
        browser.choose('Contacts and forces', False)
        browser.wait_until(lambda: subscribed() == TOPICS)

    def edit(self, browser):
        """Insert, upload, move, delete and undo, on the ground beside the ball."""
        state = proxy('get_model_state', GetModelState)
        browser.look_at([2.0, 3.0, 1.0])
        browser.click('Insert shape')
        browser.wait_until(lambda: '/models/box/link' in browser.nodes)
        browser.wait_until(lambda: browser.control("Undo: insert 'box'"))  # and it is selected
        at = state('box', '').pose.position
        for found, wanted in ((at.x, 2.0), (at.y, 3.0), (at.z, 0.25)):
            self.assertAlmostEqual(found, wanted, places=3)
        browser.upload(UPLOAD, 'bad.urdf', BALL.replace('</link>', '').encode())
        browser.wait_until(
            lambda: any(
                note.startswith('InsertModel: Failure - model_xml, line 5')
                for note in browser.notes()
            )
        )
        browser.upload(UPLOAD, 'ball.urdf', BALL.encode())  # another one is there
        browser.wait_until(lambda: '/models/ball_0/body' in browser.nodes)
        browser.wait_until(lambda: browser.control("Undo: insert 'ball_0'"))
        ball = state('ball_0', '').pose.position
        self.assertGreater(ball.z, 0.49)
        self.wait_for_gizmo(browser, ball)  # the newest is selected
        browser.click_node('/models/box/link/0 visual')
        self.wait_for_gizmo(browser, at)
        browser.grab('/gizmo')
        browser.drag('/gizmo', [-3.0, 1.0, 2.0])
        browser.wait_until(lambda: abs(state('box', '').pose.position.z - 2.0) < 0.01)
        browser.let_go('/gizmo')
        browser.wait_until(lambda: browser.control("Undo: move 'box'"))
        browser.wait_until(lambda: state('box', '').pose.position.z < 0.3)  # it falls
        browser.click('Delete')
        browser.wait_until(lambda: '/models/box/link' not in browser.nodes)
        browser.click("Undo: delete 'box'")
        browser.wait_until(lambda: browser.control("Undo: move 'box'"))
        browser.click("Undo: move 'box'")
        browser.wait_until(lambda: abs(state('box', '').pose.position.x - 2.0) < 0.01)
        browser.click('Insert light')
        browser.wait_until(lambda: browser.control("Undo: insert 'light'"))
        browser.wait_until(lambda: '/lights/light' in browser.nodes)
        browser.click("Undo: insert 'light'")  # an error in the log would fail this file
        browser.wait_until(lambda: '/lights/light' not in browser.nodes)

    def wait_for_gizmo(self, browser, point):
        x, y = point.x, point.y
        browser.wait_until(
            lambda: (
                '/gizmo' in browser.nodes
                and math.dist(browser.nodes['/gizmo'][1][:2], (x, y)) < 0.01
            )
        )

    def turn_a_joint(self, browser):
        hinge = proxy('get_joint_properties', GetJointProperties)
        proxy('spawn_urdf_model', SpawnModel)('arm', ARM, '', pose(), '')
        browser.wait_until(
            lambda: (
                browser.control('Of')
                and 'arm' in browser.controls[browser.control('Of')][1]['options']
            )
        )
        browser.choose('Of', 'arm')
        browser.wait_until(lambda: browser.control('hinge [rad]'))
        browser.choose('hinge [rad]', 0.5)
        browser.wait_until(lambda: abs(hinge('arm::hinge').position[0] - 0.5) < 1e-6)
        for what, label, rate in (
            ('velocity', 'hinge [rad/s]', 1.9),
            ('effort', 'hinge [N m]', 3.0),
        ):
            browser.choose('Sliders set', what)
            browser.wait_until(lambda label=label: browser.control(label))
            before = browser.control(label)
            browser.choose(label, 2.0)
            browser.wait_until(lambda rate=rate: hinge('arm::hinge').rate[0] > rate)
            browser.click('Release')
            browser.wait_until(
                lambda label=label, before=before: browser.control(label) not in (None, before)
            )
        proxy('delete_model', DeleteModel)('arm')

    def sense(self, browser):
        """Show a scan of a frame on the ball, and leave it shown."""
        placed = TransformStamped(child_frame_id='lens')
        placed.header.frame_id = 'ball/body'  # there is another body
        placed.transform.translation.x, placed.transform.rotation.w = 2.0, 1.0
        frames = rospy.Publisher('/tf_static', TFMessage, latch=True, queue_size=1)
        frames.publish(TFMessage([placed]))
        scans = rospy.Publisher('/scan', LaserScan, latch=True, queue_size=1)
        scan = LaserScan(range_max=9.0, ranges=[1.0])
        scan.header.frame_id = 'lens'
        scans.publish(scan)
        browser.wait_until(lambda: browser.control('/scan'))
        self.assertEqual(subscribed(), TOPICS)  # it has not been asked for
        browser.choose('/scan', True)
        sensor = '/readings/\u2215scan'
        browser.wait_until(lambda: f'{sensor}/points' in browser.nodes)
        ball, lens = browser.nodes[LINK][1], browser.nodes[sensor][1]
        self.assertAlmostEqual(math.dist(ball, lens), 2.0, places=3)
        browser.wait_until(lambda: subscribed() == TOPICS | {'/scan'})  # TF is no longer needed

    def navigate(self, browser):
        """Show a map of a frame beside the ball, and set a goal in it; and show the true map."""
        ball = browser.nodes[LINK][1]
        placed = TransformStamped(child_frame_id='ball/body')
        placed.header.frame_id = 'map'
        placed.transform.translation.x, placed.transform.rotation.w = 4.0, 1.0
        frames = rospy.Publisher('/tf', TFMessage, latch=True, queue_size=1)
        frames.publish(TFMessage([placed]))
        maps = rospy.Publisher('/map', OccupancyGrid, latch=True, queue_size=1)
        grid = OccupancyGrid(data=[0, 100, -1, 0])
        grid.header.frame_id = 'map'
        grid.info.width = grid.info.height = 2
        grid.info.resolution, grid.info.origin.orientation.w = 0.5, 1.0
        maps.publish(grid)
        goals = []
        self.addCleanup(
            rospy.Subscriber('/move_base_simple/goal', PoseStamped, goals.append).unregister
        )
        browser.wait_until(lambda: browser.control('/map'))
        browser.choose('/map', True)
        node = '/readings/\u2215map'
        browser.wait_until(lambda: f'{node}/grid' in browser.nodes)
        origin = ball[0] - 4.0, ball[1]
        browser.wait_until(lambda: math.dist(browser.nodes[node][1][:2], origin) < 1e-3)
        browser.wait_until(lambda: browser.control('2D Nav Goal'))
        browser.click('2D Nav Goal')
        for sentence, along in (('click on the ground', 1.0), ('Now click', 2.0)):
            browser.wait_until(
                lambda sentence=sentence: any(sentence in note for note in browser.notes())
            )
            browser.click_ray([origin[0] + along, origin[1], 5.0], [0.0, 0.0, -1.0])
        browser.wait_until(lambda: goals)
        self.assertEqual(goals[0].header.frame_id, 'map')
        self.assertAlmostEqual(goals[0].pose.position.x, 1.0, places=3)
        self.assertAlmostEqual(goals[0].pose.orientation.w, 1.0, places=3)
        browser.choose('true map', True)
        browser.wait_until(lambda: '/readings/true map/grid' in browser.nodes)

    def test_two_browsers_each_have_a_selection_of_their_own(self):
        window = self.open('--port', '0')
        with ServerProcess() as server, Browser(page_address(window.shown, START)) as first:
            server.wait_ready()
            for number, name in enumerate(('ball', 'globe', 'marble')):
                spawned = proxy('spawn_urdf_model', SpawnModel)(
                    name, BALL.replace('"ball"', f'"{name}"'), '', pose(2.0 * number, z=0.5), ''
                )
                self.assertTrue(spawned.success, spawned.status_message)
            with Browser(first.address) as second:
                for browser, name in ((first, 'ball'), (second, 'globe')):
                    browser.click(name)
                    browser.wait_until(
                        lambda browser=browser, name=name: f'<b>{name}</b>' in browser.tables()
                    )
                self.assertEqual(self.selected(first), {'/models/ball/body/selected'})
                second.wait_until(
                    lambda: '/gizmo' in second.nodes
                )  # after the fields are filled in
                second.choose('Mass [kg]', 2.5)
                second.click('Set mass')
                mass = proxy('get_link_properties', GetLinkProperties)
                second.wait_until(lambda: mass('globe::body').mass == 2.5)
                self.assertEqual(mass('ball::body').mass, 1.0)
                first.press('delete')
                second.wait_until(lambda: '/models/ball/body' not in second.nodes)
                first.wait_until(lambda: self.selected(first) == set())
                self.assertEqual(self.selected(second), {'/models/globe/body/selected'})
                second.click('Pause')
                first.wait_until(lambda: first.control('Play'))  # time is that of all
            first.click('marble')
            first.wait_until(lambda: self.selected(first) == {'/models/marble/body/selected'})
            first.press('delete')
            first.wait_until(lambda: '/models/marble/body' not in first.nodes)
            self.assertIn('/models/globe/body', first.nodes)

    def selected(self, browser):
        return {name for name in browser.nodes if name.endswith('/selected')}

    def test_port_in_use_is_told_in_a_sentence(self):
        first = self.open('--port', '0')
        port = urlsplit(page_address(first.shown, START)).port
        second = self.open('--port', str(port))
        wait_until(lambda: second.process.poll() is not None, 'the end', START)
        self.assertEqual(second.process.returncode, 1)
        self.assertEqual(
            second.shown(),
            f'gzweb: no window at 127.0.0.1, port {port}: Address '
            'already in use; web_port and web_host choose others\r\n',
        )
