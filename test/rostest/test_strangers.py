"""What strangers once could do to the window, tried again on real servers.

Hundreds of further attempts, at the same page without ROS, are in
test/unit/web/site/test_strangers.py and test/unit/ros_api/window/test_xacro_sandbox.py.
"""

import math
import os
import sys
import tempfile
import unittest
import urllib.request
from pathlib import Path
from urllib.parse import urlsplit

from gazebo_msgs.srv import GetWorldProperties
from programs import find_program, memory_of, ran
from server_process import ServerProcess
from simulator import page_address, proxy
from terminal import Terminal

sys.path.append(str(Path(__file__).resolve().parents[1]))
from support.browser import CAMERA, Browser
from support.hostile_texts import MARK

SLOW = 60.0  # [s, wall]
NOBODY = 65534  # the user
UPLOAD = 'Upload URDF, xacro or SDF'
LARGE, MANY = 9_800_000, 20  # bytes of a file that is never complete, and how many
SPARE = 100e6  # [bytes] by which the window may grow with them
LINK = """<link name="body"><inertial><mass value="1"/>
  <inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>"""
XACRO = '<robot name="{}" xmlns:xacro="http://www.ros.org/wiki/xacro">' + LINK + '{}</robot>'
POPEN = (
    '${{[c for c in ().__class__.__bases__[0].__subclasses__() if c.__name__ == '
    "'_wrap_close'][0].__init__.__globals__['popen']('{}').read()}}"
)
KNOCK = """import socket, sys
knock = socket.create_connection(('127.0.0.1', int(sys.argv[1])))
knock.sendall(b'GET / HTTP/1.1\\r\\nHost: 127.0.0.1\\r\\nUpgrade: websocket\\r\\n'
              b'Connection: Upgrade\\r\\nSec-WebSocket-Version: 13\\r\\n'
              b'Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\\r\\n\\r\\n')
print(knock.makefile().read())"""


def models():
    return proxy('get_world_properties', GetWorldProperties)().model_names


class StrangersTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.server = cls.enterClassContext(ServerProcess())
        cls.server.wait_ready()
        cls.window = Terminal(find_program('gazebo_ros', 'gzweb'), '--port', '0')
        cls.addClassCleanup(cls.window.close)
        cls.address = page_address(cls.window.shown)
        cls.token = cls.address.partition('token=')[2]

    def setUp(self):
        self.browser = self.enterContext(Browser(self.address))
        self.browser.wait_until(lambda: self.browser.control(UPLOAD), SLOW)
        self.browser.wait_until(lambda: '/models/ground_plane/link' in self.browser.nodes, SLOW)

    def upload(self, name, text):
        """Upload a file; return what the page says of it, once its model is there or it is not."""
        before, notes = set(models()), len(self.browser.notes())
        self.browser.upload(UPLOAD, name, text.encode())
        self.browser.wait_until(
            lambda: set(models()) > before or len(self.browser.notes()) > notes, SLOW
        )
        return ' '.join([*self.browser.notes()[notes:], *(set(models()) - before)])

    @unittest.skipUnless(os.geteuid() == 0, 'another user can only be tried by root')
    def test_1_another_user_of_the_machine_gets_no_socket(self):
        command = ('/usr/bin/python3', '-I', '-c', KNOCK, str(urlsplit(self.address).port))
        said = ran(*command, check=True, user=NOBODY, cwd='/').stdout
        self.assertIn('403 Forbidden', said)
        self.assertIn('needs the token', said)

    def test_1_and_3_code_in_a_xacro_runs_where_it_finds_nothing(self):
        with tempfile.TemporaryDirectory() as folder:
            os.chmod(folder, 0o777)
            command = f'touch {folder}/made; id; cat /proc/*/environ'
            self.upload(
                'robot.xacro',
                XACRO.format(
                    'one', f'<!-- {POPEN.format(command)} --><link name="{POPEN.format(command)}"/>'
                ),
            )
            self.assertEqual(os.listdir(folder), [])

    def test_2_names_of_a_model_are_text(self):
        name = f'&lt;iframe class="{MARK}" srcdoc="&lt;script>">'.replace('"', '&quot;')
        said = self.upload('nice.urdf', XACRO.format(name, ''))
        selected = [one for one in models() if MARK in one]
        if selected:  # else the simulator has no such names
            self.browser.click(selected[0])
            self.browser.wait_until(lambda: MARK in self.browser.tables(), SLOW)
            self.assertNotIn('<iframe', self.browser.tables() + ''.join(self.browser.contents()))
        else:
            self.assertIn(MARK, said)

    def test_4_files_and_environment_are_not_read(self):
        with tempfile.NamedTemporaryFile('w', suffix='.yaml') as file:
            file.write('key: open_sesame\n')
            file.flush()
            for inner in (
                f"<link name=\"${{load_yaml('{file.name}')['key']}}\"/>",
                f'<xacro:include filename="{file.name}"/>',
                '<link name="$(env ROS_MASTER_URI)"/>',
            ):
                said = self.upload('robot.xacro', XACRO.format('four', inner))
                self.assertIn('xacro rejects it', said)
                self.assertNotIn('sesame', said)
        self.assertNotIn('four', models())

    def test_5_unfinished_files_do_not_fill_the_memory(self):
        process = self.window.process.pid
        before = memory_of(process)
        for number in range(MANY):
            self.browser.send(
                {
                    'type': 'FileTransferStartUpload',
                    'mime_type': '',
                    'filename': 'x',
                    'source_component_uuid': self.browser.control(UPLOAD),
                    'transfer_uuid': str(number),
                    'part_count': 20,
                    'size_bytes': LARGE,
                }
            )
            for part in range(19):
                self.browser.send(
                    {
                        'type': 'FileTransferPart',
                        'transfer_uuid': str(number),
                        'part_index': part,
                        'source_component_uuid': self.browser.control(UPLOAD),
                        'content': 500_000 * b'x',
                    }
                )
            self.browser.read(0.0)
        self.browser.wait_until(lambda: any('at once' in one for one in self.browser.notes()), SLOW)
        self.browser.choose('Steps', 3)  # is read after all of them
        with Browser(self.address) as other:
            other.wait_until(lambda: other.control('Steps') and other.value('Steps') == 3, SLOW)
        self.assertLess(memory_of(process) - before, SPARE)

    def test_6_a_camera_of_no_number_harms_nobody(self):
        self.browser.send({**CAMERA, 'position': [math.nan] * 3})
        self.browser.wait_until(
            lambda: any('not finite' in one for one in self.browser.notes()), SLOW
        )
        with Browser(self.address) as other:
            other.wait_until(
                lambda: {'SetCameraPositionMessage'} <= {one['type'] for one in other.messages},
                SLOW,
            )
        self.assertNotIn('Traceback', self.window.shown())

    def test_7_no_page_may_frame_it(self):
        with urllib.request.urlopen(self.address) as answer:
            self.assertIn("frame-ancestors 'none'", answer.headers['Content-Security-Policy'])

    def test_8_no_command_line_has_the_token(self):
        for process in filter(str.isdigit, os.listdir('/proc')):
            try:
                line = Path('/proc', process, 'cmdline').read_bytes()
            except OSError:
                continue
            self.assertNotIn(self.token.encode(), line)
