"""The simulator's command line, compatible with Gazebo's gzserver."""

import argparse
import gc
import logging
import signal
import sys
from collections.abc import Sequence
from importlib.util import find_spec

from ..sim.core import SimError
from .program import fail

EMPTY_WORLD = 'worlds/empty.world'
ENGINE = 'ode'
_VERSION = "gzserver of rosbots_description: Gazebo 11's ROS interface, by PyBullet"
# Requirement to install for a missing module, as in requirements/core.pip.
_INSTALLED_BY = {
    'pybullet': 'pybullet==3.2.7',
    'collada': 'pycollada==0.9.3',
}


def parser() -> argparse.ArgumentParser:
    """Return the parser of gzserver's options."""
    made = argparse.ArgumentParser(
        prog='gzserver',
        description='Simulate a world, physics by PyBullet, behind the ROS interface of Gazebo.',
    )
    add = made.add_argument
    add(
        'world',
        nargs='?',
        default=EMPTY_WORLD,
        help='world file, by path or along GAZEBO_RESOURCE_PATH; included are worlds/empty.world, '
        f'line, maze, room, rooms and shapes; default {EMPTY_WORLD}',
    )
    add('-u', '--pause', action='store_true', help='start paused')
    add(
        '-e',
        '--physics',
        metavar='ENGINE',
        default=ENGINE,
        help='accepted for compatibility; the engine is always PyBullet',
    )
    add(
        '--seed',
        type=int,
        metavar='NUMBER',
        default=0,
        help='of the noise of sensors; the same seed gives the same run, default 0',
    )
    add('--iters', type=_count, metavar='NUMBER', help='exit after this number of steps')
    add('--verbose', action='store_true', help='log debug messages too')
    add('-r', '--record', action='store_true', help='not supported')
    for name in ('encoding', 'path', 'period', 'filter'):
        add(f'--record_{name}', metavar=name.upper(), help='not supported')
    add('--record_resources', action='store_true', help='not supported')
    add('-p', '--play', metavar='FILE', help='not supported')
    add('-o', '--profile', metavar='NAME', help="accepted; the world's default physics is used")
    add('--lockstep', action='store_true', help='accepted; sensors are always in lockstep')
    add(
        '-s',
        '--server-plugin',
        action='append',
        metavar='FILE',
        default=[],
        help='accepted; the plugins of gazebo_ros are built in',
    )
    add('--minimal_comms', action='store_true', help='accepted; no effect')
    add(
        '--replace',
        action='store_true',
        help='not in Gazebo: shut down and replace a simulator on the same ROS master',
    )
    add('-v', '--version', action='version', version=_VERSION, help='print the version and exit')
    return made


def _count(text: str) -> int:
    number = int(text)
    if number < 0:
        raise argparse.ArgumentTypeError(f'{text} is negative; the number of steps is 0 or more')
    return number


def split_remappings(arguments: Sequence[str]) -> tuple[list[str], list[str]]:
    """Return the program's own arguments and ROS's remappings, which contain `:=`."""
    own = [argument for argument in arguments if ':=' not in argument]
    return own, [argument for argument in arguments if ':=' in argument]


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the simulator; return its exit code."""
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    try:
        return _main(sys.argv[1:] if arguments is None else arguments)
    except KeyboardInterrupt:
        return 0


def _main(arguments: Sequence[str]) -> int:
    own, remappings = split_remappings(arguments)
    given, unknown = parser().parse_known_args(own)
    for module, package in _INSTALLED_BY.items():
        if not _is_installed(module):
            return fail(
                'gzserver',
                f'the Python module {module} is missing; install it for {sys.executable} with: '
                f'pip install {package}',
            )
    gc.disable()  # modules are never freed; collecting during imports costs time
    from ..ros_api.node import node  # imports the modules checked above

    gc.freeze()
    gc.enable()
    options = node.Options(
        given.world,
        given.pause,
        given.iters,
        remarks(given, unknown),
        given.verbose,
        given.replace,
        given.seed,
    )
    try:
        return node.run(options, remappings)
    except SimError as error:
        return fail('gzserver', str(error))


def _is_installed(module: str) -> bool:
    """Tell whether a module is installed, without importing it."""
    try:
        return find_spec(module) is not None
    except ValueError:  # the module is blocked in sys.modules
        return False


def remarks(given: argparse.Namespace, unknown: Sequence[str]) -> tuple[tuple[int, str], ...]:
    """Return messages on options without effect here, each with its log level."""
    found = []
    if unknown:
        found.append((logging.WARNING, f'unknown options are ignored: {" ".join(unknown)}'))
    if given.physics != ENGINE:
        found.append(
            (
                logging.INFO,
                f"physics engine '{given.physics}' is not available; PyBullet is used, with the "
                'parameters of ode',
            )
        )
    if any(value for name, value in vars(given).items() if name.startswith('record')):
        found.append((logging.WARNING, 'recording (-r) is not supported; use rosbag'))
    if given.play:
        found.append((logging.WARNING, f'playing {given.play} (-p) is not supported; use rosbag'))
    if given.profile:
        found.append(
            (
                logging.WARNING,
                f"--profile {given.profile} is not supported: the world's default physics is used",
            )
        )
    return tuple(found)
