"""Open an address in the person's browser without a trace of it in the list of processes.

A command line is readable by every user of a machine. So the browser is given a file that only
its owner can read, and which leads to the address.
"""

import os
import shutil
import stat
import subprocess
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from html import escape
from pathlib import Path
from typing import TextIO

PAGE = (
    '<!doctype html><meta charset="utf-8"><meta name="referrer" content="no-referrer">'
    '<meta http-equiv="refresh" content="0;url={}"><title>gzweb</title>\n'
)


@contextmanager
def opened(address: str) -> Iterator[bool]:
    """Open a browser at an address; yield whether there is a display and xdg-open for that."""
    program = shutil.which('xdg-open')
    if program is None or not (os.environ.get('DISPLAY') or os.environ.get('WAYLAND_DISPLAY')):
        yield False
        return
    with private_page(address) as page:
        # It ends at once, or when the browser does; in both cases it is not waited for.
        subprocess.Popen(
            [program, str(page)],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            start_new_session=True,
        )
        yield True


@contextmanager
def private_page(address: str) -> Iterator[Path]:
    """Yield the path of a page that leads to an address and that only its owner can read."""
    # A folder of mode 700; that of the session, if there is one, is cleared at its end.
    with tempfile.TemporaryDirectory(
        prefix='gzweb-', dir=_own_folder(), ignore_cleanup_errors=True
    ) as folder:
        page = Path(folder, 'window.html')
        page.touch(mode=0o600)
        page.write_text(PAGE.format(escape(address)), encoding='utf-8')
        yield page


def is_readable_by_others(output: TextIO) -> bool:
    """Tell whether an output is a file that other users may read, such as the log of a launch."""
    try:
        status = os.fstat(output.fileno())
    except (OSError, ValueError):  # no file at all
        return False
    return stat.S_ISREG(status.st_mode) and bool(status.st_mode & 0o077)


def _own_folder() -> str | None:
    folder = os.environ.get('XDG_RUNTIME_DIR', '')
    return folder if os.path.isdir(folder) and os.access(folder, os.W_OK) else None
