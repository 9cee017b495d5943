#!/usr/bin/env python3
"""Sixty hostile texts through every panel of the page in Chromium: each stays text.

They are names of models, links, joints, collisions, sensors, plugins, lights, topics, parameters,
folders and files, and texts in messages. The browser is told to ignore the page's content security
policy: whatever became markup would run and ask for what it wants. The host in the texts is a
server of this test, which nobody may ask for anything.
"""

import contextlib
import os
import re
import subprocess
import sys
import tempfile
import threading
import unittest
import warnings
from pathlib import Path
from xml.sax.saxutils import quoteattr

import rospy
import rostest
from gazebo_msgs.msg import ContactsState, ContactState
from gazebo_msgs.srv import DeleteLight, SpawnModel
from geometry_msgs.msg import Twist, Vector3
from programs import find_program
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys
from sensor_msgs.msg import Imu
from server_process import ServerProcess
from simulator import page_address, pose, proxy, wait_until
from std_msgs.msg import Float64

sys.path.append(str(Path(__file__).resolve().parents[1]))
sys.path.append(str(Path(__file__).resolve().parents[2] / 'tools'))
from chromium import chromium, clock, drawn, faults, opens_tab
from hostile_page import Listener, arm, body, recorded, topic, watch
from support.browser import Browser
from support.hostile_texts import HOST, MARK, TEXTS

from rosbots_description.web.controls import plain

SIZE = (1000, 700)  # [pixels]
# The scene is drawn with few pixels: it is not looked at, and slow without a graphics card.
QUERY = '&fixedDpr=0.1'
# How things move is not looked at either: few steps, and nothing falls.
WORLD = """<sdf version="1.6"><world name="default"><gravity>0 0 0</gravity>
  <physics type="ode"><max_step_size>0.01</max_step_size>
    <real_time_update_rate>100</real_time_update_rate></physics>
  <include><uri>model://ground_plane</uri></include><scene><shadows>0</shadows></scene>
</world></sdf>"""
UPLOAD = 'Upload URDF, xacro or SDF'
REFUSED = '<b\tclass=evil>tab'  # as a name of a model, which has no control characters
NAMES = [text for text in TEXTS if text != REFUSED]
# Models and files are named by three texts: so many names and notifications are faster to show.
GROUPS = [TEXTS[begin : begin + 3] for begin in range(0, len(TEXTS), 3)]
MODELS = {''.join(group): group[0] for group in GROUPS if REFUSED not in group}  # and their links
SLIDERS, CURVES = 40, 20  # at once
CONTROLLERS = 'topics of controllers'
LIGHT = '<sdf version="1.6"><light name={} type="point"><diffuse>0 0 0 1</diffuse></light></sdf>'
HAS_RUN = f'return "{MARK}" in window'
# A refresh would be followed, whatever the policy is.
INSERT = """for (const text of arguments[0])
  document.body.appendChild(document.createElement('div')).innerHTML = text"""
MARKUP = [text for text in TEXTS if text.startswith('<') and 'refresh' not in text]
MOST_OF_THEM = 25
CLOSE = "document.querySelectorAll('.mantine-Notification-closeButton').forEach(one => one.click())"
# The texts of a list, some of which are not on the page, notifications and open lists included.
MISSING = """const shown = document.body.textContent.replace(/\\s/g, ' ');
return arguments[0].filter(text => !shown.includes(text.replace(/\\s/g, ' ')))"""


CLICK = """const wanted = arguments[1].replace(/\\s/g, ' ');
const found = [...document.querySelectorAll(arguments[0])].find(
  one => one.offsetParent && one.textContent.replace(/\\s/g, ' ') === wanted);
if (found) found.click();
return Boolean(found)"""
SEND_FILE = """const field = document.querySelector('input[type=file]'), files = new DataTransfer();
files.items.add(new File([new Uint8Array(arguments[1])], arguments[0]));
field.files = files.files;
field.dispatchEvent(new Event('change', {bubbles: true}))"""


class HostileNamesTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        warnings.simplefilter('ignore', UserWarning)  # rospy's, of the names of topics
        folder = Path(cls.enterClassContext(tempfile.TemporaryDirectory()))
        cls.folder = folder
        cls.folders = [text for text in TEXTS if '/' not in text]
        for name in cls.folders:
            (folder / 'models' / name).mkdir(parents=True)
            (folder / 'models' / name / 'model.config').write_text(
                '<model><sdf>model.sdf</sdf></model>'
            )
        world = folder / 'flat.world'
        world.write_text(WORLD)
        path = f'{folder / "models"}:{os.environ.get("GAZEBO_MODEL_PATH", "")}'
        cls.server = cls.enterClassContext(ServerProcess(str(world), GAZEBO_MODEL_PATH=path))
        cls.server.wait_ready()
        cls.spawn_all()
        # What both print is read, or written to a file: a full pipe would stop them.
        threading.Thread(target=cls.server.process.stdout.read, daemon=True).start()
        log = folder / 'gzweb.log'
        log.touch(mode=0o600)  # else it gets no token
        with log.open('wb') as output:
            window = subprocess.Popen(
                [find_program('gazebo_ros', 'gzweb'), '--port', '0'], stdout=output, stderr=output
            )
        cls.addClassCleanup(window.wait)
        cls.addClassCleanup(window.kill)
        cls.address = page_address(log.read_text)
        cls.listener = Listener()
        cls.addClassCleanup(cls.listener.close)
        here = f'127.0.0.1:{cls.listener.port}'
        cls.driver = cls.enterClassContext(
            chromium(SIZE, f'--host-resolver-rules=MAP {HOST} {here}, MAP *.{HOST} {here}')
        )
        watch(cls.driver)
        cls.driver.get(cls.address + QUERY)
        wait_until(lambda: clock(cls.driver), 'the page')

    @classmethod
    def spawn_all(cls):
        """Spawn two models with all names in them, and those that are named so themselves."""
        spawn = proxy('spawn_urdf_model', SpawnModel)
        cls.arms = {'arm 1': NAMES[::2], 'arm 2': NAMES[1::2]}
        texts = {name: arm(names) for name, names in cls.arms.items()} | {
            name: body(name, of_link) for name, of_link in MODELS.items()
        }
        for number, (name, text) in enumerate(texts.items()):
            answer = spawn(name, text, '', pose(2.0 * (number % 8), 2.0 * (number // 8), 0.1), '')
            assert answer.success, answer.status_message

    makes_markup = False

    def setUp(self):
        self.hand = self.enterContext(Browser(self.address))
        self.wait(
            lambda: (
                self.hand.control(UPLOAD)
                and any(  # it is one of the page's browsers
                    one['type'] == 'SetCameraPositionMessage' for one in self.hand.messages
                )
            ),
            'the page',
        )
        self.driver.find_element(By.TAG_NAME, 'body').send_keys(Keys.ESCAPE)  # select nothing
        self.wait(lambda: self.driver.execute_script(MISSING, ['\u2514 ']), 'no link listed')

    def tearDown(self):
        self.assertEqual(self.driver.execute_script('return foreign'), [])
        self.assertFalse(self.driver.execute_script(HAS_RUN))
        self.assertEqual(self.listener.connections, 0)
        errors = faults(self.driver)
        self.assertEqual([] if self.makes_markup else errors, [])
        self.assertTrue(clock(self.driver))  # the page still works

    def rows(self, begin):
        """Return the buttons that can be seen and begin so, by their labels."""
        return {
            props['label']: uuid
            for uuid, (kind, props) in self.hand.controls.items()
            if kind == 'GuiButtonMessage'
            and props.get('visible', True)
            and props['label'].startswith(begin)
        }

    def click(self, selector, text):
        """Click on the element with a text, when the page shows it."""
        self.wait(lambda: self.driver.execute_script(CLICK, selector, text), f'{text} on the page')

    def choose(self, label, text):
        """Choose from a list of the page."""
        self.toggle(self.field(label))
        self.click('[role=option]', text)

    def toggle(self, field):
        """Open or close the list of a field, whatever notice or open list is in front of it."""
        self.driver.execute_script('arguments[0].click()', field)

    def field(self, label):
        """Return the field of the page with a label, when it can be seen."""
        fields = []

        def found():
            fields[:] = [
                one
                for one in self.driver.find_elements(
                    By.XPATH, f'//label[normalize-space()="{label}"]/following::input[1]'
                )
                if one.is_displayed()
            ]
            return fields

        self.wait(found, label)
        return fields[0]

    def select(self, model, link=None):
        """Click on a model in the list, and on one of its links."""
        self.click('button', plain(model))
        if link is not None:
            self.click('button', f'\u2514 {plain(link)}')

    def press(self, label):
        """Press a button when it can be seen; hidden ones may have had that label."""
        self.wait(lambda: label in self.rows(label), f'{label} in the list')
        self.hand.send(
            {
                'type': 'GuiUpdateMessage',
                'uuid': self.rows(label)[label],
                'updates': {'value': True},
            }
        )

    def wait(self, condition, what):
        """Wait for a condition, while the other connection to the page is read."""
        wait_until(lambda: self.hand.read(0.01) or condition(), what)

    def wait_shown(self, *texts, said=plain):
        """Wait until all texts are on the page as text, as the page writes them."""
        wanted, missing = [said(text) for text in texts], []

        def shown():
            missing[:] = self.driver.execute_script(MISSING, wanted)
            return not missing

        try:
            self.wait(shown, 'texts')
        except AssertionError:
            raise AssertionError(f'not on the page: {missing}') from None

    def wait_offered(self, label, names):
        """Wait until a list has all names, and that they are shown when it is open."""
        names = [plain(name) for name in names]
        self.wait(lambda: set(names) <= set(self.options(label)), f'the list of {label}')
        field = self.field(label)
        self.toggle(field)
        try:
            self.wait_shown(*names, said=str)
        finally:
            self.toggle(field)

    def options(self, label):
        """Return what can be chosen in a field."""
        return [
            one
            for kind, props in self.hand.controls.values()
            if props.get('label') == label and kind == 'GuiDropdownMessage'
            for one in props['options']
        ]

    def open_tab(self, name):
        self.wait(lambda: opens_tab(self.driver, name), f'the tab {name}')

    def test_models_and_their_links(self):
        self.open_tab('Models')
        self.wait_shown(*MODELS)
        for model, of_link in MODELS.items():
            self.select(model, of_link)
            self.wait_shown(f'{model}::{of_link}', f'\u2514 {of_link}')

    def test_parts_of_models(self):
        self.open_tab('Models')
        for name, texts in self.arms.items():
            self.select(name)
            self.wait_shown(
                *(f'{text}: revolute, ' for text in texts),
                *(f'\u2514 {text}' for text in texts),
                *(f'{text}_collision' for text in texts),
                *(f'{text} imu: imu' for text in texts),
                *(
                    f"{what} '{text[:40]}"
                    for what in ('plugin', 'sonar')  # not spawned with it
                    for text in texts
                    if text.isprintable()
                ),
            )

    def test_what_is_edited(self):
        for model, of_link in MODELS.items():
            self.open_tab('Models')
            self.select(model, of_link)
            self.open_tab('Edit')
            self.wait_shown(model, f', link {of_link}')

    def test_joints_that_are_moved(self):
        self.open_tab('Drive')
        for name, texts in self.arms.items():
            self.wait(lambda name=name: plain(name) in self.options('Of'), name)
            self.choose('Of', plain(name))
            self.wait_shown(*(f'{text} [rad]' for text in texts))

    def test_topics_that_are_commanded(self):
        self.open_tab('Drive')
        drive = [topic(text, 'drive') for text in TEXTS]
        joints = [topic(text, 'joint') for text in TEXTS[:SLIDERS]]
        listening = [
            *(rospy.Subscriber(name, Twist, id) for name in drive),
            *(rospy.Subscriber(name, Float64, id) for name in joints),
        ]
        self.wait_offered('Topic', drive)
        self.wait(lambda: CONTROLLERS in self.options('Of'), 'topics of joints')
        self.choose('Of', CONTROLLERS)
        self.wait_shown(*joints)
        for one in listening:
            one.unregister()

    def test_topics_and_messages_of_sensors(self):
        self.open_tab('Sensors')
        topics = [topic(text, 'imu') for text in TEXTS]
        talking = [rospy.Publisher(name, Imu, queue_size=1) for name in topics]
        contacts = rospy.Publisher('/bumper', ContactsState, queue_size=1)
        self.wait_shown(*topics)
        self.hand.choose('/bumper', True)
        self.wait(contacts.get_num_connections, 'a reader')
        for text in TEXTS:
            message = ContactsState(
                states=[
                    ContactState(
                        collision1_name=f'{text} one',
                        collision2_name=f'{text} other',
                        contact_positions=[Vector3()],
                        contact_normals=[Vector3()],
                    )
                ]
            )
            message.header.frame_id = f'{text} frame'
            contacts.publish(message)
            self.wait_shown(f'{text} one and {text} other: ', f"its frame '{text} frame'")
        for one in (*talking, contacts):
            one.unregister()

    def test_curves(self):
        self.open_tab('Plot')
        topics = [topic(text, 'curve') for text in TEXTS]
        talking = [rospy.Publisher(name, Float64, queue_size=1) for name in topics]
        self.wait_offered('Topic', topics)
        for begin in range(0, len(TEXTS), CURVES):
            curves = [f'{name}/data' for name in topics[begin : begin + CURVES]]
            for curve in curves:
                self.hand.choose('Curve', curve)
                self.hand.click('Add curve')
                self.wait(lambda curve=curve: self.hand.control(plain(curve)), curve)
            self.wait_shown(*curves)
            for curve in curves:
                self.hand.choose(plain(curve), False)
                self.wait(lambda curve=curve: not self.hand.control(plain(curve)), 'it removed')
        for one in talking:
            one.unregister()

    def test_lights_folders_and_parameters_that_are_offered(self):
        self.open_tab('Edit')
        spawn = proxy('spawn_sdf_model', SpawnModel)
        for text in NAMES:
            answer = spawn(text, LIGHT.format(quoteattr(text)), '', pose(), '')
            assert answer.success, answer.status_message
        parameters = [topic(text, 'parameter') for text in TEXTS]
        for name in parameters:
            rospy.get_master().target.setParam(rospy.get_name(), name, '<robot name="a"/>')
        for label, names in (
            ('Light', NAMES),
            ('Model path', self.folders),
            ('Parameter', parameters),
        ):
            self.wait_offered(label, names)
        for text in NAMES:
            proxy('delete_light', DeleteLight)(text)

    def test_files_that_are_refused(self):
        self.open_tab('Edit')
        for group in GROUPS:
            name = f'{"".join(group)}.urdf'
            self.upload(name, b'\0\xff', f"'{name}' is not text; upload a URDF, xacro or SDF")
        self.upload(
            'name.urdf',
            body(REFUSED, 'link').encode(),
            'contains a line break or another control character',
        )

    def upload(self, name, content, sentence):
        """Upload a file, wait for what is said of it, and close that."""
        tries = 0

        def is_shown():
            nonlocal tries
            if tries % 200 == 0:  # again: the page says nothing if it has just said too much
                self.driver.execute_script(SEND_FILE, name, list(content))
            tries += 1
            return not self.driver.execute_script(MISSING, [plain(sentence)])

        self.wait(is_shown, sentence)
        self.driver.execute_script(CLOSE)  # at most five are shown at once

    def test_changes_that_can_be_undone(self):
        for name, of_link in MODELS.items():
            self.hand.upload(UPLOAD, 'file.urdf', body(f'{name}2', of_link).encode())
            self.wait_shown(f"Undo: insert '{name}2'")
            self.press(f"Undo: insert '{plain(name)}2'")
            self.wait(lambda: list(self.rows('Undo')) == ['Undo'], 'nothing to undo')

    def test_recording(self):
        self.hand.click('Record a recording')
        self.hand.click('Stop the recording')
        self.wait(self.hand.download, 'the recording')
        name, content = self.hand.download()
        (data,) = re.findall(rb'__VISER_EMBED_DATA__="([^"]*)"', content)
        self.assertIn(MARK.encode(), recorded(data))
        (self.folder / name).write_bytes(content)
        with self.other_page(f'file://{self.folder / name}') as foreign:
            wait_until(lambda: self.driver.find_elements(By.TAG_NAME, 'canvas'), 'a picture')
            drawn(self.driver)
            self.assertEqual(foreign(), [])

    def test_policy_lets_markup_neither_run_nor_load(self):
        with self.other_page(self.address + QUERY, ignores_policy=False) as foreign:
            listener = self.insert_markup(foreign)
            drawn(self.driver)
            self.assertFalse(self.driver.execute_script(HAS_RUN))
            self.assertEqual(listener.requests, 0)

    def test_markup_would_be_noticed(self):
        blank = self.folder / 'blank.html'
        blank.write_text('<!doctype html><body></body>')
        with self.other_page(f'file://{blank}') as foreign:
            listener = self.insert_markup(foreign)
            wait_until(lambda: self.driver.execute_script(HAS_RUN), 'a script')
            wait_until(lambda: listener.requests, 'a request')

    def insert_markup(self, foreign):
        """Make markup of the texts, as the page must not; return the server that they name."""
        listener = Listener()
        self.addCleanup(listener.close)
        self.driver.execute_script(
            INSERT, [text.replace(HOST, f'127.0.0.1:{listener.port}') for text in MARKUP]
        )
        wait_until(lambda: len(foreign()) > MOST_OF_THEM, 'markup')
        self.makes_markup = True  # of which the console has errors
        return listener

    @contextlib.contextmanager
    def other_page(self, address, ignores_policy=True):
        """Look at an address in another tab; yield a function that returns what is foreign."""
        first = self.driver.current_window_handle
        self.driver.switch_to.new_window('tab')
        try:
            watch(self.driver, ignores_policy)
            self.driver.get(address)
            yield lambda: self.driver.execute_script('return foreign')
        finally:
            self.driver.close()
            self.driver.switch_to.window(first)


if __name__ == '__main__':
    rospy.init_node('hostile_names', disable_rostime=True)
    rostest.rosrun('rosbots_description', 'hostile_names', HostileNamesTest, sys.argv)
