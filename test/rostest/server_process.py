"""A simulator that a test starts and ends itself, on the test's master or on one of its own."""

import os
import signal
import socket
import subprocess
from collections.abc import Mapping
from pathlib import Path

import rosgraph
import yaml
from simulator import DEADLINE, SimulatorTest, wait_until


class ServerProcess:
    """One program, run to its end within a `with` statement.

    Args:
        prefix: a command before its own, which ends by becoming that: `nice`, say.
    """

    def __init__(self, *arguments, program='gzserver', package='gazebo_ros', master=None,
                 prefix=(), **environment):
        self.name = next((a.removeprefix('__name:=') for a in arguments if '__name' in a), 'gazebo')
        self.master = master or os.environ['ROS_MASTER_URI']
        self.environment = {**os.environ, 'ROS_MASTER_URI': self.master, **environment}
        self.process = subprocess.Popen(
            [*prefix, 'rosrun', package, program, *arguments], env=self.environment,
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
            start_new_session=True)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if self.process.poll() is None:
            self.process.kill()
        self.process.wait()
        self.process.stdin.close()
        self.process.stdout.close()

    def wait_ready(self):
        """Wait until the last of the services is offered."""
        wait_until(self._is_ready, f'the services of /{self.name}', deadline=2 * DEADLINE)
        return self

    def _is_ready(self):
        if self.process.poll() is not None:
            raise AssertionError(f'it has ended: {self.process.stdout.read()}')
        try:
            rosgraph.Master('/test', self.master).lookupService(f'/{self.name}/unpause_physics')
        except rosgraph.MasterError:
            return False
        return True

    def call(self, service, *arguments):
        """Call a service from a process of its own, which has this server's master."""
        ended = subprocess.run(
            ['rosservice', 'call', f'/{self.name}/{service}', *arguments], env=self.environment,
            capture_output=True, text=True, timeout=DEADLINE, check=True)
        return yaml.safe_load(ended.stdout)

    def world(self):
        return self.call('get_world_properties')

    def open_files(self):
        """Return how many files and connections it holds open."""
        return len(os.listdir(f'/proc/{self.process.pid}/fd'))

    def threads(self):
        return len(os.listdir(f'/proc/{self.process.pid}/task'))

    def children(self):
        """Return the ids of its child processes, also of those that have ended unnoticed."""
        tasks = Path(f'/proc/{self.process.pid}/task')
        while True:
            try:
                return [pid for task in tasks.glob('*/children')
                        for pid in task.read_text().split()]
            except (FileNotFoundError, ProcessLookupError):
                pass  # a thread has ended, and another one has its children now

    def trials(self):
        """Return the ids of the processes in which models are tried now."""
        return [pid for child in self.children()
                for pid in Path(f'/proc/{child}/task/{child}/children').read_text().split()]

    def end(self):
        """End it as Ctrl-C does; return its exit code and what it printed."""
        self.process.send_signal(signal.SIGINT)
        return self.wait()

    def wait(self):
        """Wait until it ends by itself; return its exit code and what it printed."""
        printed, _ = self.process.communicate(timeout=2 * DEADLINE)
        return self.process.returncode, printed


class MasterProcess:
    """A ROS master on a free port, for a `with` statement that gets its address."""

    def __enter__(self):
        with socket.socket() as probe:
            probe.bind(('localhost', 0))
            self._port = probe.getsockname()[1]
        return self.start()

    def __exit__(self, *_):
        self._process.terminate()
        self._process.wait()

    def start(self):
        """Start it, also again; return its address."""
        self._process = subprocess.Popen(
            ['rosmaster', '--core', '-p', str(self._port)], stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        address = f'http://localhost:{self._port}'
        wait_until(rosgraph.Master('/test', address).is_online, 'the second master')
        return address

    def kill(self):
        """Let it die as by a crash: it says goodbye to nobody."""
        self._process.kill()
        self._process.wait()


class OwnServerTest(SimulatorTest):
    """Begins every test with a server of its own, which the test may bring down."""

    program: Mapping[str, str] = {}  # if it is not gzserver

    def setUp(self):
        self.server = ServerProcess(**self.program)
        self.addCleanup(self.server.__exit__)
        self.server.wait_ready()
        super().setUp()

    def tearDown(self):
        if self.server.process.poll() is None:
            super().tearDown()
            self.server.end()  # so that the master forgets it

    def drive_neighbour(self):
        """Spawn a robot and let it drive."""
        self.assertTrue(self.spawn('neighbour').success)
        drive, before = self.driver(), self.x_of('neighbour')
        # Again and again: the first may go to the subscriber of a robot that was deleted just now.
        wait_until(lambda: drive(0.3) or self.x_of('neighbour') > before + 0.05, 'a drive')

    def assert_neighbour_drives(self):
        before = self.x_of('neighbour')
        wait_until(lambda: self.x_of('neighbour') > before + 0.05, 'the neighbour driving on')

    def assert_no_more_than(self, files, threads):
        """Wait until the server has closed what it has opened since."""
        wait_until(lambda: self.server.open_files() <= files, f'no more than {files} files open')
        wait_until(lambda: self.server.threads() <= threads, f'no more than {threads} threads')
