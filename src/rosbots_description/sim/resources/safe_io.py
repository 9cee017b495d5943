"""Read regular files that a description names, and no other kind of file.

A path from user input may be a pipe, a device or a folder: reading those can block for ever, fill
the memory or have side effects. Only regular files are opened, and read up to a limit.
"""

import os
import stat

from ..core import ModelError

_OTHERS = {
    stat.S_IFDIR: 'folder',
    stat.S_IFIFO: 'pipe',
    stat.S_IFSOCK: 'socket',
    stat.S_IFCHR: 'device',
    stat.S_IFBLK: 'device',
}


def regular_state(path: str, kind: str = 'file') -> os.stat_result:
    """Return the status of a regular file without opening it.

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
        ModelError: it is not a regular file, has more bytes, or cannot be read.
    """
    regular_state(path, kind)  # before opening it, since a device may do something when opened
    try:
        # Non-blocking: a pipe may have taken its place in the meantime.
        descriptor = os.open(path, os.O_RDONLY | os.O_NONBLOCK | os.O_NOCTTY | os.O_CLOEXEC)
        with open(descriptor, 'rb') as file:
            state = os.fstat(descriptor)
            _require_regular(state, path, kind)
            if state.st_size > most:
                raise ModelError(
                    f"{kind} '{path}' has {state.st_size} bytes; at most {most} are accepted: "
                    'simplify it'
                )
            # Read no more than the size: files of the kernel claim 0 bytes and may never end.
            return file.read(state.st_size) if state.st_size else b''
    except OSError as error:
        raise ModelError(f"{kind} '{path}' cannot be read: {error.strerror}") from error


def _require_regular(state: os.stat_result, path: str, kind: str) -> None:
    if not stat.S_ISREG(state.st_mode):
        other = _OTHERS.get(stat.S_IFMT(state.st_mode), 'special file')
        raise ModelError(f"{kind} '{path}' is no file but a {other}")


def within(path: str, folder: str) -> bool:
    """Tell whether a path, as written, is in a folder or is the folder itself.

    Symbolic links are not resolved: in a workspace of links, as catkin makes them, the files of a
    package may be stored elsewhere. Whoever can add a link to a package can add any file, too.
    """
    path, folder = os.path.normpath(path), os.path.normpath(folder)
    return path == folder or path.startswith(folder.rstrip('/') + '/')
