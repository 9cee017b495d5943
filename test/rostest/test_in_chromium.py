#!/usr/bin/env python3
"""The window's page in a real browser: it shows the robot, and what is done there is done."""

import json
import math
import os
import re
import secrets
import signal
import sys
import tempfile
import unittest
from contextlib import contextmanager, suppress
from pathlib import Path
from time import monotonic
from urllib.parse import urlsplit

import numpy as np
import rospy
import rostest
from gazebo_msgs.srv import (
    DeleteModel,
    GetModelState,
    GetPhysicsProperties,
    GetWorldProperties,
    SpawnModel,
)
from PIL import Image
from programs import find_program
from rosbots_msgs.srv import Step
from selenium.common.exceptions import StaleElementReferenceException
from selenium.webdriver import ActionChains
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys
from selenium.webdriver.support.expected_conditions import staleness_of
from sensor_msgs.msg import LaserScan
from server_process import ServerProcess
from simulator import BOX, GROUND, page_address, pose, proxy, wait_until
from std_srvs.srv import Empty
from terminal import Terminal

from rosbots_description.cli.launched import descendants

sys.path.append(str(Path(__file__).resolve().parents[1]))
sys.path.append(str(Path(__file__).resolve().parents[2] / 'tools'))
from chromium import chromium, clock, faults, opens_tab, picture, resize
from support.similarity import structural_similarity

REFERENCE = Path(__file__).resolve().parents[1] / 'data' / 'web' / 'robot.png'
ROBOT = (slice(120, 320), slice(380, 630))  # rows and columns of it in the picture
ALIKE = 0.85  # structural similarity; 0.3 without the robot
SIZE = (1388, 400)  # [pixels] of a page; its controls have 388 at the right
DESKTOP, PHONE = (1280, 800), (390, 844)  # [pixels]
SCANS = '/a_robot/with_a_long_name/front_laser_of_the_upper_deck/scan'
TOP = (0.0, 0.0, 0.6)  # [m] a point on the robot
# From a point on the handle along x of its frame, which is below the ground, to one behind [m].
HANDLE, BEHIND = (0.8, 0.0, -0.12), (0.3, 0.0, -0.12)
FIELD_OF_VIEW = math.radians(75.0)  # viser's, vertical
SETTLED = 1500  # steps, at least
SLOW = 180.0  # [s, wall] for what is drawn in software, beside other tests
# The world defines the view, so that no page's view depends on when it was opened.
EYE, PITCH, YAW = (1.193, -1.05, 1.188), 0.43633, 2.3911  # [m], [rad], [rad]
WORLD = f"""<sdf version="1.6"><world name="default">
  <include><uri>model://ground_plane</uri></include><include><uri>model://sun</uri></include>
  <gui><camera name="user_camera">
    <pose>{' '.join(map(str, EYE))} 0 {PITCH} {YAW}</pose>
  </camera></gui>
</world></sdf>"""
SCENE = 'canvas[data-engine]'  # by three.js
# The picture is of the scene only, and of as many pixels however slow the processor is. The console
# tells where the page looks from.
QUERY = '&fixedDpr=1&logCamera'
SCENE_ONLY = """const style = document.createElement('style');
style.textContent = 'body *:not(canvas):not(:has(canvas)) { visibility: hidden !important }';
document.head.append(style)"""
# Collects all texts that appear: a notification may have disappeared when a slow page is read.
COLLECT_TEXTS = """window.texts = new Set();
new MutationObserver(changes => changes.forEach(change => change.addedNodes.forEach(
  node => texts.add(node.textContent)))).observe(document.body, {childList: true, subtree: true})"""
HAS_TEXT = 'return [...texts].some(text => text.includes(arguments[0]))'


def red(pixels):
    """Return which pixels (rows, columns) are as red as the handle along x."""
    red, green, blue = pixels
    return (red - green > 60) & (blue >= green)


def coloured(pixels):
    """Return which pixels (rows, columns) are not grey, as the ground is."""
    return np.ptp(pixels, axis=0) > 40


class Page:
    """What a person does with the page."""

    def __init__(self, driver, address):
        self.driver = driver
        self._uploads = tempfile.TemporaryDirectory()  # until the page is gone
        driver.get(address + QUERY)
        driver.execute_script(COLLECT_TEXTS)
        wait_until(lambda: clock(driver), 'the clock', SLOW)

    def text(self):
        return self.driver.find_element(By.TAG_NAME, 'body').text

    def wait_for_text(self, text):
        wait_until(lambda: text in self.text(), f'{text!r} on the page', SLOW)

    def wait_for_notification(self, text):
        """Wait until a text has appeared since the last `forget`, if only for a moment."""
        wait_until(lambda: self.driver.execute_script(HAS_TEXT, text), f'{text!r} shown', SLOW)

    def forget(self):
        """Forget the notifications so far."""
        self.driver.execute_script('texts.clear()')

    def click(self, label):
        """Click on a button that can be seen; on the next one if the page replaces it meanwhile.

        The mouse does not press it: as the page fills, a button moves before the release.
        """
        wait_until(lambda: self._has_clicked(label), f'a click on {label}', SLOW)

    def _has_clicked(self, label):
        with suppress(StaleElementReferenceException):
            button = self.button(label)
            if button.is_displayed() and button.is_enabled():
                self.driver.execute_script('arguments[0].click()', button)
                return True
        return False

    def button(self, label):
        """Return the button whose label begins so, when it is there."""
        button = f'//button[starts-with(normalize-space(), "{label}")]'
        wait_until(lambda: self.driver.find_elements(By.XPATH, button), f'button {label}', SLOW)
        return self.driver.find_element(By.XPATH, button)

    def open_tab(self, name):
        wait_until(lambda: opens_tab(self.driver, name), f'the tab {name}', SLOW)

    def select(self, eye, model, point):
        """Click on a model where a point of it [m] is seen; once, as two clicks may be a double."""
        self.open_tab('Edit')
        self.wait_to_see(eye, point, coloured, model)
        ActionChains(self.driver).move_to_element_with_offset(
            self.scene(), *eye.pixel(point)
        ).click().perform()
        wait_until(lambda: f'\n{model}' in self.text(), f'{model} selected', SLOW)

    def wait_to_see(self, eye, point, colour, what):
        """Wait until `red`, say, is seen at a point [m]."""
        scene = self.scene().rect
        x, y = np.add(
            eye.pixel(point),
            (round(scene['x'] + scene['width'] / 2.0), round(scene['y'] + scene['height'] / 2.0)),
        )
        end = monotonic() + SLOW
        while not np.any((seen := colour(self.pixels()))[y - 4 : y + 5, x - 4 : x + 5]):
            if monotonic() > end:
                raise AssertionError(
                    f'not within {SLOW:g} s: {what} at ({x}, {y}); {np.sum(seen)} pixels are '
                    f'{colour.__name__}; the page: {self.text()!r}'
                )

    def pixels(self):
        """Return the page as red, green and blue, each rows by columns, 0..255."""
        return np.moveaxis(np.asarray(picture(self.driver).convert('RGB'), int), -1, 0)

    def scene(self):
        return self.driver.find_element(By.CSS_SELECTOR, SCENE)

    def drag(self, eye, start, end):
        """Press the button at a point [m] and move to another; do not release it."""
        (
            ActionChains(self.driver)
            .move_to_element_with_offset(self.scene(), *eye.pixel(start))
            .click_and_hold()
            .move_to_element_with_offset(self.scene(), *eye.pixel(end))
            .perform()
        )

    def upload(self, name, text):
        file = self.driver.find_element(By.CSS_SELECTOR, 'input[type=file]')
        path = Path(self._uploads.name, name)
        path.write_text(text)
        file.send_keys(str(path))

    def press(self, key):
        self.driver.find_element(By.TAG_NAME, 'body').send_keys(key)

    def picture(self):
        """Return the page as rows by columns of grey, 0..255."""
        return np.asarray(picture(self.driver).convert('L'), float)


def time():
    return proxy('get_world_properties', GetWorldProperties)().sim_time


def is_paused():
    return proxy('get_physics_properties', GetPhysicsProperties)().pause


def models():
    return proxy('get_world_properties', GetWorldProperties)().model_names


def x_of(model):
    return proxy('get_model_state', GetModelState)(model, '').pose.position.x


class Eye:
    """Where points of the world are on the page."""

    def __init__(self):
        ahead = np.array(
            [math.cos(PITCH) * math.cos(YAW), math.cos(PITCH) * math.sin(YAW), -math.sin(PITCH)]
        )
        right = np.cross(ahead, (0.0, 0.0, 1.0))
        right /= np.linalg.norm(right)
        self.axes = np.array([right, np.cross(ahead, right), ahead])  # right, down, ahead

    def pixel(self, point):
        """Return the offset of a point [m] from the middle of the page [pixels]."""
        right, down, ahead = self.axes @ np.subtract(point, EYE)
        scale = SIZE[1] / 2.0 / math.tan(FIELD_OF_VIEW / 2.0)
        return round(scale * right / ahead), round(scale * down / ahead)


class ChromiumTest(unittest.TestCase):
    steps = SETTLED
    lost = ''  # what the console says of a connection that ended with its window

    @classmethod
    def setUpClass(cls):
        cls.world = Path(cls.enterClassContext(tempfile.TemporaryDirectory()), 'view.world')
        cls.world.write_text(WORLD)
        cls.server = cls.start_server()
        cls.addClassCleanup(cls.end_server)
        os.environ['GZWEB_TOKEN'] = secrets.token_urlsafe()  # the same after a restart
        cls.address = cls.open_window('0')
        cls.prepare()
        cls.open_page()
        cls.other = cls.enterClassContext(chromium(SIZE))

    @classmethod
    def open_window(cls, port):
        """Start gzweb; return the address of its page."""
        cls.window = window = Terminal(find_program('gazebo_ros', 'gzweb'), '--port', port)
        cls.addClassCleanup(window.close)
        return page_address(window.shown, SLOW)

    @classmethod
    def open_page(cls):
        cls.page = Page(cls.enterClassContext(chromium(SIZE)), cls.address)

    @contextmanager
    def other_page(self, size):
        """Yield the page as another person's browser shows it, in a window of this size."""
        resize(self.other, size)
        try:
            yield Page(self.other, self.address)
            self.assertEqual(faults(self.other), [])
        finally:
            self.other.get('about:blank')  # nobody else looks at the next tests

    @classmethod
    def start_server(cls):
        return ServerProcess('-u', str(cls.world)).wait_ready()

    def setUp(self):
        self.page.press(Keys.ESCAPE)  # select nothing
        steps = self.prepare()
        # Until then it may show the robot before, and would forget with it what is selected.
        now = f'00:00:{0.001 * steps:06.3f}'
        wait_until(lambda: clock(self.page.driver) == now, 'the new world', SLOW)

    @classmethod
    def prepare(cls):
        """Pause a world of one robot that has just come to rest; return the steps it took."""
        proxy('pause_physics', Empty)()
        for name in set(models()) - {GROUND}:
            proxy('delete_model', DeleteModel)(name)
        proxy('reset_simulation', Empty)()
        spawned = proxy('spawn_urdf_model', SpawnModel)(
            'rosbots', rospy.get_param('robot_description'), '', pose(), ''
        )
        assert spawned.success, spawned.status_message
        cls.steps += 1  # another number than the page has shown
        proxy('step', Step)(cls.steps)
        return cls.steps

    @staticmethod
    def window_looks():
        _, readers, _ = rospy.get_master().getSystemState()[2]
        return any('/gzweb' in nodes and topic == '/gazebo/view/motion' for topic, nodes in readers)

    @classmethod
    def end_server(cls):
        cls.server.__exit__()

    def tearDown(self):
        self.assertEqual(
            [fault for fault in faults(self.page.driver) if not (self.lost and self.lost in fault)],
            [],
        )

    def test_second_page_shows_the_robot_and_asks_nobody_else(self):
        with tempfile.TemporaryDirectory() as folder:
            log = Path(folder, 'net.json')
            with chromium(SIZE, f'--log-net-log={log}') as driver:
                page = Page(driver, self.address)
                for label, other in (('Play', 'Pause'), ('Pause', 'Play')):
                    page.click(label)
                    self.page.button(other)  # both pages show the same
                driver.execute_script(SCENE_ONLY)
                self.wait_for_the_robot(page)
                self.assertEqual(faults(driver), [])
            asked = self.addresses(json.loads(log.read_text()))
        host = urlsplit(self.address).netloc
        self.assertTrue(any(one.startswith(f'ws://{host}/') for one in asked), asked)
        self.assertEqual(
            [one for one in asked if not re.match(f'(http|ws)://{host}/|data:|blob:', one)], []
        )

    def test_two_pages_have_each_a_selection_and_a_tab_of_their_own(self):
        box = proxy('spawn_urdf_model', SpawnModel)('box', BOX, '', pose(3.0), '')
        self.assertTrue(box.success, box.status_message)
        with self.other_page(DESKTOP) as other:
            for page, name in ((self.page, 'rosbots'), (other, 'box')):
                page.open_tab('Models')
                page.click(name)
                page.wait_for_text(f'{name}\nPosition [m]')
            other.open_tab('Edit')
            self.assertIn('rosbots\nPosition [m]', self.page.text())
            self.assertNotIn('Duplicate', self.page.text())
            other.press(Keys.DELETE)
            wait_until(lambda: 'box' not in models(), 'a deletion', SLOW)
            self.assertIn('rosbots', models())
        self.page.press(Keys.DELETE)
        wait_until(lambda: 'rosbots' not in models(), 'a deletion', SLOW)

    def wait_for_the_robot(self, page):
        reference = np.asarray(Image.open(REFERENCE), float)
        seen = []

        def is_alike():
            seen[:] = [page.picture()]
            return structural_similarity(seen[0][ROBOT], reference) >= ALIKE

        try:
            wait_until(is_alike, f'a picture that is like the reference by {ALIKE}', SLOW)
        except AssertionError:
            unlike = Path(os.environ['ROS_LOG_DIR'], 'unlike.png')
            Image.fromarray(seen[0].astype(np.uint8)).save(unlike)
            said = [entry['message'] for entry in page.driver.get_log('browser')]
            unlike.with_name('unlike_console.txt').write_text('\n'.join(said))
            raise

    def addresses(self, log):
        """Return what the page, its parts included, has asked for, by Chromium's network log."""
        begun = log['constants']['logEventTypes']['URL_REQUEST_START_JOB']
        events = [
            event['params']
            for event in log['events']
            if event['type'] == begun and 'url' in event.get('params', {})
        ]
        return {
            params['url']
            for params in events
            if params.get('initiator', '').startswith(('http', 'null'))
        }

    def test_buttons_act_on_the_clock(self):
        self.page.click('Play')
        wait_until(lambda: not is_paused(), 'time', SLOW)
        self.page.click('Pause')
        wait_until(is_paused, 'a pause', SLOW)
        before = time()
        self.page.click('Step')
        wait_until(lambda: time() > before, 'a step', SLOW)
        self.assertAlmostEqual(time(), before + 0.001, places=9)
        self.page.click('Reset time and world')
        wait_until(lambda: time() == 0.0, 'a reset', SLOW)

    def test_chosen_tab_has_two_thirds_of_the_panel(self):
        with self.other_page(DESKTOP) as page:
            panel, strip = (
                page.driver.find_element(By.CSS_SELECTOR, selector).rect
                for selector in ('[data-testid=floating-panel]', '[role=tablist]')
            )
            below = panel['y'] + panel['height'] - strip['y'] - strip['height']
            self.assertGreaterEqual(below, 2.0 / 3.0 * panel['height'])
            scene = page.scene().rect
            self.assertLessEqual(scene['x'] + scene['width'], panel['x'])  # not behind it
            self.assertEqual(page.driver.title, 'default')

    def test_long_label_has_one_line_and_keeps_its_end(self):
        publisher = rospy.Publisher(SCANS, LaserScan, queue_size=1)
        self.addCleanup(publisher.unregister)
        self.page.open_tab('Sensors')
        label = f'//label[normalize-space()="{SCANS}"]'
        wait_until(lambda: self.page.driver.find_elements(By.XPATH, label), 'its box', SLOW)
        label = self.page.driver.find_element(By.XPATH, label)
        shown, whole = label.find_element(By.XPATH, '..').rect, label.rect
        self.assertLess(whole['x'], shown['x'])
        self.assertLessEqual(whole['x'] + whole['width'], shown['x'] + shown['width'] + 1.0)
        self.assertLess(shown['height'], 25.0)

    def test_scene_is_not_faint_where_viser_stops_to_fade_it_in(self):
        scene = self.page.scene()
        self.page.driver.execute_script('arguments[0].style.opacity = 0.24', scene)
        self.assertEqual(scene.value_of_css_property('opacity'), '1')

    def test_phone_shows_the_world_and_a_sheet_that_opens(self):
        with self.other_page(PHONE) as page:
            self.assertEqual([page.scene().rect[side] for side in ('width', 'height')], [*PHONE])
            sheet = page.driver.find_element(
                By.CSS_SELECTOR, '[style*="position: fixed"]:has(.bar)'
            )
            wait_until(lambda: sheet.rect['y'] > 0.9 * PHONE[1], 'a closed sheet', SLOW)
            sheet.find_element(By.CSS_SELECTOR, '[style*="cursor: pointer"]').click()
            wait_until(lambda: sheet.rect['y'] < 0.5 * PHONE[1], 'an open sheet', SLOW)
            self.assertEqual(sheet.rect['width'], PHONE[0])
            page.click('Play')
            wait_until(lambda: not is_paused(), 'time', SLOW)

    def test_key_drives_the_robot(self):
        proxy('unpause_physics', Empty)()
        before = x_of('rosbots')
        wait_until(lambda: self.page.press('i') or x_of('rosbots') > before + 0.05, 'a drive', SLOW)

    def test_z_killed_browser_lets_go_of_the_robot_that_it_moves(self):
        eye = Eye()
        self.page.select(eye, 'rosbots', TOP)
        before = x_of('rosbots')
        self.page.wait_to_see(eye, HANDLE, red, 'the handle')
        self.page.drag(eye, HANDLE, BEHIND)
        wait_until(lambda: x_of('rosbots') < before - 0.1, 'a move', SLOW)
        for process in descendants(self.page.driver.service.process.pid):
            os.kill(process, signal.SIGKILL)
        proxy('unpause_physics', Empty)()
        wait_until(lambda: not self.window_looks(), 'nobody to look', SLOW)
        self.open_page()
        before = x_of('rosbots')
        wait_until(lambda: self.page.press('i') or x_of('rosbots') > before + 0.05, 'a drive', SLOW)

    def test_models_are_uploaded_and_deleted(self):
        self.page.open_tab('Edit')
        self.page.upload('box.urdf', BOX)
        wait_until(lambda: 'box' in models(), 'the box', SLOW)
        self.page.upload('broken.urdf', BOX.replace('</link>', ''))
        self.page.wait_for_notification('mismatch')  # of tags, says the parser
        self.page.select(Eye(), 'rosbots', TOP)
        self.page.click('Delete')
        wait_until(lambda: 'rosbots' not in models(), 'a deletion', SLOW)
        self.page.click("Undo: delete 'rosbots'")  # before, the button undoes the upload
        wait_until(lambda: 'rosbots' in models(), 'the robot', SLOW)

    def test_restarted_simulator_is_told_of(self):
        self.server.process.send_signal(signal.SIGKILL)
        self.page.wait_for_text('does not answer')
        self.page.forget()
        type(self).server = self.start_server()
        self.page.wait_for_notification('is running again')
        wait_until(lambda: 'does not answer' not in self.page.text(), 'no warning', SLOW)

    def test_restarted_window_is_found_again_by_its_page(self):
        has_gone = staleness_of(self.page.button('Play'))
        # Attempts to reconnect fail in several ways: refused, reset, closed before the handshake.
        # The console may say so late, after this test.
        type(self).lost = f"WebSocket connection to 'ws://{urlsplit(self.address).netloc}/"
        self.window.process.kill()
        self.window.process.wait()
        self.assertEqual(self.open_window(str(urlsplit(self.address).port)), self.address)
        wait_until(lambda: has_gone(self.page.driver), 'other buttons', SLOW)
        self.page.click('Play')
        wait_until(lambda: not is_paused(), 'time', SLOW)


if __name__ == '__main__':
    rospy.init_node('test_in_chromium', disable_rostime=True)
    rostest.rosrun('rosbots_description', 'chromium', ChromiumTest)
