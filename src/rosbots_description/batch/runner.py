"""Make the runs of a scenario that have no row yet."""

import os
import time
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import closing
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from .scenario import ScenarioError, ScenarioFile
from .simulation import ERROR, FAILED, PASSED, simulate

if TYPE_CHECKING:
    import pyarrow as pa

    from .table import Table

FLUSH_PERIOD = 2.0  # between two files of rows [s, wall]

Scenario = str | os.PathLike[str] | Mapping[str, Any] | ScenarioFile  # a path, or its content
# Called with the number of rows, that of all runs, and that of runs repeated so far.
Progress = Callable[[int, int, int], None]


class Result(NamedTuple):
    """What came of a batch."""

    table: 'pa.Table'  # a row a run, ordered by run
    repeated: int  # runs that were repeated because their worker was lost
    unwritten: str = ''  # why rows could not be written; '' if they were

    @property
    def outcomes(self) -> dict[str, int]:
        """Return how many runs passed, failed and ended with an error."""
        count = Counter(self.table.column('outcome').to_pylist())
        return {outcome: count[outcome] for outcome in (PASSED, FAILED, ERROR)}


def run(
    scenario: Scenario,
    parameters: Mapping[str, Any] | None = None,
    *,
    workers: int | None = None,
    address: str | None = None,
    output: str | os.PathLike[str] | None = None,
    only: Iterable[int] | None = None,
    progress: Progress | None = None,
) -> Result:
    """Make all runs of a scenario; one with a row in `output` is not made again.

    The rows depend on the scenario and its seed only, not on the workers.

    Args:
        scenario: a YAML file, or its content.
        parameters: replace those of the scenario that have their names.
        workers: processes on this machine, on a Ray of their own; None: one per processor. 0 makes
            the runs in this process, without Ray.
        address: of a Ray cluster to use instead, or 'auto'.
        output: a folder for `rows.parquet`; None returns the rows only.
        only: numbers of the runs to make; None: all of them.
        progress: called after each row.
    Raises:
        ScenarioError: the scenario is not valid, or the folder holds the rows of another one, or is
            in use by another batch.
        ClusterError: Ray is not installed, cannot be started or cannot be reached.
    """
    file = _as_file(scenario, parameters)
    try:
        from .table import Table
    except ImportError as error:
        raise ScenarioError(
            f'no rows without the Python package {error.name}; ./rosbots setup or '
            "pip install '.[ray]' installs it"
        ) from None
    wanted = range(file.parameters.runs) if only is None else sorted(set(only))
    if wanted and not 0 <= wanted[0] <= wanted[-1] < file.parameters.runs:
        raise ScenarioError(f'the runs have the numbers 0 to {file.parameters.runs - 1}')
    with closing(Table(file, output)) as table:
        missing = [number for number in wanted if number not in table.rows]
        total = len(table.rows) + len(missing)
        repeated = 0
        if missing:
            repeated = _collect(table, _rows(file, missing, workers, address), total, progress)
        table.finish()
        return Result(table.table(), repeated, table.fault)


def count_rows(output: str | os.PathLike[str]) -> int:
    """Return how many runs have a row in a folder, whatever has ended the batch."""
    from .table import runs_in

    return len(runs_in(Path(output)))


def _as_file(scenario: Scenario, parameters: Mapping[str, Any] | None) -> ScenarioFile:
    if isinstance(scenario, ScenarioFile):
        if parameters:
            raise ScenarioError('a ScenarioFile has its parameters already')
        return scenario
    if isinstance(scenario, Mapping):
        return ScenarioFile(scenario, parameters=parameters)
    return ScenarioFile.read(scenario, parameters)


def _rows(
    file: ScenarioFile, numbers: list[int], workers: int | None, address: str | None
) -> Iterator[tuple[dict[str, Any], int]]:
    """Yield rows, and the number of runs repeated so far, as they come."""
    if workers == 0 and address is None:
        return ((simulate(file, number), 0) for number in numbers)
    from .cluster import rows

    return rows(file, numbers, workers, address)


def _collect(
    table: 'Table',
    rows: Iterable[tuple[dict[str, Any], int]],
    total: int,
    progress: Progress | None,
) -> int:
    """Add the rows to the table, whatever ends this; return the number of repeated runs."""
    flushed, repeated = time.monotonic(), 0
    with closing(rows):  # type: ignore[type-var]
        try:
            for row, repeated in rows:
                table.add(row)
                if time.monotonic() > flushed + FLUSH_PERIOD:
                    table.flush()
                    flushed = time.monotonic()
                if progress:
                    progress(len(table.rows), total, repeated)
        finally:
            table.flush()  # before Ray is shut down, which may end this process
    return repeated
