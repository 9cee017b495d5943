"""Files that the simulator makes for itself: private, and gone when their owner is."""

import contextlib
import os
import tempfile
import threading
import weakref
from collections import Counter
from pathlib import Path

from ..core import ModelError

MEMORY = '/dev/shm'  # a folder that needs no disk; Linux has it


class ScratchFolder:
    """A private folder for files of ours, made when the first one is written.

    It lies where temporary files do (TMPDIR), or in memory where nothing can be written there.
    Without a file nothing is made, so a full or read-only disk harms nobody who needs none.
    Any thread may use it.
    """

    def __init__(self, prefix: str) -> None:
        """Begin the folder's name with `prefix`."""
        self._prefix = prefix
        # Several once a disk has filled up.
        self._folders: list[tempfile.TemporaryDirectory[str]] = []
        self._lock = threading.Lock()

    def write(self, name: str, content: bytes, source: str) -> Path:
        """Write a file so that nobody ever sees a part of it; return its path.

        Args:
            source: the mesh file that it is made from, for the message.
        Raises:
            ModelError: it can be written nowhere; the sentence names each place and its fault.
        """
        with self._lock:
            for folder in self._folders:
                with contextlib.suppress(OSError):  # it was deleted, or its disk is full by now
                    return _write(Path(folder.name), name, content)
            return self._write_anew(name, content, source)

    def close(self) -> None:
        """Remove the folder and all files in it."""
        with self._lock:
            while self._folders:
                self._folders.pop().cleanup()

    def _write_anew(self, name: str, content: bytes, source: str) -> Path:
        """Write into a new folder, in the first place that takes the file."""
        faults = []
        for place in (_temporary_folder(), MEMORY):
            try:
                folder = tempfile.TemporaryDirectory(
                    prefix=self._prefix, dir=place, ignore_cleanup_errors=True)
                try:
                    path = _write(Path(folder.name), name, content)
                except OSError:
                    folder.cleanup()
                    raise
            except OSError as error:
                faults.append(f'{place} ({error.strerror})')
            else:
                self._folders.append(folder)
                return path
        raise ModelError(
            f"mesh file '{source}' cannot be made ready: nothing can be written in "
            f"{' nor in '.join(faults)}; make room there, or set TMPDIR to a folder that has some"
        )


class HeldFile(str):
    """The path of a file of ours, which stays as long as somebody holds this very object.

    Caches keep plain strings of it.
    """


class HeldFiles:
    """Files in a private folder, each as long as it is held. Any thread may ask for them."""

    def __init__(self, prefix: str) -> None:
        """Begin the folder's name with `prefix`."""
        self._scratch = ScratchFolder(prefix)
        self._files: weakref.WeakValueDictionary[str, HeldFile] = weakref.WeakValueDictionary()
        self._uses: Counter[str] = Counter()  # objects that hold the file of a name
        self._lock = threading.RLock()  # what is dropped while it is held may drop a file

    def get(self, name: str) -> HeldFile | None:
        """Return the file of that name; None if nobody holds it or it was deleted."""
        file = self._files.get(name)
        return file if file is not None and os.path.isfile(file) else None

    def write(self, name: str, content: bytes, source: str) -> HeldFile:
        """Write a file and return it; arguments and faults as of `ScratchFolder.write`."""
        with self._lock:
            self._uses[name] += 1
            try:
                file = HeldFile(self._scratch.write(name, content, source))
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
        """Remove a file when the last object is gone that held it."""
        with self._lock:
            self._uses[name] -= 1
            if not self._uses[name]:
                del self._uses[name]
                with contextlib.suppress(OSError):
                    os.unlink(path)


def _temporary_folder() -> str:
    """Return where temporary files go, whether or not something can be written there now.

    Python's own answer, where it finds none that can be written, is an error.
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
