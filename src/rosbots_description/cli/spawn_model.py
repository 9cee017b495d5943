"""Front end of the executable spawn_model: parses the command line, runs the ROS client."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence

from .number_arguments import POSE, finite, without_exponents


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog='spawn_model', description='Put a robot or an object into the running simulation.'
    )
    form = parser.add_mutually_exclusive_group(required=True)
    form.add_argument('-urdf', action='store_true', help='the XML is URDF')
    form.add_argument('-sdf', action='store_true', help='the XML is SDF')
    source = parser.add_mutually_exclusive_group(required=True)
    source.add_argument('-file', metavar='FILE', help='read the XML from a file')
    source.add_argument('-param', metavar='NAME', help='read the XML from a ROS parameter')
    source.add_argument(
        '-database',
        metavar='MODEL',
        help="take MODEL from the simulator's model path; nothing is fetched",
    )
    source.add_argument('-stdin', action='store_true', help='read the XML from standard input')
    parser.add_argument(
        '-model', metavar='NAME', required=True, help='name of the model in the simulation'
    )
    parser.add_argument(
        '-reference_frame',
        metavar='ENTITY',
        default='',
        help='entity in whose frame the pose is given; default: the world',
    )
    parser.add_argument(
        '-gazebo_namespace',
        metavar='NS',
        default='/gazebo',
        help='namespace of the simulator; default: %(default)s',
    )
    parser.add_argument(
        '-robot_namespace',
        metavar='NS',
        help="namespace for the model's plugins; default: that of this node",
    )
    parser.add_argument('-unpause', action='store_true', help='let physics run afterwards')
    parser.add_argument('-wait', metavar='NAME', help='first wait until this model is there')
    for flag, meaning in POSE:
        parser.add_argument(
            f'-{flag}', metavar='NUMBER', type=finite, default=0.0, help=f'{meaning}; default: 0'
        )
    parser.add_argument(
        '-J',
        dest='joints',
        metavar=('JOINT', 'POSITION'),
        nargs=2,
        action='append',
        default=[],
        help='start position of a joint [rad or m]; may be repeated',
    )
    parser.add_argument(
        '-package_to_model', action='store_true', help='turn package:// of meshes into model://'
    )
    parser.add_argument(
        '-b',
        dest='bond',
        action='store_true',
        help='stay, and delete the model when this program ends',
    )
    return parser


def parse_arguments(arguments: Sequence[str]) -> argparse.Namespace:
    """Read the flags (without the program's name); ROS remappings are skipped.

    Returns:
        The flags by name; positions in m, angles in rad.
    Raises:
        SystemExit: code 2 with usage on stderr for invalid flags, code 0 for -h.
    """
    own = [text for text in arguments if ':=' not in text]
    return _parser().parse_args(without_exponents(own))


def main(arguments: Sequence[str] | None = None) -> int:
    """Spawn the model that the command line describes.

    Returns:
        Exit code: 0 done, 1 failed (the reason is logged), 2 wrong usage (by SystemExit),
        130 interrupted.
    """
    arguments = sys.argv[1:] if arguments is None else arguments
    flags = parse_arguments(arguments)
    # Imported late, so that -h and usage errors are fast and need no ROS.
    from ..ros_api.clients import spawn_model

    return spawn_model.run(flags, arguments)
