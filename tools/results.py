"""Results of checks: counts, one line for each, and what repeats those that failed."""

from __future__ import annotations

import os
import subprocess
import threading
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

ROOT = Path(__file__).resolve().parent.parent
REPORTS = (ROOT / '.ws').resolve() / 'test_results'  # rostest needs a path without spaces
OUTPUT_LINES = 60  # of a failed check's output, shown when it ends
REASON_LINES = 12  # of a failed test's report, shown at the very end
_printing = threading.Lock()


@dataclass(frozen=True)
class Failure:
    """A check that failed, with the command that repeats exactly this one."""

    name: str
    command: str
    log: Path
    reason: str = ''  # what the tests reported


@dataclass(frozen=True)
class Count:
    """Numbers of tests, and the failures."""

    passed: int = 0
    failed: int = 0
    skipped: int = 0
    failures: tuple[Failure, ...] = ()

    def __add__(self, other: Count) -> Count:
        """Return the sum, kind by kind."""
        return Count(
            self.passed + other.passed,
            self.failed + other.failed,
            self.skipped + other.skipped,
            self.failures + other.failures,
        )


@dataclass(frozen=True)
class FailedCase:
    """A test case that failed, as a junit file names it, and why."""

    class_name: str
    name: str
    reason: str


@dataclass(frozen=True)
class Report:
    """A junit file: the numbers, and the cases that failed."""

    count: Count
    failed: tuple[FailedCase, ...] = ()


def say(*lines: str) -> None:
    """Print whole lines; checks run side by side."""
    with _printing:
        print(*lines, sep='\n', flush=True)


def read_report(path: Path) -> Report:
    """Count the test cases of a junit file; one that cannot be read is one failure.

    rosunit knows no skipped tests and counts them as passed; such a test prints a line that begins
    with SKIPPED, which is shown.
    """
    try:
        report = ElementTree.parse(path)
    except (OSError, ElementTree.ParseError):
        return Report(Count(failed=1))
    cases = list(report.iter('testcase'))
    bad = [
        (case, fault)
        for case in cases
        for fault in [*case.findall('failure'), *case.findall('error')][:1]
    ]
    told = [
        line
        for output in report.iter('system-out')
        for line in (output.text or '').splitlines()
        if line.startswith('SKIPPED ')
    ]
    if told:
        say(*told)
    skipped = len(told) + sum(case.find('skipped') is not None for case in cases)
    return Report(
        Count(len(cases) - len(bad) - skipped, len(bad), skipped),
        tuple(
            FailedCase(case.get('classname', ''), case.get('name', ''), fault.text or '')
            for case, fault in bad
        ),
    )


def with_exit_code(count: Count, code: int) -> Count:
    """Return the count, plus a failure if only the exit code reports one."""
    if count.failed == 0 and (code != 0 or count.passed == 0):
        return count + Count(failed=1)
    return count


class Stopwatch:
    """Measures a process and those of its descendants that end before it."""

    def __init__(self) -> None:
        self._start = time.monotonic()
        self._taken = ''

    def wait(self, process: subprocess.Popen[Any]) -> int:
        """Return the exit code of a process when it has ended."""
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        self._taken = (
            f'{time.monotonic() - self._start:.1f} s, '
            f'{usage.ru_utime + usage.ru_stime:.0f} s of a processor'
        )
        return process.returncode

    def __str__(self) -> str:
        return self._taken


def run_logged(
    command: list[str], log: Path, environment: dict[str, str] | None = None
) -> tuple[int, Stopwatch]:
    """Run a command in the clone, with its output in a log; return its exit code and its time."""
    watch = Stopwatch()
    with (
        log.open('wb') as output,
        subprocess.Popen(
            command,
            cwd=ROOT,
            env=environment,
            stdin=subprocess.DEVNULL,
            stdout=output,
            stderr=subprocess.STDOUT,
        ) as process,
    ):
        return watch.wait(process), watch


def say_result(phase: str, name: str, count: Count, watch: Stopwatch, *more: str) -> None:
    """Print one line with the result of a check, and further ones."""
    verdict = 'FAILED' if count.failed else 'ok'
    skipped = f', {count.skipped} skipped' if count.skipped else ''
    say(
        f'{phase:8} {name:42} {verdict:6} {count.passed} passed, {count.failed} failed{skipped}'
        f'  {watch}',
        *more,
    )


def end_of(log: Path) -> list[str]:
    """Return the last lines of a log, indented, and where all of it is."""
    lines = log.read_text(errors='replace').splitlines()
    return [*(f'    {line}' for line in lines[-OUTPUT_LINES:]), f'    (complete output: {log})']


def say_failures(failures: tuple[Failure, ...], seed: int) -> None:
    """Print why each failed, and how it is repeated."""
    for failure in failures:
        has_seed = failure.command.startswith('./rosbots test ')
        say(
            '',
            f'FAILED {failure.name}',
            f'    repeat: {failure.command}{f" --seed {seed}" if has_seed else ""}',
            f'    log:    {failure.log}',
            *(f'        {line}' for line in failure.reason.splitlines()[-REASON_LINES:]),
        )
