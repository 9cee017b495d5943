"""Front end of rosbots-view: a robot or world in the browser, without ROS."""

import argparse
import importlib.util
import re
import signal
import sys
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager, nullcontext
from functools import partial
from typing import TYPE_CHECKING, NoReturn

from .page_token import add_options, announced, open_site
from .program import fail, run, say
from .web_browser import opened

if TYPE_CHECKING:
    from ..sim.core import Fault

NAME = 'rosbots-view'
_say, _fail = partial(say, NAME), partial(fail, NAME)
MOST_FAULTS = 20  # that are printed
ARGUMENT = re.compile(r'(\w+):=(.*)', re.DOTALL)


def parser() -> argparse.ArgumentParser:
    """Return the parser of the options."""
    made = argparse.ArgumentParser(
        prog=NAME,
        allow_abbrev=False,
        formatter_class=argparse.ArgumentDefaultsHelpFormatter,
        description='Show a robot or a world in the browser: see it, move its joints, drive it, '
        'read its sensors. Ctrl-C ends.',
    )
    made.add_argument(
        'file',
        help='a URDF, xacro, SDF or world file, or the name of a world: '
        'empty, room, rooms, maze, line, shapes',
    )
    made.add_argument('arguments', nargs='*', metavar='NAME:=VALUE', help='arguments of xacro')
    add_options(made)
    made.add_argument('--port', type=int, default=0, help='0 for any that is free')
    made.add_argument('--paused', action='store_true', help='begin paused')
    made.add_argument('--no-open', action='store_true', help='print the address only')
    return made


def main(arguments: Sequence[str] | None = None) -> int:
    """Serve the page until Ctrl-C; return the exit code."""
    options = parser().parse_args(arguments)
    values = {}
    for given in options.arguments:
        match = ARGUMENT.fullmatch(given)
        if match is None:
            return _fail(f"'{given}' is no argument of xacro; write NAME:=VALUE")
        values[match[1]] = match[2]
    if importlib.util.find_spec('viser') is None:
        return _fail(
            'no page: the Python package viser is not installed; '
            "pip install 'rosbots_description[web]' or ./rosbots setup web does that"
        )
    return _serve(options, values)


def _serve(options: argparse.Namespace, values: dict[str, str]) -> int:
    """Serve the page of the file that `options` name; return the exit code."""
    from ..sim.core import SimError
    from ..viewer import Viewer, open_file, open_sandbox
    from ..web import LOOPBACK, WindowError

    with open_sandbox() as sandbox:
        try:
            site = open_site(options)
        except WindowError as error:
            return _fail(str(error))
        try:
            world = open_file(options.file, values, sandbox)
        except (SimError, OSError) as error:
            site.stop()
            return _fail(str(error))
        _list(world.faults)
        if options.host not in LOOPBACK:
            _say(
                'whoever has this address sees and controls the simulation, and the connection is '
                'not encrypted'
            )
        with world, _until_terminated():
            viewer = Viewer(world, site, paused=options.paused, sandbox=sandbox)
            with (
                announced(NAME, site.address, site.viewing_address),
                nullcontext() if options.no_open else opened(site.address),
            ):
                viewer.serve_until_interrupted()
        return 0


def script() -> NoReturn:
    """Run as the script that pip installs."""
    sys.exit(run(main))


def _list(faults: 'Iterable[Fault]') -> None:
    """Print what is wrong with the file, the worst first."""
    from ..sim.core import worst_first

    sentences = list(dict.fromkeys(map(str, worst_first(faults))))
    for sentence in sentences[:MOST_FAULTS]:
        _say(sentence)
    if len(sentences) > MOST_FAULTS:
        _say(f'and {len(sentences) - MOST_FAULTS} more')


@contextmanager
def _until_terminated() -> Iterator[None]:
    """End as by Ctrl-C when the process is terminated."""
    before = signal.signal(signal.SIGTERM, signal.default_int_handler)
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, before)


if __name__ == '__main__':
    script()
