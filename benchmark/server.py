"""A whole server for the benchmarks: roscore and gzserver with a separate ROS master.

A process can use only one ROS master in its lifetime, so run each server within
`run_in_new_process`.
"""

from __future__ import annotations

import logging
import os
import socket
import subprocess
import time
from collections.abc import Callable, Sequence
from concurrent.futures import ProcessPoolExecutor
from contextlib import ExitStack
from multiprocessing import get_context
from pathlib import Path
from typing import TypeVar

import rosgraph
import rospy
from article import FORWARD, OUTPUT, robot_urdf
from gazebo_msgs.srv import (
    DeleteModel,
    GetPhysicsProperties,
    GetWorldProperties,
    SetPhysicsProperties,
    SetPhysicsPropertiesRequest,
    SpawnModel,
)
from geometry_msgs.msg import Point, Pose, Quaternion, Twist
from std_srvs.srv import Empty

from rosbots_description.cli.launched import Launched

PATIENCE = 120.0  # [s, wall] timeout of what usually takes a second, on a busy machine, too
EMPTY_WORLD = ('gazebo_ros', 'empty_world.launch', 'gui:=false')
DISTANCE = 3.0  # [m] between robots
STEPS_PER_SECOND = 1000.0  # at real time
USER_TIME, SYSTEM_TIME, STARTED = 11, 12, 19  # fields of /proc/PID/stat after the name
COMMANDS = 'cmd_vel'  # below a robot's namespace, where the article's robot has /part2_cmr/cmd_vel


Result = TypeVar('Result')


def run_in_new_process(function: Callable[..., Result], *arguments: object) -> Result:
    """Return the result of a module-level function called in a new process."""
    with ProcessPoolExecutor(1, get_context('spawn')) as pool:
        return pool.submit(function, *arguments).result()


class Server:
    """The server of `roslaunch gazebo_ros empty_world.launch gui:=false`, with its own master.

    This process is the node /benchmark, which does not subscribe to /clock.
    `seconds_to_process` and `seconds_to_spawn_service` [s, wall] are the times from roslaunch to
    the start of gzserver and to its spawn service.
    """

    def __init__(
        self, *arguments: str, launch: Sequence[str] = EMPTY_WORLD, roscore: bool = False
    ) -> None:
        """Start the server and wait for its services.

        Args:
            arguments: further arguments for roslaunch.
            launch: package, launch file and its arguments; or the path of a launch file.
            roscore: start a roscore first; otherwise roslaunch starts the master.
        """
        os.environ.update(
            ROS_MASTER_URI=f'http://localhost:{free_port()}', ROS_HOSTNAME='localhost'
        )
        logging.getLogger('rosout').setLevel(logging.WARNING)
        with ExitStack() as processes:  # ended here if one fails to start
            if roscore:
                port = os.environ['ROS_MASTER_URI'].rsplit(':', 1)[1]
                processes.enter_context(launched('roscore', '--core', '-p', port))
                wait_until(lambda: _is_registered('/rosout/get_loggers'), 'roscore')
            begin, begin_after_boot = time.monotonic(), time.clock_gettime(time.CLOCK_BOOTTIME)
            process = processes.enter_context(launched('server', *launch, *arguments))
            try:
                self.seconds_to_spawn_service = self._wait_for('spawn_urdf_model') - begin
                self._wait_for('step')  # the last one
            except TimeoutError:
                raise TimeoutError(f'no simulator: {process.error()}') from None
            self._processes = processes.pop_all()
        rospy.init_node('benchmark', disable_rostime=True, disable_signals=True)
        self._world = self.service('get_world_properties', GetWorldProperties)
        self._pause = self.service('pause_physics', Empty)
        self._unpause = self.service('unpause_physics', Empty)
        self._spawn = self.service('spawn_urdf_model', SpawnModel)
        self._delete = self.service('delete_model', DeleteModel)
        self._urdf = robot_urdf(command_topic=COMMANDS)
        self._drivers: list[rospy.Publisher] = []
        self.process = _process_of('/gazebo')
        self.seconds_to_process = self._in_seconds(STARTED) - begin_after_boot

    def __enter__(self) -> Server:
        return self

    def __exit__(self, *_exception: object) -> None:
        rospy.signal_shutdown('measured')
        self._processes.close()

    def service(self, name: str, service_class: type) -> rospy.ServiceProxy:
        """Return a proxy of one of its services with a persistent connection."""
        return rospy.ServiceProxy(f'/gazebo/{name}', service_class, persistent=True)

    def simulated(self) -> float:
        """Return the simulated time [s]."""
        return float(self._world().sim_time)

    def unthrottle(self) -> None:
        """Step as fast as possible."""
        now = self.service('get_physics_properties', GetPhysicsProperties)()
        self.service('set_physics_properties', SetPhysicsProperties)(
            SetPhysicsPropertiesRequest(now.time_step, 0.0, now.gravity, now.ode_config)
        )

    def speed(self, window: float) -> float:
        """Return the steps per second over a window [s, wall]; it is paused before and after."""
        self.unpause()
        begin, simulated = time.monotonic(), self.simulated()
        time.sleep(window)
        end, simulated = time.monotonic(), self.simulated() - simulated
        self.pause()
        return STEPS_PER_SECOND * simulated / (end - begin)

    def pause(self) -> None:
        """Pause physics."""
        self._pause()

    def unpause(self) -> None:
        """Unpause physics."""
        self._unpause()

    def spawn(self, urdf: str | None = None, height: float = 0.5) -> float:
        """Spawn one more robot beside the others; return the duration of the call [s].

        Args:
            urdf: of another robot than the article's, which obeys cmd_vel.
            height: of the robot's frame [m].
        """
        number = len(self._drivers)
        place = Pose(Point(0.0, DISTANCE * number, height), Quaternion(0.0, 0.0, 0.0, 1.0))
        begin = time.monotonic()
        answer = self._spawn(f'robot{number}', urdf or self._urdf, f'robot{number}', place, '')
        took = time.monotonic() - begin
        if not answer.success:
            raise RuntimeError(answer.status_message)
        self._drivers.append(rospy.Publisher(f'/robot{number}/{COMMANDS}', Twist, queue_size=1))
        return took

    def spawn_urdf(self, name: str, text: str, x: float = 0.0) -> None:
        """Spawn a model from URDF text at (x, 0, 0) [m]."""
        place = Pose(Point(x, 0.0, 0.0), Quaternion(0.0, 0.0, 0.0, 1.0))
        answer = self._spawn(name, text, '/', place, '')
        if not answer.success:
            raise RuntimeError(answer.status_message)

    def wait_simulated(self, seconds: float) -> None:
        """Wait until `seconds` of simulated time have passed."""
        end, deadline = self.simulated() + seconds, time.monotonic() + PATIENCE
        while self.simulated() < end:
            if time.monotonic() > deadline:
                raise TimeoutError(f'{seconds:g} s of simulated time not within {PATIENCE:g} s')
            time.sleep(0.01)

    def drive(self, forward: float = FORWARD, turning: float = 0.0) -> None:
        """Command all robots to drive at `forward` [m/s] and to turn at `turning` [rad/s]."""
        command = Twist()
        command.linear.x, command.angular.z = forward, turning
        for driver in self._drivers:
            wait_until(driver.get_num_connections, f'a subscriber of {driver.name}')
            driver.publish(command)

    def cpu_seconds(self) -> float:
        """Return the processor time of the server and its children so far [s]."""
        children = Path(f'/proc/{self.process}/task/{self.process}/children').read_text('ascii')
        return sum(
            self._in_seconds(field, process)
            for field in (USER_TIME, SYSTEM_TIME)
            for process in (self.process, *map(int, children.split()))
        )

    def _in_seconds(self, field: int, process: int = 0) -> float:
        """Return a time [s] from /proc/PID/stat; fields count from the one after the name."""
        stat = Path(f'/proc/{process or self.process}/stat').read_text(encoding='ascii')
        return int(stat.rsplit(')', 1)[1].split()[field]) / os.sysconf('SC_CLK_TCK')

    def memory(self) -> float:
        """Return the resident memory of the server [MB]."""
        pages = Path(f'/proc/{self.process}/statm').read_text(encoding='ascii').split()[1]
        return int(pages) * os.sysconf('SC_PAGE_SIZE') / 1e6

    def _wait_for(self, service: str) -> float:
        """Wait until a service is registered; return the time [s, monotonic]."""
        wait_until(lambda: _is_registered(f'/gazebo/{service}'), f'/gazebo/{service}')
        return time.monotonic()


def launched(name: str, *arguments: str) -> Launched:
    """Start roslaunch, with its output in a file of that name."""
    OUTPUT.mkdir(parents=True, exist_ok=True)
    return Launched(arguments, OUTPUT / f'{name}.log', os.environ)


def _is_registered(service: str) -> bool:
    try:
        return bool(rosgraph.Master('/benchmark').lookupService(service))
    except (OSError, rosgraph.MasterError):
        return False


def wait_until(condition: Callable[[], object], what: str) -> None:
    """Wait until a condition holds.

    Raises:
        TimeoutError: it did not hold within `PATIENCE`.
    """
    end = time.monotonic() + PATIENCE
    while not condition():
        if time.monotonic() > end:
            raise TimeoutError(f'not within {PATIENCE:g} s: {what}')
        time.sleep(0.01)


def free_port() -> int:
    """Return the number of a port of this machine that nobody uses yet."""
    with socket.socket() as probe:
        probe.bind(('localhost', 0))
        return int(probe.getsockname()[1])


def _process_of(node: str) -> int:
    listing = subprocess.run(['rosnode', 'info', node], capture_output=True, text=True, check=True)
    return int(listing.stdout.rsplit('Pid:', 1)[1].split()[0])
