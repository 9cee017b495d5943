"""Front end of the executable gzweb: the simulated world in a browser."""

import argparse
import gc
import importlib.util
import logging
import sys
import time
from collections.abc import Sequence
from contextlib import nullcontext
from functools import partial

from .gzserver import split_remappings
from .heap import use_one_heap
from .page_token import add_options, announced, open_site
from .program import fail, say
from .web_browser import opened

logger = logging.getLogger(__name__)

PORT = 8080
PERIOD = 0.5  # between looks at the simulator [s, wall]
NAME = 'gzweb'
_say, _fail = partial(say, NAME), partial(fail, NAME)


def parser() -> argparse.ArgumentParser:
    """Return the parser of gzweb's options."""
    made = argparse.ArgumentParser(
        prog=NAME,
        description='See and control the simulated world in a browser.',
        formatter_class=argparse.ArgumentDefaultsHelpFormatter,
        allow_abbrev=False,  # --token is no --token-file
    )
    add_options(made)
    made.add_argument('--port', type=int, default=PORT, help='0 for any that is free')
    made.add_argument(
        '--no-token',
        action='store_true',
        help='let in everybody who reaches the port, every user of this machine included',
    )
    made.add_argument(
        '--open',
        action='store_true',
        help='open the address in a browser, where there is a display',
    )
    return made


def main(arguments: Sequence[str] | None = None) -> int:
    """Serve the window until the node is shut down; return the exit code."""
    own, remappings = split_remappings(sys.argv[1:] if arguments is None else arguments)
    options = parser().parse_args(own)
    if importlib.util.find_spec('viser') is None:
        return _fail(
            'no window: the Python package viser is not installed; '
            './rosbots setup web or pip install viser==1.1.1 does that'
        )
    use_one_heap()
    from ..ros_api.transport import (
        AddressError,
        Registrar,
        connect_logging,
        is_running,
        start_node,
        watch_master,
    )
    from ..ros_api.window import GazeboSimulator
    from ..web import LOOPBACK, Page, WindowError

    try:
        site = open_site(options, options.no_token)
        start_node(NAME, remappings, wall_time=True)
    except (WindowError, AddressError) as error:
        return _fail(str(error))
    connect_logging(time.time_ns)
    watch_master(Registrar(), ())
    if not site.token:
        logger.warning(
            'there is no token: everybody who reaches port %d of this machine, each of '
            'its users included, sees and controls the simulation',
            site.get_port(),
        )
    elif options.host not in LOOPBACK:
        _say(
            'whoever has this address sees and controls the simulation, and the connection is '
            'not encrypted'
        )
    page = Page(site, GazeboSimulator())
    gc.freeze()  # otherwise each full collection, as after a visit, scans all modules
    gc.collect()
    with (
        announced(NAME, site.address, site.viewing_address),
        opened(site.address) if options.open else nullcontext(),
    ):
        while is_running():
            page.poll()
            time.sleep(PERIOD)
    site.stop()
    return 0
