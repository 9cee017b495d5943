"""Front end of the executable gz: Gazebo's commands, by the simulator's ROS interface."""

from __future__ import annotations

import argparse
import contextlib
import shutil
import signal
import subprocess
import sys
from collections.abc import Sequence

from ..sim.core import SimError
from .gzserver import split_remappings
from .number_arguments import POSE, finite, without_exponents
from .program import fail

DONE = 0  # exit code
_BY_ROSTOPIC = ('info', 'echo', 'hz', 'bw')  # options of `gz topic` that rostopic has as commands
# Commands of Gazebo without a counterpart here.
NOT_HERE = {
    'camera': 'the camera of the window is moved in RViz: its view Follow follows a model',
    'debug': 'it serves the completion of commands in Gazebo',
    'joint': 'use rosservice call /gazebo/apply_joint_effort or /gazebo/set_model_configuration',
    'log': 'record and play with rosbag',
    'marker': 'publish visualization_msgs/Marker, which RViz shows',
}


def parser() -> argparse.ArgumentParser:
    """Return the parser of gz, with the option names of Gazebo 11."""
    made = argparse.ArgumentParser(
        prog='gz',
        description='Look at the running simulation and change it.',
        epilog='gz COMMAND --help shows the options of a command.',
    )
    commands = made.add_subparsers(dest='command', metavar='COMMAND', required=True)

    def command(name: str, text: str) -> argparse.ArgumentParser:
        return commands.add_parser(name, help=text, description=f'{text[0].upper()}{text[1:]}.')

    _help(command('help', 'show this text, or that of a command'))
    _model(command('model', 'list, show, spawn, move or delete models'))
    _physics(command('physics', 'change the settings of the physics engine'))
    _sdf(command('sdf', 'check or print a description; needs no simulator'))
    _stats(command('stats', 'print real-time factor and times, five times a second'))
    _topic(command('topic', 'list the ROS topics of the simulator, or look into one'))
    _world(command('world', 'pause, step or reset the world'))
    return made


def _help(add: argparse.ArgumentParser) -> None:
    add.add_argument('about', nargs='?', metavar='COMMAND')


def _add_world_name(add: argparse.ArgumentParser) -> None:
    add.add_argument(
        '-w', '--world-name', metavar='NAME', help='accepted; a simulator has one world'
    )


def _model(add: argparse.ArgumentParser) -> None:
    add.add_argument('-m', '--model-name', metavar='NAME', help='the model; needed except with -l')
    _add_world_name(add)
    what = add.add_mutually_exclusive_group()
    what.add_argument(
        '-l', '--list', action='store_true', help='not in Gazebo: print the names of all models'
    )
    what.add_argument('-d', '--delete', action='store_true', help='delete it')
    what.add_argument(
        '-f',
        '--spawn-file',
        metavar='FILE',
        help='spawn it from an SDF or URDF file, at the pose given by -x … -Y',
    )
    what.add_argument(
        '-s', '--spawn-string', action='store_true', help='spawn it from standard input'
    )
    what.add_argument('-i', '--info', action='store_true', help='print its pose, joints and links')
    what.add_argument(
        '-p', '--pose', action='store_true', help='print its pose: x y z roll pitch yaw [m, rad]'
    )
    for letter, text in POSE:
        add.add_argument(
            f'-{letter}',
            f'--pose-{letter}',
            metavar='NUMBER',
            type=finite,
            help=f'move it, or spawn it there: {text}; those not given are 0',
        )


def _gravity(text: str) -> tuple[float, ...]:
    numbers = tuple(finite(part) for part in text.split(','))
    if len(numbers) != 3:
        raise argparse.ArgumentTypeError(f'{text!r} is not three numbers with commas, as 0,0,-9.8')
    return numbers


def _steps(text: str) -> int:
    if not text.isdecimal() or int(text) >= 2**32:
        raise argparse.ArgumentTypeError(f'{text!r} is not a number of steps')
    return int(text)


def _physics(add: argparse.ArgumentParser) -> None:
    _add_world_name(add)
    add.add_argument('-g', '--gravity', metavar='X,Y,Z', type=_gravity, help='[m/s^2]')
    add.add_argument('-s', '--step-size', metavar='SECONDS', type=finite, help='of a step [s]')
    add.add_argument(
        '-i', '--iters', metavar='NUMBER', type=_steps, help="of the solver's iterations"
    )
    add.add_argument(
        '-u',
        '--update-rate',
        metavar='HZ',
        type=finite,
        help='steps per second of wall time; 0: as many as possible',
    )


def _sdf(add: argparse.ArgumentParser) -> None:
    what = add.add_mutually_exclusive_group(required=True)
    what.add_argument(
        '-k',
        '--check',
        metavar='FILE',
        help='read a world, an SDF model or a URDF as the simulator would',
    )
    what.add_argument('-p', '--print', metavar='FILE', help='print an SDF file, or a URDF as SDF')
    for short, name in (('d', 'describe'), ('o', 'doc')):
        what.add_argument(f'-{short}', f'--{name}', action='store_true', help='not supported')
    what.add_argument('-c', '--convert', metavar='FILE', help='not supported')
    add.add_argument('-v', '--version', metavar='VERSION', help='accepted; no effect')


def _stats(add: argparse.ArgumentParser) -> None:
    _add_world_name(add)
    add.add_argument(
        '-d', '--duration', metavar='SECONDS', type=finite, help='end after this wall time'
    )
    add.add_argument('-p', '--plot', action='store_true', help='print comma-separated values')


def _topic(add: argparse.ArgumentParser) -> None:
    _add_world_name(add)
    what = add.add_mutually_exclusive_group(required=True)
    what.add_argument('-l', '--list', action='store_true', help='list all topics')
    for short, name, text in (
        ('i', 'info', 'print type, publishers and subscribers'),
        ('e', 'echo', 'print its messages'),
        ('z', 'hz', 'print its rate'),
        ('b', 'bw', 'print its bandwidth'),
    ):
        what.add_argument(f'-{short}', f'--{name}', metavar='TOPIC', help=text)
    what.add_argument('-v', '--view', nargs='?', const='', metavar='TOPIC', help='not supported')
    add.add_argument('-u', '--unformatted', action='store_true', help='accepted; no effect')
    add.add_argument(
        '-d', '--duration', metavar='SECONDS', type=finite, help='end after this wall time'
    )


def _world(add: argparse.ArgumentParser) -> None:
    _add_world_name(add)
    add.add_argument('-p', '--pause', type=int, choices=(0, 1), help='1: pause, 0: continue')
    add.add_argument('-s', '--step', action='store_true', help='pause, then make one step')
    add.add_argument(
        '-m', '--multi-step', metavar='N', type=_steps, help='pause, then make N steps'
    )
    add.add_argument('-r', '--reset-all', action='store_true', help='reset time and models')
    add.add_argument('-t', '--reset-time', action='store_true', help='not supported')
    add.add_argument('-o', '--reset-models', action='store_true', help='reset the models')


def main(arguments: Sequence[str] | None = None) -> int:
    """Run a command of gz.

    Returns:
        Exit code: 0 done, 1 failed or not supported (one sentence says why), 2 wrong usage.
    """
    own, remappings = split_remappings(sys.argv[1:] if arguments is None else arguments)
    command = next((word for word in own if word != 'help'), '')
    if command in NOT_HERE:
        return fail(
            f'gz {command}', f'this command of Gazebo is not supported; {NOT_HERE[command]}'
        )
    options = parser()
    flags = options.parse_args(without_exponents(own))
    if flags.command == 'help':
        options.parse_args(['--help'] if flags.about is None else [flags.about, '--help'])
    if flags.command == 'sdf':
        return _describe(flags)
    if flags.command == 'topic' and not flags.list:
        return _look_into_topic(flags)
    _require_something(options, flags)
    # Imported late: help and wrong usage are fast, and need no ROS.
    from ..ros_api.clients import gz

    return gz.run(flags.command, flags, remappings)


def _require_something(options: argparse.ArgumentParser, flags: argparse.Namespace) -> None:
    """End with 2 if the options do not say what to do."""
    # 0 is given, too
    given = {
        name for name, value in vars(flags).items() if value is not None and value is not False
    }
    given -= {'command', 'world_name'}
    if flags.command == 'model' and not flags.list and flags.model_name is None:
        options.error('model: the name of a model is needed: -m NAME')
    if not given - {'model_name'} and flags.command != 'stats':
        options.error(f'{flags.command}: nothing to do; see gz {flags.command} --help')


def _describe(flags: argparse.Namespace) -> int:
    """Check or print a description."""
    from ..ros_api.node import description_file  # loads all parsers

    if flags.check is None and flags.print is None:
        return fail(
            'gz sdf',
            'of the options only -k and -p are supported; SDF is specified at '
            'http://sdformat.org/spec',
        )
    try:
        if flags.print is not None:
            sys.stdout.write(f'{description_file.sdf_text(flags.print)}\n')
            return DONE
        faults = description_file.check_description(flags.check)
    except SimError as error:
        return fail('gz sdf', str(error))
    if faults:  # each has been logged
        return fail('gz sdf', f'{flags.check} is read without {len(faults)} of its parts')
    sys.stdout.write('Check complete\n')
    return DONE


def _look_into_topic(flags: argparse.Namespace) -> int:
    """Let rostopic show a topic, for the duration that is given."""
    verb = next((name for name in _BY_ROSTOPIC if getattr(flags, name)), None)
    if verb is None:
        return fail(
            'gz topic', 'no viewer is supported (-v); use rostopic echo, RViz or image_view'
        )
    program = shutil.which('rostopic')
    if program is None:
        return fail(
            'gz topic', 'rostopic is not installed; on Debian: apt install python3-rostopic'
        )
    shown = subprocess.Popen([program, verb, getattr(flags, verb)])
    with contextlib.suppress(subprocess.TimeoutExpired):
        return shown.wait(flags.duration)
    shown.send_signal(signal.SIGINT)  # it then unregisters from the master
    shown.wait()
    return DONE
