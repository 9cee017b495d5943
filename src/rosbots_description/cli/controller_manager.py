"""Front ends of the executables of controller_manager: command lines in, exit codes out.

Options, help and exit codes are those of the originals.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Sequence

from .gzserver import split_remappings
from .program import fail

DONE, FAILED = 0, 1  # exit codes
_USAGE = """Commands:
    load <name>          - Load the controller named <name>
    unload <name>        - Unload the controller named <name>
    start <name>         - Start the controller named <name>
    stop <name>          - Stop the controller named <name>
    spawn <name>         - Load and start the controller named <name>
    kill <name>          - Stop and unload the controller named <name>
    list                 - List active controllers
    list-types           - List controller Types
    reload-libraries     - Reloads all plugin controller libraries"""
_SHORT = {'lt': 'list-types', 'lc': 'list', 'sp': 'spawn', 'kl': 'kill'}
# Functions of `calls` that are called for each name, one function after the other.
_BY_NAME = {
    'load': ('load_controller',),
    'unload': ('unload_controller',),
    'start': ('start_controller',),
    'stop': ('stop_controller',),
    'spawn': ('load_controller', 'start_controller'),
    'kill': ('stop_controller', 'unload_controller'),
}
_UNSPAWNER_USAGE = """./unspawner name1 name2 name3

\tStops a set of controllers until killed.
\tUseful in roslaunch files to temporarily stop controllers"""


def spawner_parser() -> argparse.ArgumentParser:
    """Return the parser of the command line of spawner."""
    parser = argparse.ArgumentParser(prog='spawner', description='Controller spawner')
    parser.add_argument(
        '--stopped', action='store_true', help='loads controllers, but does not start them'
    )
    parser.add_argument(
        '--wait-for',
        metavar='topic',
        help='waits for "True" on a topic (Bool) before it loads controllers',
    )
    parser.add_argument(
        '--namespace', metavar='ns', help='namespace of the controller_manager services'
    )
    parser.add_argument(
        '--timeout',
        metavar='T',
        type=float,
        default=30.0,
        help='how long to wait for each service at the start [s] (default: 30); '
        '0 or less: as long as it takes',
    )
    parser.add_argument('--no-timeout', action='store_true', help='the same as --timeout 0')
    parser.add_argument('--shutdown-timeout', help='accepted, without effect')
    parser.add_argument(
        'controllers',
        metavar='controller',
        nargs='+',
        help='controllers to load, or files of parameters that name them',
    )
    return parser


def group_parser() -> argparse.ArgumentParser:
    """Return the parser of the command line of controller_group."""
    parser = argparse.ArgumentParser(
        prog='controller_group', description='Controller Group Utility'
    )
    commands = parser.add_subparsers(
        title='Commands', metavar='COMMAND', dest='command', required=True
    )
    commands.add_parser('list', help='list available groups')
    for name, text in (
        ('spawn', 'load and start the controllers of a group'),
        ('switch', 'stop the other groups, and start this one'),
    ):
        commands.add_parser(name, help=text).add_argument('group', help='name of the group')
    return parser


def spawner(arguments: Sequence[str] | None = None) -> int:
    """Load and start controllers, and take them down at the end; return the exit code."""
    arguments = sys.argv[1:] if arguments is None else arguments
    options = spawner_parser().parse_args(split_remappings(arguments)[0])
    # Imported late: help and wrong usage are fast, and need no ROS.
    from ..ros_api.controller_programs import spawner as program

    return _reported('spawner', lambda: program.run(options, arguments))


def unspawner(arguments: Sequence[str] | None = None) -> int:
    """Keep controllers stopped until the end; return the exit code."""
    arguments = sys.argv[1:] if arguments is None else arguments
    names = split_remappings(arguments)[0]
    if not names or names[0] in ('-h', '--help'):
        print(_UNSPAWNER_USAGE)
        return FAILED
    from ..ros_api.controller_programs import unspawner as program

    return _reported('unspawner', lambda: program.run(names, arguments))


def manager(arguments: Sequence[str] | None = None) -> int:
    """Make calls of a controller manager, and print what comes of them; return the exit code."""
    arguments = sys.argv[1:] if arguments is None else arguments
    command, *names = split_remappings(arguments)[0] or ['']
    command = _SHORT.get(command, command)
    if command not in (*_BY_NAME, 'list', 'list-types', 'reload-libraries'):
        print(_USAGE)
        return FAILED if command else DONE

    def act() -> None:
        from ..ros_api.controller_programs import calls

        if command == 'list':
            calls.list_controllers()
        elif command == 'list-types':
            calls.list_controller_types()
        elif command == 'reload-libraries':
            calls.reload_libraries(True, restore='--restore' in names)
        else:
            for function in _BY_NAME[command]:
                for name in names:
                    getattr(calls, function)(name)

    return _run('controller_manager', arguments, act)


def group(arguments: Sequence[str] | None = None) -> int:
    """List, spawn or switch groups of controllers; return the exit code."""
    arguments = sys.argv[1:] if arguments is None else arguments
    options = group_parser().parse_args(split_remappings(arguments)[0])

    def act() -> None:
        from ..ros_api.controller_programs import groups

        if options.command == 'list':
            groups.list_groups()
        else:
            getattr(groups, options.command)(options.group)

    return _run('controller_group', arguments, act)


def _run(node: str, arguments: Sequence[str], act: Callable[[], None]) -> int:
    from ..ros_api.controller_programs import program

    return _reported(node, lambda: program.run(node, arguments, act))


def _reported(name: str, run: Callable[[], int]) -> int:
    """Return `run()`; print that ROS_MASTER_URI is wrong as one sentence."""
    from ..ros_api.transport import AddressError

    try:
        return run()
    except AddressError as error:
        return fail(name, str(error))
