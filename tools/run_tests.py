#!/usr/bin/env python3
"""Run every test of the project, and end with one line 'N passed, N failed'.

Phases: first rostest (each test/rostest/*.test with its own master, several side by side); then,
side by side, lint (ruff, mypy, the documentation's site, catkin_lint, launch files), unit (pytest,
no ROS master) and engine (pytest, PyBullet without a window), each of the latter two in several
processes. A phase without any test counts as failed. What failed is listed at the end with
the command that repeats it.
"""

from __future__ import annotations

import argparse
import json
import os
import shlex
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from importlib.metadata import version
from pathlib import Path

import changed
from results import (
    REPORTS,
    ROOT,
    Count,
    Failure,
    Stopwatch,
    end_of,
    read_report,
    run_logged,
    say,
    say_failures,
    say_result,
    with_exit_code,
)
from rostests import choose, run_rostests

SUMMARY = REPORTS / 'summary.json'  # for repeat_tests.py
# Two phases run at once, so more processes would only compete for the processors' caches.
# A file stays in one process.
PARALLEL = ['-n', str(os.cpu_count() or 1), '--dist', 'loadfile']
NAVIGATION = ROOT / '.ws' / 'stamps' / 'navigation'  # when ./rosbots navigation has built it
HOPELESS = 900  # [s, wall] after which a test fails that stands still; it shows all stacks


def run_command(phase: str, name: str, command: list[str]) -> Count:
    """Run a check that passes or fails as a whole; show its output if it fails."""
    log = REPORTS / f'{phase} {name}.log'.replace(' ', '_').replace('/', '_')
    code, watch = run_logged(command, log)
    count = Count(passed=1)
    if code:
        again = f'./rosbots exec {shlex.join(command)}'
        count = Count(failed=1, failures=(Failure(name, again, log),))
    say_result(phase, name, count, watch, *(end_of(log) if code else ()))
    return count


def type_checks() -> dict[str, list[str]]:
    """Return the command that checks types; none where NumPy has other types than in Debian 12."""
    if not version('numpy').startswith('1.'):
        say('SKIPPED mypy: types are checked with those of NumPy 1, which Debian 12 has')
        return {}
    return {'mypy': [sys.executable, '-m', 'mypy', '--no-error-summary']}


def run_lint(_word: str) -> Count:
    """Check style, manifests and launch files."""
    checks = {
        'ruff': ['ruff', 'check', '--quiet', '--output-format', 'concise', '.'],
        'ruff format': ['ruff', 'format', '--check', '--quiet', '.'],
        **type_checks(),
        'site': [sys.executable, 'tools/make_site.py', str(REPORTS / 'site')],
        # the folder of a clone may have any name
        'catkin_lint': [
            'catkin_lint',
            '-W2',
            '--strict',
            '--ignore',
            'package_path_name',
            '.',
            *map(str, sorted((ROOT / 'companions').iterdir())),
        ],
    }
    checker = '/usr/share/roslaunch/scripts/roslaunch-check'
    for folder in sorted([ROOT / 'launch', *ROOT.glob('companions/*/launch')]):
        name = f'roslaunch-check {folder.relative_to(ROOT)}'
        if folder.parent.name == 'rosbots_navigation' and not NAVIGATION.exists():
            say(f'SKIPPED {name}: what it starts is not built; ./rosbots navigation')
            continue
        checks[name] = ['/usr/bin/python3', checker, str(folder)]
    return sum((run_command('lint', name, command) for name, command in checks.items()), Count())


def run_pytest(phase: str, options: list[str]) -> Count:
    """Run tests of test/<phase>."""
    report, log = REPORTS / f'{phase}.xml', REPORTS / f'{phase}.log'
    watch = Stopwatch()
    with (
        log.open('w') as written,
        subprocess.Popen(
            [
                sys.executable,
                '-m',
                'pytest',
                '-q',
                f'--timeout={HOPELESS}',
                f'--junitxml={report}',
                *options,
            ],
            cwd=ROOT,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            errors='replace',
        ) as process,
    ):
        assert process.stdout is not None
        for line in process.stdout:
            written.write(line)
            say(line.rstrip('\n'))
        watch.wait(process)
    read = read_report(report)
    count = with_exit_code(read.count, process.returncode)
    again = {
        node: case.reason for case in read.failed if (node := node_of(case.class_name, case.name))
    } or {f'test/{phase}': ''}
    if count.failed:
        count += Count(
            failures=tuple(
                Failure(node, f'./rosbots test {shlex.quote(node)}', log, reason)
                for node, reason in again.items()
            )
        )
    say_result(phase, f'test/{phase}', count, watch)
    return count


def node_of(classname: str, name: str) -> str:
    """Return the name by which pytest knows a case of its report; '' if it belongs to no file."""
    parts = classname.split('.')
    for end in range(len(parts), 0, -1):
        path = Path(*parts[:end]).with_suffix('.py')
        if (ROOT / path).is_file():
            return '::'.join([str(path), *parts[end:], name])
    return ''


def pytest_phase(phase: str) -> Callable[[str], Count]:
    """Return what runs test/<phase>, its files side by side."""
    return lambda word: run_pytest(phase, [*PARALLEL, '-k', word, f'test/{phase}'])


PHASES: dict[str, Callable[[str], Count]] = {
    'lint': run_lint,
    'unit': pytest_phase('unit'),
    'engine': pytest_phase('engine'),
    'rostest': lambda word: run_rostests(choose(word)),
}
# All at once compete for the processors' caches: unit and engine then take a seventh more of them.
SIDE_BY_SIDE = (('rostest',), ('lint', 'unit', 'engine'))


def run_tests(names: list[str]) -> Count:
    """Run single tests: .test files, and files or cases of pytest."""
    files = [(ROOT / name).resolve() for name in names if name.endswith('.test')]
    cases = [name for name in names if not name.endswith('.test')]
    count = run_rostests(files) if files else Count()
    return count + run_pytest('chosen', cases) if cases else count


def run_changed(took: dict[str, float]) -> Count:
    """Run lint and the tests that the change since main can have touched; say what is left out."""
    choice = changed.choose(changed.changed_files())
    say(f'left out: {choice.left_out}')
    whole = ['lint'] + (['unit', 'engine'] if choice.cases is None else [])
    total = run_phases(whole, '', took)
    if choice.cases:
        total += run_pytest('chosen', [*PARALLEL, *choice.cases])
    if choice.rostests is None:
        return total + run_phases(['rostest'], '', took)
    return total + run_rostests(choice.rostests) if choice.rostests else total


def run_phases(phases: list[str], word: str, took: dict[str, float]) -> Count:
    """Run phases, some side by side, since they wait at times; note the wall time of each [s]."""

    def run(phase: str) -> Count:
        start = time.monotonic()
        count = PHASES[phase](word)
        took[phase] = time.monotonic() - start
        return count

    total = Count()
    for together in SIDE_BY_SIDE:
        with ThreadPoolExecutor(len(together)) as pool:
            total += sum(pool.map(run, [name for name in together if name in phases]), Count())
    return total


def parse(argv: list[str] | None) -> argparse.Namespace:
    """Read the command line."""
    parser = argparse.ArgumentParser(
        prog='./rosbots test',
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument(
        'tests',
        nargs='*',
        metavar='PHASE|TEST',
        help=f'{", ".join(PHASES)}; or files, as test/rostest/frames.test and '
        'test/unit/test_x.py::test_y',
    )
    parser.add_argument('-k', dest='word', default='', help='only tests whose name has this word')
    parser.add_argument(
        '--seed',
        type=int,
        default=0,
        metavar='N',
        help="of Python's hashes, and so of the order of sets (default: 0)",
    )
    parser.add_argument(
        '--changed',
        action='store_true',
        help='only what the change since main can have touched, and lint',
    )
    arguments = parser.parse_args(argv)
    if arguments.changed and (arguments.tests or arguments.word):
        parser.error('--changed chooses the tests; name none')
    for name in arguments.tests:
        if name not in PHASES and not (ROOT / name.partition('::')[0]).is_file():
            parser.error(
                f'there is no phase and no file {name!r}; the phases are {", ".join(PHASES)}'
            )
    return arguments


def main(argv: list[str] | None = None) -> int:
    """Run what the command line names, by default all phases; return the exit code."""
    arguments = parse(argv)
    os.environ['PYTHONHASHSEED'] = str(arguments.seed)
    # Else each of the hundreds of processes would compile our sources anew, and threads of numpy's
    # library would spin for 0.1 s when it starts.
    os.environ.pop('PYTHONDONTWRITEBYTECODE', None)
    os.environ.setdefault('OPENBLAS_NUM_THREADS', '1')
    # A shell lets what runs in its background ignore Ctrl-C, and all tests would inherit that.
    signal.signal(signal.SIGINT, signal.default_int_handler)
    shutil.rmtree(REPORTS, ignore_errors=True)
    REPORTS.mkdir(parents=True)
    start, took = time.monotonic(), dict[str, float]()
    single = [name for name in arguments.tests if name not in PHASES]
    phases = [name for name in PHASES if name in arguments.tests or not arguments.tests]
    if arguments.changed:
        total = run_changed(took)
    else:
        total = run_phases(phases, arguments.word, took)
        if single:
            total += run_tests(single)
    SUMMARY.write_text(
        json.dumps(
            {
                'seconds': took | {'all': time.monotonic() - start},
                'passed': total.passed,
                'failed': total.failed,
                'failures': [failure.name for failure in total.failures],
            }
        )
    )
    skipped = f' ({total.skipped} skipped)' if total.skipped else ''
    say_failures(total.failures, arguments.seed)
    say(
        '',
        f'all phases took {time.monotonic() - start:.0f} s{skipped}',
        f'{total.passed} passed, {total.failed} failed',
    )
    return 1 if total.failed else 0


if __name__ == '__main__':
    sys.exit(main())
