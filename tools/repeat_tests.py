#!/usr/bin/env python3
"""Run every test N times and print which failed how often, and how long each phase took.

`tools/repeat_tests.py 4 --load 4` keeps four processes busy beside the tests. Each run has another
seed of Python's hashes, from 0. All other arguments, such as phases and files, are passed to
`./rosbots test`. The exit code is 1 if any run failed.
"""

from __future__ import annotations

import argparse
import json
import statistics
import subprocess
import sys
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parent.parent
SUMMARY = ROOT / '.ws' / 'test_results' / 'summary.json'
BUSY = 'while True: pass'


@contextmanager
def load(processes: int) -> Iterator[None]:
    """Keep so many processes busy."""
    busy = [subprocess.Popen([sys.executable, '-c', BUSY]) for _ in range(processes)]
    try:
        yield
    finally:
        for process in busy:
            process.kill()
            process.wait()


def run(arguments: list[str]) -> dict[str, Any]:
    """Run the tests once; return their summary."""
    SUMMARY.unlink(missing_ok=True)
    code = subprocess.run([ROOT / 'rosbots', 'test', *arguments], check=False).returncode
    try:
        summary: dict[str, Any] = json.loads(SUMMARY.read_text())
    except (OSError, ValueError):  # it ended before its end
        return {'seconds': {}, 'failures': [f'./rosbots test ended with exit code {code}']}
    return summary


def table(summaries: list[dict[str, Any]]) -> list[str]:
    """Return the lines of the result: failures by test; minimum, median and maximum by phase."""
    runs = len(summaries)
    failures = Counter(name for summary in summaries for name in summary['failures'])
    lines = [f'{"failed":>8}  test'] if failures else [f'no failure in {runs} runs']
    lines += [f'{times:>3} of {runs:<2} {name}' for name, times in failures.most_common()]
    lines += ['', f'{"phase":10}{"min":>8}{"median":>8}{"max":>8}  [s]']
    for phase in dict.fromkeys(name for summary in summaries for name in summary['seconds']):
        took = [summary['seconds'][phase] for summary in summaries if phase in summary['seconds']]
        lines.append(f'{phase:10}{min(took):8.0f}{statistics.median(took):8.0f}{max(took):8.0f}')
    return lines


def main(argv: list[str] | None = None) -> int:
    """Repeat the tests; return the exit code."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument('runs', type=int, metavar='N', help='how often')
    parser.add_argument(
        '--load',
        type=int,
        default=0,
        metavar='K',
        help='busy processes beside the tests (default: none)',
    )
    arguments, others = parser.parse_known_args(argv)
    if arguments.runs < 1 or arguments.load < 0:
        parser.error('N is at least 1, and K at least 0')
    summaries: list[dict[str, Any]] = []
    with load(arguments.load):
        for number in range(arguments.runs):
            summaries.append(run([*others, '--seed', str(number)]))
            print(
                f'\nafter run {number + 1} of {arguments.runs}, {arguments.load} busy processes',
                *table(summaries),
                sep='\n',
                flush=True,
            )
    return 1 if any(summary['failures'] for summary in summaries) else 0


if __name__ == '__main__':
    sys.exit(main())
