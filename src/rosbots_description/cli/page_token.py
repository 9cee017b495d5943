"""Tokens of pages: given by a file or the environment, and told to nobody else."""

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager

from .web_browser import is_readable_by_others, private_page

VARIABLE = 'GZWEB_TOKEN'


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
            raise PermissionError('others can read it; make it your own, and chmod 600')
        return file.read(1000).strip()


@contextmanager
def announced(program: str, address: str, token: str, what: str = 'the world') -> Iterator[None]:
    """Print where a page is; where others could read the token, a page that leads there."""
    if not token or not is_readable_by_others(sys.stderr):
        sys.stderr.write(f'{program}: {what} is at {address}\n')
        yield
        return
    with private_page(address) as page:
        sys.stderr.write(f'{program}: {what} is at {address.partition("?")[0]}; {page} opens it, '
                         'with the token, which others could read here\n')
        yield
