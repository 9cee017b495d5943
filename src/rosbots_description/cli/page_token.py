"""Tokens of pages: given by a file or the environment, and told to nobody else."""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from typing import TYPE_CHECKING

from .program import say
from .web_browser import is_readable_by_others, private_page

if TYPE_CHECKING:
    from ..web import Site

HOST = '127.0.0.1'
VARIABLE, VIEWING_VARIABLE = 'GZWEB_TOKEN', 'GZWEB_VIEWING_TOKEN'
MOST_VIEWERS, MANY_VIEWERS = 16, 1000


def given_token(path: str, variable: str = VARIABLE) -> str:
    """Return the token of a file, else of a variable of the environment, else ''.

    Raises:
        OSError: the file cannot be read, or others can read it.
    """
    if not path:
        return os.environ.get(variable, '')
    with open(path, encoding='utf-8', errors='replace') as file:
        status = os.fstat(file.fileno())
        if status.st_mode & 0o077 or status.st_uid != os.geteuid():
            raise PermissionError(0, 'others can read it; make it your own, and chmod 600', path)
        return file.read(1000).strip()


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add the options of pages: where they are served, to whom, and to how many."""
    parser.add_argument(
        '--host', default=HOST, help='address to serve at; 0.0.0.0 is all of this machine'
    )
    for who, variable in (('', VARIABLE), ('viewing-', VIEWING_VARIABLE)):
        parser.add_argument(
            f'--{who}token-file',
            metavar='FILE',
            default='',
            help='only its owner can read it; it has the token that the address '
            f'{"for looking " if who else ""}ends with, as the variable {variable} may; made '
            'at random without both',
        )
    parser.add_argument(
        '--max-viewers',
        type=_number_of_browsers,
        default=MOST_VIEWERS,
        metavar='N',
        help='browsers at once by each of the two addresses: for control, and for looking only',
    )


def _number_of_browsers(text: str) -> int:
    if text.isascii() and text.isdigit() and 1 <= int(text) <= MANY_VIEWERS:
        return int(text)
    raise argparse.ArgumentTypeError(f"'{text}' is no number from 1 to {MANY_VIEWERS}")


def open_site(options: argparse.Namespace, is_open: bool = False) -> Site:
    """Serve at the address that `options` give, by their tokens or, if `is_open`, without.

    Raises:
        WindowError: it cannot be served there, or a token cannot be used.
    """
    from ..web import Site, WindowError

    try:
        token = given_token(options.token_file, VARIABLE)
        viewing = given_token(options.viewing_token_file, VIEWING_VARIABLE)
    except OSError as error:
        reason = error.strerror or error
        raise WindowError(f"no token in '{error.filename}': {reason}") from None
    return Site(
        options.host,
        options.port,
        token,
        viewing_token=viewing,
        is_open=is_open,
        most_viewers=options.max_viewers,
    )


@contextmanager
def announced(program: str, address: str, viewing_address: str) -> Iterator[None]:
    """Print where a page is; where others could read tokens, files that lead there.

    Args:
        address: for control; viewing_address: for looking only, '' for none.
    """
    with ExitStack() as stack:
        for what, one in (('the world is at', address), ('to look at it only:', viewing_address)):
            place, _, token = one.partition('?')
            if token and is_readable_by_others(sys.stderr):
                page = stack.enter_context(private_page(one))
                hint = f'{page} opens it, with the token, which others could read here'
                say(program, f'{what} {place}; {hint}')
            elif one:
                say(program, f'{what} {one}')
        yield
