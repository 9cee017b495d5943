"""A simulator that a test starts and ends itself, on the test's master or on one of its own."""

import os
import signal
import socket
import subprocess

import rosgraph
import yaml
from simulator import DEADLINE, wait_until


class ServerProcess:
    """One program of gazebo_ros, run to its end within a `with` statement."""

    def __init__(self, *arguments, program='gzserver', master=None, **environment):
        self.name = next((a.removeprefix('__name:=') for a in arguments if '__name' in a), 'gazebo')
        self.master = master or os.environ['ROS_MASTER_URI']
        self._environment = {**os.environ, 'ROS_MASTER_URI': self.master, **environment}
        self.process = subprocess.Popen(
            ['rosrun', 'gazebo_ros', program, *arguments], env=self._environment,
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
        try:
            rosgraph.Master('/test', self.master).lookupService(f'/{self.name}/unpause_physics')
        except rosgraph.MasterError:
            return False
        return True

    def call(self, service, *arguments):
        """Call a service from a process of its own, which has this server's master."""
        ended = subprocess.run(
            ['rosservice', 'call', f'/{self.name}/{service}', *arguments], env=self._environment,
            capture_output=True, text=True, timeout=DEADLINE, check=True)
        return yaml.safe_load(ended.stdout)

    def world(self):
        return self.call('get_world_properties')

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
            port = probe.getsockname()[1]
        self._process = subprocess.Popen(
            ['rosmaster', '--core', '-p', str(port)], stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        address = f'http://localhost:{port}'
        wait_until(rosgraph.Master('/test', address).is_online, 'the second master')
        return address

    def __exit__(self, *_):
        self._process.terminate()
        self._process.wait()
