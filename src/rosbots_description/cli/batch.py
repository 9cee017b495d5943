"""Front end of `./rosbots batch`: many runs of one scenario."""

from __future__ import annotations

import argparse
import contextlib
import os
import signal
import sys
from collections import Counter
from collections.abc import Iterator, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from .guarded import guarded
from .program import INTERRUPTED, fail, say

if TYPE_CHECKING:
    from ..batch import Progress, Result

PASSED, NOT_PASSED, USAGE = 0, 1, 2  # exit codes
FOLDER = 'batch_output'
REASONS = 5  # that are printed, the most frequent ones
_say, _fail = partial(say, 'batch'), partial(fail, 'batch', code=USAGE)


def _count(text: str) -> int:
    if not text.isdecimal():
        raise argparse.ArgumentTypeError(f'{text!r} is not a number of processes')
    return int(text)


def parser() -> argparse.ArgumentParser:
    """Return the parser of the options."""
    made = argparse.ArgumentParser(
        prog='./rosbots batch',
        description='Make all runs of a scenario; one row each in Parquet.',
        epilog='The exit code is 0 if all runs passed, 1 if not, 2 if none could be made.',
    )
    made.add_argument('scenario', metavar='SCENARIO.yaml', help='see doc/batch.md')
    where = made.add_mutually_exclusive_group()
    where.add_argument(
        '--workers',
        type=_count,
        metavar='N',
        help='processes on this machine (default: one per processor); 0 makes the '
        'runs in this one, without Ray',
    )
    where.add_argument('--address', help="of a Ray cluster, or 'auto' for the one of this machine")
    made.add_argument(
        '--output',
        type=Path,
        metavar='DIR',
        help=f'for rows.parquet (default: {FOLDER}/SCENARIO); rows that are there are kept',
    )
    return made


def main(arguments: Sequence[str] | None = None) -> int:
    """Make the runs that have no row yet; return the exit code."""
    options = parser().parse_args(arguments)
    output = _output(options)
    signal.signal(signal.SIGTERM, lambda number, _frame: sys.exit(128 + number))
    try:
        from ..batch import ClusterError, ScenarioError, run
    except ImportError as error:
        return _fail(
            f'the Python package {error.name} is not installed; ./rosbots setup or '
            "pip install '.[ray]' installs it"
        )

    try:
        with _bar() as show:
            result = run(
                options.scenario,
                workers=options.workers,
                address=options.address,
                output=output,
                progress=show,
            )
    except (ScenarioError, ClusterError) as error:
        return _fail(str(error))
    except (KeyboardInterrupt, SystemExit):
        return _interrupted(output)
    return _report(result, output)


def _output(options: argparse.Namespace) -> Path:
    return options.output or Path(FOLDER, Path(options.scenario).stem)


def _interrupted(output: Path) -> int:
    from ..batch import count_rows

    _say(
        f'interrupted; {count_rows(output)} rows are in {output}, and the same command makes the '
        'others'
    )
    return INTERRUPTED


def _report(result: Result, output: Path) -> int:
    outcomes = result.outcomes
    print(
        f'{result.table.num_rows} runs: {outcomes["passed"]} passed, {outcomes["failed"]} failed,'
        f' {outcomes["error"]} with an error'
    )
    if result.repeated:
        print(f'{result.repeated} were repeated, since their workers were lost')
    rows = result.table.select(['run', 'outcome', 'reason']).to_pylist()
    reasons = Counter((row['outcome'], row['reason']) for row in rows if row['reason'])
    first = {(row['outcome'], row['reason']): row['run'] for row in reversed(rows)}
    for key, count in reasons.most_common(REASONS):
        print(f'  {key[0]} {count} x, as run {first[key]}: {key[1]}')
    others = len(reasons) - REASONS
    if others > 0:
        print(f'  and {others} other reason{"s" if others > 1 else ""}')
    if result.unwritten:
        return _fail(f'{result.unwritten}; make room and repeat the command', code=NOT_PASSED)
    print(f'rows: {output / "rows.parquet"}')
    return PASSED if outcomes['passed'] == result.table.num_rows else NOT_PASSED


@contextlib.contextmanager
def _bar() -> Iterator[Progress]:
    """Yield what shows progress, if there is a terminal for it."""
    if not sys.stderr.isatty():
        yield lambda _rows, _total, _repeated: None
        return
    from rich import progress
    from rich.console import Console

    columns = (
        progress.TextColumn('{task.description}'),
        progress.BarColumn(),
        progress.MofNCompleteColumn(),
        progress.TimeRemainingColumn(),
    )
    with progress.Progress(*columns, console=Console(stderr=True)) as bar:
        task = bar.add_task('runs', total=None)

        def show(rows: int, total: int, repeated: int) -> None:
            text = f'runs ({repeated} repeated)' if repeated else 'runs'
            bar.update(task, completed=rows, total=total, description=text)

        yield show


def program() -> int:
    """Run `main` as a program of its own."""
    return guarded(_main_alone, _ended_by_ray)


def _main_alone() -> int:
    with _own_stderr():
        return main()


def _ended_by_ray(interrupted: bool) -> int:
    """Say how the command ended where Ray ended it, at times while it is shut down."""
    from ..batch import remove_left_folders

    remove_left_folders()
    if interrupted:
        return _interrupted(_output(parser().parse_args()))
    return _fail(
        'ended by Ray, of which a process has died, or by a signal; the rows so far are '
        'kept, and the same command makes the others',
        code=NOT_PASSED,
    )


@contextlib.contextmanager
def _own_stderr() -> Iterator[None]:
    """Keep standard error for this program: Ray's core prints what it does about dead processes."""
    with (
        os.fdopen(os.dup(2), 'w', encoding='utf-8', errors='backslashreplace', buffering=1) as own,
        contextlib.redirect_stderr(own),
    ):
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, 2)
        os.close(nowhere)
        yield


if __name__ == '__main__':
    from .program import run as run_program

    sys.exit(run_program(program))
