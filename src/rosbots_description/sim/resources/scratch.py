"""Temporary files of the simulator: private, and removed with their owner."""

import contextlib
import os
import subprocess
import tempfile
import threading
import weakref
from collections import Counter
from pathlib import Path

from ..core import ModelError

MEMORY = '/dev/shm'  # a folder that needs no disk; Linux has it


class ScratchFolder:
    """A private temporary folder, created when its first file is written.

    It is in the folder for temporary files (TMPDIR), or in memory if that is not writable. A full
    or read-only disk therefore matters only if a file is needed. Thread-safe.

    A process of its own removes the folder if this one is killed.
    """

    def __init__(self, prefix: str) -> None:
        """Begin the folder's name with `prefix`."""
        self._prefix = prefix
        # Several once a disk has filled up.
        self._folders: list[tempfile.TemporaryDirectory[str]] = []
        self._watches: list[subprocess.Popen[bytes]] = []
        self._lock = threading.Lock()

    def write(self, name: str, content: bytes, source: str) -> Path:
        """Write a file atomically; return its path.

        Args:
            source: the mesh file that it is derived from, for the message.
        Raises:
            ModelError: it cannot be written; the message names each folder and its fault.
        """
        with self._lock:
            for folder in self._folders:
                with contextlib.suppress(OSError):  # it was deleted, or its disk is full
                    return _write(Path(folder.name), name, content)
            return self._write_anew(name, content, source)

    def close(self) -> None:
        """Remove the folder and all files in it."""
        with self._lock:
            while self._folders:
                self._folders.pop().cleanup()
            while self._watches:
                self._watches.pop().communicate()

    def _write_anew(self, name: str, content: bytes, source: str) -> Path:
        """Write into a new folder, in the first location that is writable."""
        faults = []
        for place in (_temporary_folder(), MEMORY):
            try:
                folder = tempfile.TemporaryDirectory(
                    prefix=self._prefix, dir=place, ignore_cleanup_errors=True
                )
                try:
                    path = _write(Path(folder.name), name, content)
                except OSError:
                    folder.cleanup()
                    raise
            except OSError as error:
                faults.append(f'{place} ({error.strerror})')
            else:
                self._folders.append(folder)
                with contextlib.suppress(OSError):  # without it a kill leaves the folder
                    self._watches.append(_removal_at_death(folder.name))
                return path
        raise ModelError(
            f"mesh file '{source}' cannot be made ready: nothing can be written in "
            f'{" nor in ".join(faults)}; make room there, or set TMPDIR to a folder that has some'
        )


class SharedFile(str):
    """The path of a temporary file, which exists as long as this object is referenced.

    Caches therefore store it as a plain string.
    """


class SharedFiles:
    """Files in a private folder, each kept while its `SharedFile` is referenced. Thread-safe."""

    def __init__(self, prefix: str) -> None:
        """Begin the folder's name with `prefix`."""
        self._scratch = ScratchFolder(prefix)
        self._files: weakref.WeakValueDictionary[str, SharedFile] = weakref.WeakValueDictionary()
        self._uses: Counter[str] = Counter()  # objects that hold the file of a name
        self._lock = threading.RLock()  # reentrant: garbage collection may drop a file meanwhile

    def get(self, name: str) -> SharedFile | None:
        """Return the file of that name; None if it is not held or was deleted."""
        file = self._files.get(name)
        return file if file is not None and os.path.isfile(file) else None

    def write(self, name: str, content: bytes, source: str) -> SharedFile:
        """Write a file and return it; arguments and errors as of `ScratchFolder.write`."""
        with self._lock:
            self._uses[name] += 1
            try:
                file = SharedFile(self._scratch.write(name, content, source))
            except BaseException:
                self._uses[name] -= 1
                raise
            self._files[name] = file
            weakref.finalize(file, self._drop, name, str(file)).atexit = False
            return file

    def close(self) -> None:
        """Remove all files."""
        self._scratch.close()

    def _drop(self, name: str, path: str) -> None:
        """Remove a file when the last object that held it is gone."""
        with self._lock:
            self._uses[name] -= 1
            if not self._uses[name]:
                del self._uses[name]
                with contextlib.suppress(OSError):
                    os.unlink(path)


def _removal_at_death(folder: str) -> subprocess.Popen[bytes]:
    """Start a process that removes a folder when this process has ended, however it did.

    It waits for the end of its input, which the system closes. Ctrl-C does not reach it.
    """
    return subprocess.Popen(
        ['/bin/sh', '-c', 'read _; rm -rf -- "$0"', folder],
        stdin=subprocess.PIPE,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        start_new_session=True,
        cwd='/',
    )


def _temporary_folder() -> str:
    """Return the folder for temporary files, whether or not it is writable now.

    Python's `tempfile` raises an error if none is writable.
    """
    try:
        return tempfile.gettempdir()
    except OSError:
        return os.environ.get('TMPDIR') or '/tmp'


def _write(folder: Path, name: str, content: bytes) -> Path:
    handle, partial = tempfile.mkstemp(dir=folder, suffix='.tmp')
    try:
        with os.fdopen(handle, 'wb') as file:
            file.write(content)
        os.replace(partial, folder / name)
    except BaseException:
        with contextlib.suppress(OSError):
            os.unlink(partial)
        raise
    return folder / name
