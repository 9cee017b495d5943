"""A simulator that a test starts and ends, with the test's ROS master or another one."""

import contextlib
import os
import signal
import subprocess
from collections.abc import Mapping
from pathlib import Path

import rosgraph
from gazebo_msgs.srv import GetWorldProperties, SpawnModel
from programs import end, find_program, keep
from raw_client import answer, request_bytes, service_connection
from simulator import DEADLINE, SimulatorTest, free_port, pose, wait_until


class ServerProcess:
    """A program that runs for the length of a `with` statement.

    Args:
        prefix: a command that executes the program, such as `nice`.
    """

    def __init__(
        self,
        *arguments,
        program='gzserver',
        package='gazebo_ros',
        master=None,
        prefix=(),
        **environment,
    ):
        self.name = next((a.removeprefix('__name:=') for a in arguments if '__name' in a), 'gazebo')
        self.master = master or os.environ['ROS_MASTER_URI']
        self.environment = {**os.environ, 'ROS_MASTER_URI': self.master, **environment}
        self.process = subprocess.Popen(
            [*prefix, find_program(package, program), *arguments],
            env=self.environment,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            start_new_session=True,
        )

    def __enter__(self):
        return self

    def __exit__(self, *_):
        end(self.process)
        if not self.process.stdout.closed:
            os.set_blocking(self.process.stdout.fileno(), False)  # its children may have it open
            with contextlib.suppress(BlockingIOError, TypeError):
                keep(self.process.stdout.read(), self.name, self.process)
        self.process.stdout.close()

    def wait_ready(self):
        """Wait until the last service of gazebo_ros is registered."""
        wait_until(self._is_ready, f'the services of /{self.name}', deadline=2 * DEADLINE)
        return self

    def _is_ready(self):
        if self.process.poll() is not None:
            raise AssertionError(f'the server has ended: {self.process.stdout.read()}')
        try:
            rosgraph.Master('/test', self.master).lookupService(
                f'/{self.name}/get_world_properties'
            )
        except rosgraph.MasterError:
            return False
        return True

    def call(self, name, service_class, *fields):
        """Call a service of /gazebo, found by this server's master; return the answer."""
        with service_connection(name, service_class, self.master) as made:
            made.sendall(request_bytes(service_class._request_class(*fields)))
            return answer(made, service_class)

    def world(self):
        return self.call('get_world_properties', GetWorldProperties)

    def spawn(self, name, xml):
        """Spawn a model at the origin."""
        made = self.call('spawn_urdf_model', SpawnModel, name, xml, '/', pose(z=0.0), '')
        assert made.success, made.status_message

    def open_files(self):
        """Return the number of open file descriptors, connections included."""
        return len(os.listdir(f'/proc/{self.process.pid}/fd'))

    def threads(self):
        return len(os.listdir(f'/proc/{self.process.pid}/task'))

    def children(self):
        """Return the ids of its child processes, zombies included."""
        tasks = Path(f'/proc/{self.process.pid}/task')
        while True:
            try:
                return [
                    pid for task in tasks.glob('*/children') for pid in task.read_text().split()
                ]
            except (FileNotFoundError, ProcessLookupError):
                pass  # the thread has ended; another one has its children

    def sandbox_runs(self):
        """Return the ids of the processes in which models are being tested."""
        return [
            pid
            for child in self.children()
            for pid in Path(f'/proc/{child}/task/{child}/children').read_text().split()
        ]

    def end(self, number=signal.SIGINT):
        """End it by a signal; return its exit code and output."""
        self.process.send_signal(number)
        return self.wait()

    def wait(self):
        """Wait until it ends by itself; return its exit code and output."""
        printed, _ = self.process.communicate(timeout=2 * DEADLINE)
        keep(printed, self.name, self.process)
        return self.process.returncode, printed


class MasterProcess:
    """A ROS master on a free port; a `with` statement starts it, and gets its URI."""

    def __init__(self):
        self._port, self._process = free_port(), None
        self.address = f'http://localhost:{self._port}'

    def __enter__(self):
        return self.start()

    def __exit__(self, *_):
        if self._process is not None:
            self._process.terminate()
            self._process.wait()

    def start(self):
        """Start or restart it; return its URI."""
        self._process = subprocess.Popen(
            ['rosmaster', '--core', '-p', str(self._port)],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        wait_until(rosgraph.Master('/test', self.address).is_online, 'the ROS master')
        return self.address

    @contextlib.contextmanager
    def silenced(self):
        """Let it answer nothing for the length of a `with` statement."""
        self._process.send_signal(signal.SIGSTOP)
        try:
            yield
        finally:
            self._process.send_signal(signal.SIGCONT)

    def kill(self):
        """Kill it, like a crash."""
        self._process.kill()
        self._process.wait()


class OwnServerTest(SimulatorTest):
    """Starts a server for each test, which the test may crash."""

    program: Mapping[str, str] = {}  # other than gzserver

    def setUp(self):
        self.server = ServerProcess(**self.program)
        self.addCleanup(self.server.__exit__)
        self.server.wait_ready()
        super().setUp()

    def tearDown(self):
        if self.server.process.poll() is None:
            super().tearDown()
            self.server.end()  # so that it is unregistered

    def drive_neighbour(self):
        """Spawn a robot and command it to drive."""
        response = self.spawn('neighbour')
        self.assertTrue(response.success, response.status_message)
        drive, before = self.driver(), self.x_of('neighbour')
        # Repeated: the first may reach the subscriber of a robot just deleted.
        wait_until(lambda: drive(0.3) or self.x_of('neighbour') > before + 0.05, 'a drive')

    def assert_neighbour_drives(self):
        before = self.x_of('neighbour')
        wait_until(lambda: self.x_of('neighbour') > before + 0.05, 'motion of the neighbour')

    def assert_no_more_than(self, files, threads):
        """Wait until the server has closed further files and ended further threads."""
        wait_until(lambda: self.server.open_files() <= files, f'at most {files} open files')
        wait_until(lambda: self.server.threads() <= threads, f'at most {threads} threads')
