"""The .test files of test/rostest, each with its own master, in lanes side by side."""

from __future__ import annotations

import os
from collections.abc import Iterable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from logged_errors import read_expected, unexpected
from results import (
    REPORTS,
    ROOT,
    Count,
    Failure,
    end_of,
    read_report,
    run_logged,
    say,
    say_result,
    with_exit_code,
)

FOLDER = ROOT / 'test' / 'rostest'
LANES = 3 + (os.cpu_count() or 1)  # half of their time they wait for simulated time
# Begun first, the longest first, so that the lanes end together.
LONGEST = (
    'own_package',
    'simulator',
    'lessons',
    'hostile_names',
    'never_down',
    'soak',
    'chromium',
    'hostile',
    'frames',
    'controllers',
    'pip_install',
    'neighbours',
    'install_space',
    'rosbots_script',
    'tools',
    'processes',
    'gzweb',
    'window',
)
# Independent of the caller's master and addresses, and of unbuffered output.
NOT_OURS = ('ROS_MASTER_URI', 'ROS_IP', 'ROS_HOSTNAME', 'ROS_NAMESPACE', 'PYTHONUNBUFFERED')


def choose(word: str) -> list[Path]:
    """Return the .test files whose name has this word."""
    return [path for path in sorted(FOLDER.glob('*.test')) if word in path.stem]


def in_order(paths: Iterable[Path]) -> list[Path]:
    """Return them with the longest first, the others by name."""
    rank = {name: number for number, name in enumerate(LONGEST)}
    return sorted(paths, key=lambda path: (rank.get(path.stem, len(rank)), path.stem))


def run_rostests(paths: Iterable[Path]) -> Count:
    """Run .test files, as many at once as there are lanes."""
    chosen = in_order(paths)
    if not chosen:
        say('rostest  there is no such test in test/rostest')
        return Count(failed=1)
    with ThreadPoolExecutor(LANES) as lanes:
        return sum(lanes.map(run_rostest, chosen), Count())


def run_rostest(path: Path) -> Count:
    """Run a .test file; return the count of its reports, with its exit code."""
    results = REPORTS / 'rostest' / path.stem
    results.mkdir(parents=True)
    log = results / 'output.log'
    environment = {
        **os.environ,
        'ROS_ETC_DIR': str(FOLDER / 'etc'),
        'ROS_TEST_RESULTS_DIR': str(results),
        'ROS_LOG_DIR': str(results / 'log'),
    }
    for name in NOT_OURS:
        environment.pop(name, None)
    code, watch = run_logged(['/usr/bin/rostest', str(path)], log, environment)
    reports = [read_report(report) for report in results.rglob('rosunit-*.xml')]
    count = with_exit_code(sum((report.count for report in reports), Count()), code)
    failed = [case for report in reports for case in report.failed]
    cases = [case.name for case in failed]
    logged = unexpected([log, *results.rglob('log/**/*.log')], read_expected(path.stem))
    if not count.failed:  # else they may be for that
        count, cases = count + Count(failed=len(logged)), logged
    if count.failed:
        name = ', '.join([f'{path.name}: {cases[0]}', *cases[1:]]) if cases else path.name
        command = f'./rosbots test {path.relative_to(ROOT)}'
        reason = '\n'.join(case.reason for case in failed[:1])
        count += Count(failures=(Failure(name, command, log, reason),))
    say_result(
        'rostest',
        path.name,
        count,
        watch,
        *(end_of(log) if count.failed else ()),
        *(f'    {error}' for error in logged),
    )
    return count
