"""The rows of a batch: in memory, and as Parquet files while they come."""

import contextlib
import fcntl
import os
import weakref
from collections.abc import Callable, Mapping
from dataclasses import asdict
from pathlib import Path
from typing import Any

import pyarrow as pa
from pyarrow import parquet

from ..sim import Fault
from .scenario import ScenarioError, ScenarioFile

FINAL, PARTS = 'rows.parquet', 'rows'
_TYPES = {bool: pa.bool_(), int: pa.int64(), float: pa.float64(), str: pa.string()}
_FAULT = pa.struct([(name, _TYPES[type(value)]) for name, value in asdict(Fault('')).items()])
_KEY = b'scenario'


class Table:
    """Rows by the number of their run, in a folder that survives an interruption.

    While they come, rows are in files of `rows/`, each complete; `finish` puts all of them into
    `rows.parquet`, ordered by run. Rows that cannot be written wait for the next `flush`. The
    folder is locked until `close`, or until the process ends in whatever way.
    """

    def __init__(self, file: ScenarioFile, folder: str | os.PathLike[str] | None) -> None:
        """Open the table in a folder, with the rows that are there; None keeps rows in memory.

        Raises:
            ScenarioError: the folder cannot be used, holds the rows of another scenario, or is in
                use by another batch.
        """
        names = file.parameters.names
        self._text = {name for name in names if file.parameters.type_of(name) is str}
        self.schema = pa.schema(
            [
                ('run', pa.int64()),
                ('seed', pa.int64()),
                ('outcome', pa.string()),
                ('reason', pa.string()),
                ('faults', pa.list_(_FAULT)),
                *((name, _TYPES[file.parameters.type_of(name)]) for name in names),
                *((name, pa.float64()) for name in file.columns),
            ],
            {_KEY: file.fingerprint.encode()},
        )
        self.rows: dict[int, dict[str, Any]] = {}
        self.fault = ''  # why rows could not be written
        self._waiting: list[dict[str, Any]] = []
        self._unlock: Callable[[], object] = lambda: None
        self._folder = None if folder is None else Path(folder)
        if self._folder is not None:
            self._open(self._folder)
            self._load(self._folder)

    def _open(self, folder: Path) -> None:
        """Make and lock the folder."""
        try:
            folder.mkdir(parents=True, exist_ok=True)
            handle = os.open(folder, os.O_RDONLY | os.O_DIRECTORY)
            self._unlock = weakref.finalize(self, os.close, handle)
            fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
            (folder / PARTS).mkdir(exist_ok=True)
        except BlockingIOError:
            raise ScenarioError(
                f'{folder} is in use by another batch; name another folder, or '
                'wait until that one ends'
            ) from None
        except OSError as error:
            raise ScenarioError(f'rows cannot be written to {folder}: {_why(error)}') from None

    def close(self) -> None:
        """Unlock the folder."""
        self._unlock()

    def _load(self, folder: Path) -> None:
        parts = sorted((folder / PARTS).glob('*.parquet'))
        self._parts = 1 + max(
            (int(part.stem) for part in parts if part.stem.isdecimal()), default=-1
        )
        for part in (folder / FINAL, *parts):
            try:
                found = parquet.read_table(part)
            except (FileNotFoundError, pa.ArrowInvalid):
                continue  # a file of 0 bytes remains of a machine that lost its power
            except OSError as error:
                raise ScenarioError(f'{part} cannot be read: {_why(error)}') from None
            if (found.schema.metadata or {}).get(_KEY) != self.schema.metadata[_KEY]:
                raise ScenarioError(
                    f'{folder} holds the rows of another scenario; name '
                    'another folder, or remove it'
                )
            rows: list[Any] = found.to_pylist()
            self.rows |= {row['run']: row for row in rows}

    def add(self, row: Mapping[str, Any]) -> None:
        """Add the row of a run."""
        made: dict[str, Any] = {
            name: str(value) if name in self._text and value is not None else value
            for name, value in row.items()
        }
        self.rows[made['run']] = made
        self._waiting.append(made)

    def flush(self) -> None:
        """Write the rows that wait; `fault` says why, if they cannot be written."""
        if self._folder is None or not self._waiting:
            return
        path = self._folder / PARTS / f'{self._parts:06}.parquet'
        if self._write(path, self._waiting):
            self._parts += 1
            self._waiting = []

    def finish(self) -> None:
        """Write all rows to one file, and remove the others."""
        if self._folder is None:
            return
        if self._write(self._folder / FINAL, self._ordered()):
            self._waiting = []
            for part in (self._folder / PARTS).iterdir():
                part.unlink()
            (self._folder / PARTS).rmdir()

    def table(self) -> pa.Table:
        """Return all rows, ordered by run."""
        return pa.Table.from_pylist(self._ordered(), schema=self.schema)

    def _ordered(self) -> list[dict[str, Any]]:
        return [self.rows[number] for number in sorted(self.rows)]

    def _write(self, path: Path, rows: list[dict[str, Any]]) -> bool:
        """Write a file as a whole or not at all; tell whether it is written."""
        # Who reads the folder does not read it: files that begin with a dot are left out.
        temporary = path.with_name(f'.{path.name}')
        try:
            parquet.write_table(pa.Table.from_pylist(rows, schema=self.schema), temporary)
            temporary.replace(path)
        except OSError as error:
            with contextlib.suppress(OSError):
                temporary.unlink()
            self.fault = f'rows cannot be written to {path.parent}: {_why(error)}'
            return False
        self.fault = ''
        return True


def runs_in(folder: Path) -> set[int]:
    """Return the numbers of the runs whose rows are in a folder."""
    found: set[int] = set()
    for file in (folder / FINAL, *(folder / PARTS).glob('[0-9]*.parquet')):
        with contextlib.suppress(OSError, pa.ArrowInvalid):
            found.update(parquet.read_table(file, columns=['run']).column('run').to_pylist())
    return found


def _why(error: OSError) -> str:
    return os.strerror(error.errno) if error.errno else str(error)
