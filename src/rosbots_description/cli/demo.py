"""Show the whole project in half a minute: world, robot, a short drive, deletion, second spawn."""

from __future__ import annotations

import argparse
import os
import re
import signal
import socket
import sys
import time
import warnings
from collections.abc import Mapping
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING

from .demo_report import (
    DRIVE,
    SPEED_RATIO,
    TURN_RATIO,
    Row,
    complaint,
    real_time_factor,
    steady_motion,
    table,
)
from .launched import Launched
from .program import INTERRUPTED, fail, run

if TYPE_CHECKING:
    from ..ros_api.clients.demo import DemoClient

_MODEL = 'rosbots'
PATH_PICTURE, ROBOT_PICTURE = 'path.png', 'robot.png'
_START = _SPAWN = 120.0  # [s] wall time that ends a hopeless wait, however busy the machine is
_POLL = 0.1  # [s] wall time between two looks at a log
_LANDED = -0.10  # [m] the wheels touch the ground when base_footprint is at -0.12

_DRIVE_IT_YOURSELF = """\
Drive it yourself, each line in a terminal of its own:
  ./rosbots launch gazebo_ros empty_world.launch
  ./rosbots launch rosbots_description spawn.launch
  ./rosbots exec rosrun teleop_twist_keyboard teleop_twist_keyboard.py /cmd_vel:=/part2_cmr/cmd_vel
"""


class DemoError(RuntimeError):
    """A step of the demo failed; the text is one sentence for the user."""


def main(argv: list[str] | None = None) -> int:
    """Run the demo; return the exit code: 0 done, 1 a step failed, 130 interrupted."""
    parser = argparse.ArgumentParser(prog='./rosbots demo', description=__doc__)
    parser.add_argument(
        '--output',
        type=Path,
        default=Path('demo_output'),
        metavar='FOLDER',
        help='where pictures and logs go; default: %(default)s',
    )
    parser.add_argument(
        '--web',
        action='store_true',
        help='show it in a browser as well; in a terminal it stays until Enter',
    )
    arguments = parser.parse_args(argv)
    # SIGTERM and SIGHUP end the demo and all its processes, as Ctrl-C does
    for number in (signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, signal.default_int_handler)
    try:
        _run(arguments.output, arguments.web)
    except KeyboardInterrupt:
        print('\ndemo: interrupted; all its processes have ended', file=sys.stderr)
        return INTERRUPTED
    except (DemoError, OSError) as error:
        return fail('demo', str(error))
    print(_DRIVE_IT_YOURSELF, end='')
    return 0


def _run(folder: Path, web: bool) -> None:
    """Run all steps in order.

    Args:
        web: whether to show the world in a browser.
    Raises:
        DemoError, OSError: a step failed.
    """
    folder.mkdir(parents=True, exist_ok=True)
    environment = _private_environment(folder)
    os.environ.update(environment)  # for our own node
    # matplotlib says so where Debian's is installed, too, and hides the parts for three dimensions.
    warnings.filterwarnings('ignore', 'Unable to import Axes3D')
    # Imported late, so that --help is fast.
    from ..ros_api.clients.demo import DemoClient
    from .demo_plot import save_picture

    with ExitStack() as stack:
        _say('starting the simulator with an empty world')
        server = stack.enter_context(
            Launched(
                [
                    'gazebo_ros',
                    'empty_world.launch',
                    'gui:=false',
                    'server_required:=true',
                    f'web:={str(web).lower()}',
                    'web_port:=0',
                ],
                folder / 'simulator.log',
                environment,
            )
        )
        try:
            client = DemoClient(_MODEL, _START, lambda: server.running)
        except TimeoutError as error:
            raise DemoError(f'{error}: {server.error()}') from error
        stack.callback(client.close)
        if web:
            _say(window_line(server.log))
        _say('spawning the robot')
        _spawn(client, folder / 'spawn.log', environment)
        _say(
            f'driving it for {sum(segment.duration for segment in DRIVE):g} s: '
            + ', '.join(segment.name for segment in DRIVE)
        )
        rows = _drive(client, folder)
        _say("taking its picture with the simulator's own camera")
        save_picture(folder / ROBOT_PICTURE, client.look_at_robot())
        _say('deleting it, and spawning it a second time')
        client.delete()
        if client.present():
            raise DemoError('the robot is still there after it was deleted')
        _spawn(client, folder / 'second_spawn.log', environment)
        _report(rows, folder)
        if web and sys.stdin.isatty():
            print('The browser shows the robot until you press Enter. ', end='', flush=True)
            sys.stdin.readline()  # as input(), but the end of input is no error


def window_line(log: Path, timeout: float = _START) -> str:
    """Return what gzweb says first: its address, or why there is none.

    Args:
        log: of the launch file.
        timeout: [s, wall]
    """
    end = time.monotonic() + timeout
    while time.monotonic() < end:
        said = re.findall(r'^gzweb: (.+)', log.read_text(errors='replace'), re.MULTILINE)
        if said:
            return str(said[0])
        time.sleep(_POLL)
    return f'there is no window in the browser after {timeout:g} s (see {log})'


def _private_environment(folder: Path) -> dict[str, str]:
    """Return an environment with a separate ROS master, so that no running one is disturbed."""
    with socket.socket() as probe:
        probe.bind(('localhost', 0))
        port = probe.getsockname()[1]
    environment = {
        name: value for name, value in os.environ.items() if name not in ('ROS_IP', 'ROS_NAMESPACE')
    }
    environment.update(
        ROS_MASTER_URI=f'http://localhost:{port}',
        ROS_HOSTNAME='localhost',
        ROS_LOG_DIR=str(folder.resolve() / 'ros_log'),
    )
    return environment


def _spawn(client: DemoClient, log: Path, environment: Mapping[str, str]) -> None:
    """Spawn the robot by its launch file, and wait until it is on the ground and subscribes."""
    from ..ros_api.clients.demo import wait_until

    with Launched(['rosbots_description', 'spawn.launch'], log, environment) as spawn:
        done = spawn.wait(_SPAWN)
    if not done or not client.present():
        raise DemoError(f'the robot was not spawned: {spawn.error()}')
    client.wait_for_plugin()
    wait_until(lambda: client.height() < _LANDED, _SPAWN, 'the robot to reach the ground')


def _drive(client: DemoClient, folder: Path) -> list[Row]:
    """Drive all segments, write the picture and return the measurements."""
    from .demo_plot import plot_path

    rows, path, odometry = [], [], []
    for segment in DRIVE:
        truth, reported = client.drive(segment.speed, segment.turn_rate, segment.duration)
        path.append((segment, truth))
        odometry += reported
        try:
            rows.append(
                Row(segment, steady_motion(reported), steady_motion(truth), real_time_factor(truth))
            )
        except (ValueError, IndexError) as error:
            raise DemoError(
                f'too little was measured in the part "{segment.name}": {error}'
            ) from error
        sentence = complaint(rows[-1])
        if sentence:
            raise DemoError(sentence)
    plot_path(folder / PATH_PICTURE, path, odometry)
    return rows


def _report(rows: list[Row], folder: Path) -> None:
    print(
        f'\n{table(rows)}\n\n'
        'Mean speeds once steady. The wheels are smaller (0.46 m) and closer (0.88 m) than the\n'
        "robot's plugin expects (0.52 m, 1.1 m), so without slip it drives at "
        f'{SPEED_RATIO:.3f} of\nthe commanded speed and turns at {TURN_RATIO:.3f} of the '
        'commanded rate. Gazebo has the\nsame mismatch.\n\n'
        f'Pictures: {folder / PATH_PICTURE} and {folder / ROBOT_PICTURE}\n'
    )


_started = time.monotonic()


def _say(text: str) -> None:
    print(f'[{time.monotonic() - _started:4.1f} s] {text}', flush=True)


if __name__ == '__main__':
    sys.exit(run(main))
