"""Write files where a user says: whole or not at all, and over no other file unasked."""

import contextlib
import os
import secrets

from ..core import SimError

WORLD_SUFFIXES = ('.world', '.sdf')


def require_world_path(path: str) -> None:
    """Reject what is not the place of a world file.

    Raises:
        SimError: it is not absolute, or does not end in .world or .sdf.
    """
    if not os.path.isabs(path):
        raise SimError(
            f"'{path}' is not an absolute path; the simulator has a working folder of its own"
        )
    if not path.endswith(WORLD_SUFFIXES):
        raise SimError(f"'{path}' is no name of a world file; it ends in .world or .sdf")


def write_world(path: str, text: str, overwrite: bool = False) -> None:
    """Write a world file.

    Raises:
        SimError: the path is not fit, there is a file already, or it cannot be written; then
            nothing has changed.
    """
    require_world_path(path)
    write_file(path, text.encode(), overwrite)


def write_file(path: str, content: bytes, overwrite: bool = False) -> None:
    """Write a file.

    Raises:
        SimError: there is a file already, or it cannot be written; then nothing has changed.
    """
    try:
        if os.path.lexists(path) and not (overwrite and os.path.isfile(path)):
            raise FileExistsError(0, 'it exists already; overwrite a file only, and on purpose')
        _write(path, content, overwrite)
    except (OSError, ValueError) as error:
        reason = getattr(error, 'strerror', None) or error
        raise SimError(f"'{path}' cannot be written: {reason}") from error


def _write(path: str, content: bytes, overwrite: bool) -> None:
    folder, name = os.path.split(path)
    partial = os.path.join(folder, f'.{name[:100]}.{secrets.token_hex(4)}.tmp')
    try:
        with open(partial, 'xb') as file:
            file.write(content)
            file.flush()
            os.fsync(file.fileno())
        if not overwrite:
            open(path, 'xb').close()  # fails if another one has written it meanwhile
        os.replace(partial, path)
    except BaseException:
        with contextlib.suppress(OSError):
            os.unlink(partial)
        raise
