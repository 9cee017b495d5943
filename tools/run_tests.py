#!/usr/bin/env python3
"""Run every test of the project, cheapest first, and end with one line 'N passed, N failed'.

Phases: lint (ruff, mypy, catkin_lint, launch files), unit (pytest, no ROS master), engine (pytest,
PyBullet without a window), rostest (each test/rostest/*.test with its own master). A phase without
any test counts as failed.
"""

from __future__ import annotations

import argparse
import json
import os
import shutil
import subprocess
import sys
import time
from dataclasses import dataclass
from pathlib import Path
from xml.etree import ElementTree

ROOT = Path(__file__).resolve().parent.parent
REPORTS = (ROOT / '.ws').resolve() / 'test_results'  # rostest needs a path without spaces
COVERAGE = REPORTS / 'coverage'
LEAST = 5  # files to list
OUTPUT_LINES = 60  # of a failed test's output, shown at the end


@dataclass(frozen=True)
class Count:
    """Numbers of tests."""

    passed: int = 0
    failed: int = 0
    skipped: int = 0

    def __add__(self, other: Count) -> Count:
        """Return the sum, kind by kind."""
        return Count(self.passed + other.passed, self.failed + other.failed,
                     self.skipped + other.skipped)


def count_report(path: Path) -> Count:
    """Count the test cases of a junit file; one that cannot be read is one failure.

    rosunit knows no skipped tests and counts them as passed; such a test prints a line that begins
    with SKIPPED, which is shown.
    """
    try:
        report = ElementTree.parse(path)
    except (OSError, ElementTree.ParseError):
        return Count(failed=1)
    cases = list(report.iter('testcase'))
    bad = sum(any(case.find(tag) is not None for tag in ('failure', 'error')) for case in cases)
    told = [line for output in report.iter('system-out')
            for line in (output.text or '').splitlines() if line.startswith('SKIPPED ')]
    print(*told, sep='\n', end='\n' if told else '')
    skipped = len(told) + sum(case.find('skipped') is not None for case in cases)
    return Count(len(cases) - bad - skipped, bad, skipped)


def with_exit_code(count: Count, code: int) -> Count:
    """Return the count, plus a failure if only the exit code reports one."""
    if count.failed == 0 and (code != 0 or count.passed == 0):
        return count + Count(failed=1)
    return count


def print_result(phase: str, name: str, count: Count, seconds: float) -> None:
    """Print one line with the result of a check."""
    verdict = 'FAILED' if count.failed else 'ok'
    skipped = f', {count.skipped} skipped' if count.skipped else ''
    print(f'{phase:8} {name:42} {verdict:6} {count.passed} passed, {count.failed} failed{skipped}'
          f'  {seconds:.1f} s', flush=True)


def run_command(phase: str, name: str, command: list[str]) -> Count:
    """Run a check that passes or fails as a whole; show its output if it fails."""
    start = time.monotonic()
    done = subprocess.run(command, cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          text=True, check=False)
    count = Count(failed=1) if done.returncode else Count(passed=1)
    print_result(phase, name, count, time.monotonic() - start)
    if done.returncode:
        print(done.stdout)
    return count


def run_lint(_word: str) -> Count:
    """Check style, manifests and launch files."""
    checks = {
        'ruff': ['ruff', 'check', '--quiet', '--output-format', 'concise', '.'],
        'mypy': [sys.executable, '-m', 'mypy', '--no-error-summary'],
        'mypy --strict': [sys.executable, '-m', 'mypy', '--no-error-summary', '--strict',
                          '--cache-dir=.ws/mypy_cache/strict', 'src/rosbots_description/sim'],
        # the folder of a clone may have any name
        'catkin_lint': ['catkin_lint', '-W2', '--strict', '--ignore', 'package_path_name', '.',
                        *map(str, sorted((ROOT / 'companions').iterdir()))],
    }
    checker = '/usr/share/roslaunch/scripts/roslaunch-check'
    for folder in sorted([ROOT / 'launch', *ROOT.glob('companions/*/launch')]):
        name = f'roslaunch-check {folder.relative_to(ROOT)}'
        checks[name] = ['/usr/bin/python3', checker, str(folder)]
    return sum((run_command('lint', name, command) for name, command in checks.items()), Count())


def run_pytest(
    phase: str, word: str, measure: tuple[str, ...] = (), options: tuple[str, ...] = ()
) -> Count:
    """Run the tests of test/<phase>; `measure` is what runs pytest as a module and watches it."""
    report = REPORTS / f'{phase}.xml'
    start = time.monotonic()
    code = subprocess.run([sys.executable, *measure, '-m', 'pytest', '-q', f'--junitxml={report}',
                           *options, '-k', word, f'test/{phase}'], cwd=ROOT, check=False).returncode
    count = with_exit_code(count_report(report), code)
    print_result(phase, f'test/{phase}', count, time.monotonic() - start)
    return count


def run_unit(word: str) -> Count:
    """Run test/unit with coverage; a part of it would say nothing.

    test/engine runs without it: its loops over steps take 1.8 times as long when traced, which is
    minutes. So what needs an engine or a renderer is listed as not covered.
    """
    watched = ('-m', 'coverage', 'run', f'--data-file={COVERAGE}')
    return run_pytest('unit', word, () if word else watched)


def least_covered() -> str:
    """Return one line about the coverage of test/unit."""
    done = subprocess.run(
        [sys.executable, '-m', 'coverage', 'json', '-i', '-o', '-', f'--data-file={COVERAGE}'],
        cwd=ROOT, stdout=subprocess.PIPE, check=True)
    report = json.loads(done.stdout)
    files = {path.removeprefix('src/rosbots_description/'): file['summary']
             for path, file in report['files'].items()}
    share = {path: summary['percent_covered'] for path, summary in files.items()}
    order = sorted(files, key=lambda path: (share[path], -files[path]['num_statements']))
    least = (f'{path} {share[path]:.0f} %' for path in order[:LEAST])
    total = report['totals']['percent_covered']
    return (f'test/unit runs {total:.0f} % of the lines of sim and ros_api; '
            f'fewest of {", ".join(least)}')


def run_rostest(path: Path) -> Count:
    """Run a .test file; return the count of its reports, with its exit code."""
    results = REPORTS / 'rostest' / path.stem
    results.mkdir(parents=True)
    log = results / 'output.log'
    environment = {**os.environ, 'ROS_TEST_RESULTS_DIR': str(results)}
    # independent of the caller's master and addresses, and of unbuffered output
    for name in ('ROS_MASTER_URI', 'ROS_IP', 'ROS_HOSTNAME', 'ROS_NAMESPACE', 'PYTHONUNBUFFERED'):
        environment.pop(name, None)
    start = time.monotonic()
    with log.open('wb') as output:
        code = subprocess.run(['/usr/bin/rostest', str(path)], cwd=ROOT, env=environment,
                              stdin=subprocess.DEVNULL, stdout=output, stderr=subprocess.STDOUT,
                              check=False).returncode
    reports = results.rglob('rosunit-*.xml')
    count = with_exit_code(sum((count_report(report) for report in reports), Count()), code)
    print_result('rostest', path.name, count, time.monotonic() - start)
    if count.failed:
        lines = log.read_text(errors='replace').splitlines()
        print('\n'.join(f'    {line}' for line in lines[-OUTPUT_LINES:]))
        print(f'    (complete output: {log})')
    return count


def run_rostests(word: str) -> Count:
    """Run the .test files one after the other, since they measure time."""
    paths = [path for path in sorted((ROOT / 'test' / 'rostest').glob('*.test'))
             if word in path.stem]
    if not paths:
        print('rostest  there is no such test in test/rostest')
        return Count(failed=1)
    return sum(map(run_rostest, paths), Count())


PHASES = {
    'lint': run_lint,
    'unit': run_unit,
    # a process per processor: 176 s instead of 308 s on two
    'engine': lambda word: run_pytest('engine', word, options=('-n', 'auto', '--dist', 'loadfile')),
    'rostest': run_rostests,
}


def main(argv: list[str] | None = None) -> int:
    """Run the phases that the command line names, by default all; return the exit code."""
    parser = argparse.ArgumentParser(prog='./rosbots test', description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('phases', nargs='*', metavar='PHASE', help=', '.join(PHASES))
    parser.add_argument('-k', dest='word', default='', help='only tests whose name has this word')
    arguments = parser.parse_args(argv)
    for phase in arguments.phases:
        if phase not in PHASES:
            parser.error(f'there is no phase {phase!r}; the phases are {", ".join(PHASES)}')
    shutil.rmtree(REPORTS, ignore_errors=True)
    REPORTS.mkdir(parents=True)
    start = time.monotonic()
    total = sum((PHASES[phase](arguments.word) for phase in arguments.phases or PHASES), Count())
    skipped = f' ({total.skipped} skipped)' if total.skipped else ''
    if COVERAGE.exists():
        print(f'\n{least_covered()}', end='')
    print(f'\nall phases took {time.monotonic() - start:.0f} s{skipped}')
    print(f'{total.passed} passed, {total.failed} failed')
    return 1 if total.failed else 0


if __name__ == '__main__':
    sys.exit(main())
