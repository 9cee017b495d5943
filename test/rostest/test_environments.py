"""The server runs in restricted environments, and reports what is missing."""

import contextlib
import os
import shutil
import tempfile
import unittest
from pathlib import Path
from urllib.parse import quote
from xml.sax.saxutils import escape, quoteattr

import rospy
from gazebo_msgs.srv import GetWorldProperties, SpawnModel
from programs import ran
from server_process import ServerProcess
from simulator import BOX, DEADLINE, GROUND, pose, proxy, wait_until

from rosbots_description.cli.launched import Launched

NAME = '__name:=harsh'
BLOCK = 4096  # [bytes] allocation unit of file systems
PACKAGE = Path(__file__).resolve().parents[2]
NOBODY = ('setpriv', '--reuid=65534', '--regid=65534', '--clear-groups')
CLOSED = ('sh', '-c', 'exec "$@" <&- >&- 2>&-', 'sh')
# Root may unshare, unless a container forbids it; other users need a user namespace.
UNSHARE = ('unshare',) if os.geteuid() == 0 else ('unshare', '--map-root-user')
# Private mount namespaces, for the command that follows.
SMALL = (
    *UNSHARE,
    '--mount',
    'sh',
    '-c',
    'for place in "$DISK" /dev/shm; do '
    'mount -t tmpfs -o size=1m small "$place" || exit; done; exec "$@"',
    'sh',
)
READ_ONLY = (
    *UNSHARE,
    '--mount',
    'sh',
    '-c',
    'mount --bind "$PACKAGE" "$PACKAGE" && mount -o remount,bind,ro "$PACKAGE" && exec "$@"',
    'sh',
    *NOBODY,
)
NOWHERE = (*UNSHARE, '--net', '--uts', PACKAGE / 'test' / 'rostest' / 'nowhere.py')
# Master, server and spawn_model, without any address in the environment.
MEET = """
rosmaster --core -p 11311 > /dev/null & master=$!
rosrun gazebo_ros gzserver & server=$!
rosrun gazebo_ros spawn_model -urdf -file "$1" -model box
code=$?
kill $server $master
wait $server && exit $code
"""

WORLD = """<?xml version="1.0" encoding="utf-8"?>
<sdf version="1.6"><world name="größe">
  <include><uri>model://ground_plane</uri></include>
  <include><uri>model://tür</uri></include>
  <include><uri>model://fenster</uri></include>
</world></sdf>"""
DOOR = """<?xml version="1.0" encoding="utf-8"?>
<sdf version="1.6"><model name="tür"><static>true</static><link name="blatt">
  <pose>3 0 0 0 0 0</pose>
  <collision name="c"><geometry><mesh><uri>file://{}</uri></mesh></geometry></collision>
</link></model></sdf>"""
ROBOT = """<?xml version="1.0" encoding="utf-8"?>
<!-- Größe: 3 Fuß -->
<robot name="bär"><link name="räumer">
  <inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
  <collision><geometry><mesh filename={}/></geometry></collision>
</link></robot>"""


def world():
    return proxy('get_world_properties', GetWorldProperties, '/harsh')()


def fill(path):
    """Write into a file until its disk is full."""
    with path.open('wb', buffering=0) as file, contextlib.suppress(OSError):
        while True:
            file.write(bytes(BLOCK))


class EnvironmentsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.root = Path(cls.enterClassContext(tempfile.TemporaryDirectory()))
        cls.root.chmod(0o755)  # also for a user without privileges
        cls.folder = cls.root / "Mein Roboter ä %41 #&'"
        model = cls.folder / 'models' / 'tür'
        model.mkdir(parents=True)
        mesh = cls.folder / 'räder.dae'
        shutil.copy(PACKAGE / 'meshes' / 'wheel.dae', mesh)
        (model / 'model.sdf').write_text(DOOR.format(escape(quote(str(mesh)))), encoding='utf-8')
        (cls.folder / 'größe.world').write_text(WORLD, encoding='utf-8')
        for name, uri in (('coded', f'file://{quote(str(mesh))}'), ('written', f'file://{mesh}')):
            (cls.folder / f'bär {name}.urdf').write_text(
                ROBOT.format(quoteattr(uri)), encoding='utf-8'
            )

    def require(self, *command, **environment):
        """Skip the test where the machine does not permit such namespaces."""
        done = ran(*command, env={**os.environ, **environment})
        if done.returncode:
            reason = f'this machine does not permit it: {done.stderr.strip()}'
            print(f'SKIPPED {self._testMethodName}: {reason}')  # rosunit reports it as passed
            self.skipTest(reason)

    def server(self, *arguments, **surroundings):
        """Return a server that is ready; it ends with the test."""
        server = ServerProcess(NAME, *arguments, **surroundings)
        self.addCleanup(server.__exit__)
        return server.wait_ready()

    @staticmethod
    def spawn(name, xml):
        return proxy('spawn_urdf_model', SpawnModel, '/harsh')(name, xml, '/', pose(), '')

    def assert_carries_the_robot(self):
        """Assert that the article's robot, with meshes, can be spawned and time advances."""
        answer = self.spawn('rosbots', rospy.get_param('robot_description'))
        self.assertTrue(answer.success, answer.status_message)
        self.assert_is_running([GROUND, 'rosbots'])

    def assert_is_running(self, models):
        before = world()
        self.assertEqual(before.model_names, models)
        wait_until(lambda: world().sim_time > before.sim_time + 0.1, 'time')

    def assert_ends_well(self, server):
        code, printed = server.end()
        self.assertNotIn('Traceback', printed)
        self.assertEqual(code, 0, printed)
        return printed

    def test_non_ascii_names_and_folders_work_in_the_locale_c(self):
        surroundings = {
            'LC_ALL': 'C',
            'PYTHONUTF8': '0',
            'PYTHONIOENCODING': 'ascii',
            'GAZEBO_MODEL_PATH': str(self.folder / 'models'),
            'TMPDIR': str(self.folder),
        }
        server = self.server(str(self.folder / 'größe.world'), **surroundings)
        for name in ('coded', 'written'):
            with ServerProcess(
                '-urdf',
                '-file',
                str(self.folder / f'bär {name}.urdf'),
                '-model',
                f'bär {name}',
                '-gazebo_namespace',
                '/harsh',
                program='spawn_model',
                **surroundings,
            ) as client:
                code, printed = client.wait()
            self.assertEqual(code, 0, printed)
        self.assert_is_running([GROUND, 'tür', 'bär coded', 'bär written'])
        printed = self.assert_ends_well(server)
        where = ascii(f"{self.folder}/größe.world, line 5: 'model://fenster'").strip('"')
        self.assertIn(where, printed)

    def test_log_is_only_printed_without_home(self):
        nothing = '/dev/null/home'
        server = self.server(HOME=nothing, ROS_HOME=nothing, ROS_LOG_DIR=f'{nothing}/log')
        self.assert_carries_the_robot()
        printed = self.assert_ends_well(server)
        self.assertIn(
            f'log file {nothing}/log/harsh.log cannot be written (Not a directory)', printed
        )
        self.assertIn('contradict the collision geometry', printed)

    def test_server_works_with_closed_standard_streams(self):
        server = self.server('worlds/shapes.world', prefix=CLOSED)
        self.assert_is_running([GROUND, 'box', 'sphere', 'cylinder'])
        self.assertEqual(server.end(), (0, ''))

    def test_full_disk_and_memory_reject_only_models_that_need_space(self):
        disk = self.root / 'disk'
        disk.mkdir()
        surroundings = {'DISK': str(disk), 'TMPDIR': str(disk), 'ROS_LOG_DIR': str(disk)}
        self.require(*SMALL, 'true', **surroundings)
        server = self.server(prefix=SMALL, **surroundings)
        self.assert_carries_the_robot()
        for place in (disk, '/dev/shm'):  # as the server sees them
            fill(Path(f'/proc/{server.process.pid}/root{place}/filling'))
        bear = (self.folder / 'bär coded.urdf').read_text(encoding='utf-8')
        for _ in range(BLOCK // 256):  # until the errors fill the log's last block
            answer = self.spawn('bear', bear)
            self.assertFalse(answer.success)
        self.assertIn(
            f"räder.dae' cannot be made ready: nothing can be written in {disk} "
            '(No space left on device) nor in /dev/shm (No space left on device); ',
            answer.status_message,
        )
        self.assertTrue(self.spawn('box', BOX).success)
        self.assert_is_running([GROUND, 'rosbots', 'box'])
        printed = self.assert_ends_well(server)
        self.assertEqual(printed.count(f'log file {disk}/harsh.log cannot be written'), 1, printed)

    def test_user_without_privileges_needs_read_access_only(self):
        # For example, other users cannot read in the home of root.
        self.require(
            *READ_ONLY,
            'python3',
            '-c',
            'import rosbots_description, pybullet',
            PACKAGE=str(PACKAGE),
        )
        server = self.server(
            prefix=READ_ONLY,
            PACKAGE=str(PACKAGE),
            HOME='/nonexistent',
            ROS_HOME='/nonexistent',
            ROS_LOG_DIR='/nonexistent/log',
        )
        self.assert_carries_the_robot()
        self.assert_ends_well(server)

    def test_programs_connect_without_network_and_resolvable_hostname(self):
        self.require(*NOWHERE, 'true')
        surroundings = {
            name: value
            for name, value in os.environ.items()
            if name not in ('ROS_HOSTNAME', 'ROS_IP')
        }
        surroundings |= {'ROS_MASTER_URI': 'http://localhost:11311'}
        command = (*NOWHERE, 'sh', '-c', MEET, 'sh', self.folder / 'bär coded.urdf')
        done = ran(*command, env=surroundings)
        printed = done.stdout + done.stderr
        self.assertEqual(done.returncode, 0, printed)
        self.assertIn('Spawn status: SpawnModel: Successfully spawned entity', printed)
        self.assertIn('the hostname nowhere cannot be resolved', printed)

    def test_launch_file_without_a_display_starts_the_server_with_a_message(self):
        surroundings = {name: value for name, value in os.environ.items() if name != 'DISPLAY'}
        surroundings |= {'WAYLAND_DISPLAY': 'wayland-0', 'HOME': str(self.folder)}
        log, world_name = self.root / 'launch.log', f'world_name:={self.folder}/größe.world'
        with Launched(
            ['gazebo_ros', 'empty_world.launch', world_name], log, surroundings
        ) as launched:
            rospy.wait_for_service('/gazebo/unpause_physics', 2 * DEADLINE)
            wait_until(lambda: 'gzclient: no window' in log.read_text(), 'the message')
            models = proxy('get_world_properties', GetWorldProperties)().model_names
            self.assertEqual(models, [GROUND])
            self.assertTrue(launched.running)
        self.assertIn('DISPLAY is not set', log.read_text())
