"""Read files that a description names, and nothing else that has a path.

A path from outside may lead to a pipe, a device or a folder: reading those can wait for ever, fill
the memory or do something. Only regular files are opened, and no more is read than a bound allows.
"""

import os
import stat

from ..core import ModelError

_OTHERS = {
    stat.S_IFDIR: 'folder', stat.S_IFIFO: 'pipe', stat.S_IFSOCK: 'socket',
    stat.S_IFCHR: 'device', stat.S_IFBLK: 'device',
}


def regular_state(path: str, kind: str = 'file') -> os.stat_result:
    """Return the state of a regular file, which is not opened.

    Args:
        kind: what the message calls it.
    Raises:
        ModelError: there is no such file, or it is a folder, pipe, socket or device.
    """
    try:
        state = os.stat(path)
    except (OSError, ValueError) as error:
        reason = getattr(error, 'strerror', None) or error
        raise ModelError(f"{kind} '{path}' cannot be read: {reason}") from error
    _require_regular(state, path, kind)
    return state


def read_file(path: str, most: int, kind: str = 'file') -> bytes:
    """Return the content of a regular file.

    Args:
        most: bytes that are accepted.
        kind: what the message calls it.
    Raises:
        ModelError: it is no regular file, has more bytes, or cannot be read.
    """
    regular_state(path, kind)  # before opening it, since a device may do something when opened
    try:
        # Without waiting: another file may have taken its place in the meantime.
        descriptor = os.open(path, os.O_RDONLY | os.O_NONBLOCK | os.O_NOCTTY | os.O_CLOEXEC)
        with open(descriptor, 'rb') as file:
            state = os.fstat(descriptor)
            _require_regular(state, path, kind)
            if state.st_size > most:
                raise ModelError(
                    f"{kind} '{path}' has {state.st_size} bytes; at most {most} are accepted: "
                    'simplify it'
                )
            # What says it is empty is: files of the kernel would tell without end.
            return file.read(state.st_size) if state.st_size else b''
    except OSError as error:
        raise ModelError(f"{kind} '{path}' cannot be read: {error.strerror}") from error


def _require_regular(state: os.stat_result, path: str, kind: str) -> None:
    if not stat.S_ISREG(state.st_mode):
        other = _OTHERS.get(stat.S_IFMT(state.st_mode), 'special file')
        raise ModelError(f"{kind} '{path}' is no file but a {other}")


def within(path: str, folder: str) -> bool:
    """Tell whether a path, as it is written, lies in a folder or is it.

    Links are not followed: in a workspace of links, as catkin makes them, what lies in a package
    may well be stored elsewhere. Who may put a link into a package may put any file there too.
    """
    path, folder = os.path.normpath(path), os.path.normpath(folder)
    return path == folder or path.startswith(folder.rstrip('/') + '/')
