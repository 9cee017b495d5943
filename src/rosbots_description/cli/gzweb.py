"""Front end of the executable gzweb: the simulated world in a browser."""

import argparse
import importlib.util
import sys
import time
from collections.abc import Sequence

from .gzserver import split_remappings

HOST, PORT = '127.0.0.1', 8080
PERIOD = 0.5  # between looks at the simulator [s, wall]
NAME = 'gzweb'


def parser() -> argparse.ArgumentParser:
    """Return the parser of gzweb's options."""
    made = argparse.ArgumentParser(
        prog=NAME, description='See and control the simulated world in a browser.',
        formatter_class=argparse.ArgumentDefaultsHelpFormatter)
    made.add_argument('--host', default=HOST,
                      help='address to serve at; 0.0.0.0 is all of this machine, which lets in '
                           'everybody who has the address with its token')
    made.add_argument('--port', type=int, default=PORT, help='0 for any that is free')
    made.add_argument('--token', default='', help='what the address ends with, unless --host is '
                                                  'this machine; made at random if not given')
    return made


def main(arguments: Sequence[str] | None = None) -> int:
    """Serve the window until the node is shut down; return the exit code."""
    own, remappings = split_remappings(sys.argv[1:] if arguments is None else arguments)
    options = parser().parse_args(own)
    if importlib.util.find_spec('viser') is None:
        return _fail('no window: the Python package viser is not installed; '
                     './rosbots setup web or pip install viser==1.1.1 does that')
    from ..ros_api.transport import (
        AddressError,
        Registrar,
        connect_logging,
        is_running,
        start_node,
        watch_master,
    )
    from ..ros_api.window import GazeboSimulator
    from ..web import Page, Site, WindowError

    try:
        site = Site(options.host, options.port, options.token)
        start_node(NAME, remappings, wall_time=True)
    except (WindowError, AddressError) as error:
        return _fail(str(error))
    connect_logging(time.time_ns)
    watch_master(Registrar(), ())
    if site.token:
        _say('whoever has this address sees and controls the simulation, and the connection is '
             'not encrypted')
    page = Page(site, GazeboSimulator())
    _say(f'the world is at {site.address}')
    while is_running():
        page.poll()
        time.sleep(PERIOD)
    site.stop()
    return 0


def _fail(sentence: str) -> int:
    _say(sentence)
    return 1


def _say(sentence: str) -> None:
    sys.stderr.write(f'{NAME}: {sentence}\n')
