#!/usr/bin/env python3
"""The window's page in a real browser: it shows the robot, and what is done there is done."""

import json
import re
import signal
import sys
import tempfile
import unittest
from pathlib import Path
from time import monotonic

import numpy as np
import rospy
import rostest
from gazebo_msgs.srv import GetModelState, GetPhysicsProperties, GetWorldProperties, SpawnModel
from PIL import Image
from rosbots_msgs.srv import Step
from selenium.webdriver.common.by import By
from server_process import ServerProcess
from simulator import pose, proxy, wait_until
from std_srvs.srv import Empty
from terminal import Terminal

sys.path.append(str(Path(__file__).resolve().parents[1]))
sys.path.append(str(Path(__file__).resolve().parents[2] / 'tools'))
from chromium import chromium, faults, picture
from support.similarity import structural_similarity

REFERENCE = Path(__file__).resolve().parents[1] / 'data' / 'web' / 'robot.png'
ROBOT = (slice(120, 320), slice(200, 450))  # rows and columns of it in the picture
ALIKE = 0.85  # structural similarity; 0.3 without the robot
SIZE = (640, 400)  # [pixels] of a page
SETTLED = 1500  # steps
SLOW = 60.0  # [s, wall] for what is drawn in software
# The picture is of the scene only, and not of fewer pixels where the processor is slow.
QUERY = '?fixedDpr=1'
SCENE_ONLY = """const style = document.createElement('style');
style.textContent = 'body *:not(canvas):not(:has(canvas)) { visibility: hidden !important }';
document.head.append(style)"""


class Page:
    """What a person does with the page."""

    def __init__(self, driver, address):
        self.driver = driver
        driver.get(address + QUERY)
        self.wait_for_text('Iterations')

    def text(self):
        return self.driver.find_element(By.TAG_NAME, 'body').text

    def wait_for_text(self, text):
        wait_until(lambda: text in self.text(), f'{text!r} on the page', SLOW)

    def click(self, label):
        button = f'//button[normalize-space()="{label}"]'
        wait_until(lambda: self.driver.find_elements(By.XPATH, button), f'button {label}', SLOW)
        self.driver.find_element(By.XPATH, button).click()

    def press(self, key):
        self.driver.find_element(By.TAG_NAME, 'body').send_keys(key)

    def picture(self):
        """Return the page as rows by columns of grey, 0..255."""
        return np.asarray(picture(self.driver).convert('L'), float)


def time():
    return proxy('get_world_properties', GetWorldProperties)().sim_time


def is_paused():
    return proxy('get_physics_properties', GetPhysicsProperties)().pause


def x_of(model):
    return proxy('get_model_state', GetModelState)(model, '').pose.position.x


class ChromiumTest(unittest.TestCase):

    @classmethod
    def setUpClass(cls):
        cls.server = cls.start_server()
        cls.addClassCleanup(cls.end_server)
        window = Terminal('rosrun', 'gazebo_ros', 'gzweb', '--port', '0')
        cls.addClassCleanup(window.close)
        said = []
        wait_until(lambda: said.append(re.search(r'the world is at (\S+)', window.shown()))
                   or said[-1], 'the address', SLOW)
        cls.address = said[-1][1]
        cls.page = Page(cls.enterClassContext(chromium(SIZE)), cls.address)

    @staticmethod
    def start_server():
        """Return a simulator that is paused; the robot has just come to rest."""
        server = ServerProcess('-u').wait_ready()
        spawned = proxy('spawn_urdf_model', SpawnModel)(
            'rosbots', rospy.get_param('robot_description'), '', pose(), '')
        assert spawned.success, spawned.status_message
        proxy('step', Step)(SETTLED)
        return server

    @classmethod
    def end_server(cls):
        cls.server.__exit__()

    def setUp(self):
        proxy('pause_physics', Empty)()
        proxy('reset_simulation', Empty)()
        proxy('step', Step)(SETTLED)

    def tearDown(self):
        self.assertEqual(faults(self.page.driver), [])

    def test_page_shows_the_robot_and_asks_nobody_else(self):
        with tempfile.TemporaryDirectory() as folder:
            log = Path(folder, 'net.json')
            with chromium(SIZE, f'--log-net-log={log}') as driver:
                page = Page(driver, self.address)
                driver.execute_script(SCENE_ONLY)
                self.wait_for_the_robot(page)
                self.assertEqual(faults(driver), [])
            asked = self.addresses(json.loads(log.read_text()))
        self.assertIn(self.address.replace('http', 'ws'), asked)
        self.assertEqual([one for one in asked if not re.match(
            f'(http|ws)://{self.address.split("/")[2]}/|data:|blob:', one)], [])

    def wait_for_the_robot(self, page):
        reference = np.asarray(Image.open(REFERENCE), float)
        end = monotonic() + SLOW
        while (alike := structural_similarity(page.picture()[ROBOT], reference)) < ALIKE:
            self.assertLess(monotonic(), end, f'the picture is like the reference by {alike:.2f}')

    def addresses(self, log):
        """Return what the page, its parts included, has asked for, by Chromium's network log."""
        begun = log['constants']['logEventTypes']['URL_REQUEST_START_JOB']
        events = [event['params'] for event in log['events']
                  if event['type'] == begun and 'url' in event.get('params', {})]
        return {params['url'] for params in events
                if params.get('initiator', '').startswith(('http', 'null'))}

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

    def test_key_drives_the_robot(self):
        proxy('unpause_physics', Empty)()
        before = x_of('rosbots')
        wait_until(lambda: self.page.press('i') or x_of('rosbots') > before + 0.05, 'a drive', SLOW)

    def test_page_tells_of_a_restarted_simulator(self):
        self.server.process.send_signal(signal.SIGKILL)
        self.page.wait_for_text('does not answer')
        type(self).server = self.start_server()
        self.page.wait_for_text('is there again')
        self.assertNotIn('does not answer', self.page.text())


if __name__ == '__main__':
    rospy.init_node('test_in_chromium', disable_rostime=True)
    rostest.rosrun('rosbots_description', 'chromium', ChromiumTest)
