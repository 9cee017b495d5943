#!/usr/bin/env python3
"""Mutation testing: whether the tests notice a wrong number, sign or comparison, or a lost line.

One place of a file is changed, and the unit and engine tests that import the file run, those of its
own folder first, the quickest before others, up to the first that fails. That happens in a fork of
this process, where the import of the file gives the changed one; no file is written, and programs
that a test starts have the unchanged one. A mutant that no test notices survived: it is to become a
test, or to show that the line is not needed. Tests that fail without any change are left out.

    ./rosbots bench mutants [--sample N] [--seed S] [--own] [--lines] [--again OUTPUT] [FOLDER…]
"""

from __future__ import annotations

import argparse
import ast
import contextlib
import faulthandler
import importlib
import json
import math
import os
import random
import resource
import signal
import sys
import tempfile
import time
from collections import Counter, defaultdict
from dataclasses import dataclass, field
from importlib.machinery import SourceFileLoader
from pathlib import Path
from typing import TYPE_CHECKING

from mutation import changed_line, mutant, places, statements

sys.path.append(str(Path(__file__).resolve().parents[1] / 'tools'))
from changed import dependencies, test_files
from results import ROOT

if TYPE_CHECKING:
    import pytest

PACKAGE = Path('src', 'rosbots_description')
ROOMS = (
    'sim/plugins/drive',
    'sim/sensors',
    'sim/physics/bullet',
    'sim/description/inertia.py',
    'gym/tasks',
)
SAMPLE, WANTED = 300, 0.9  # mutants, share of them that tests have to notice
# A test that takes as long hangs, which counts as noticed. The slowest takes 20 s of the processor.
HOPELESS_CPU, HOPELESS_WALL = 120, 1800  # [s]
# What tests import besides the product; all forks share it.
OTHERS = (
    'pytest',
    '_pytest.assertion.rewrite',
    'hypothesis',
    'numpy',
    'pybullet',
    'lxml.etree',
    'yaml',
    'msgspec',
    'gymnasium',
    'rospy',
    'collada',
    'PIL.Image',
    'rosgraph',
    'sensor_msgs.msg',
    'gazebo_msgs.srv',
    'tf2_msgs.msg',
    'pyarrow',
    'viser',
    'scipy.spatial',
)


def tests_of(path: Path) -> list[list[str]]:
    """Return the tests that import a file, in an order in which most mutants are noticed early.

    Those that have its name, unit and engine tests of its folder, which is the nearest one above
    that has tests, and all others.
    """
    found = [test.relative_to(ROOT) for test in test_files() if path in dependencies(test)]
    folders = [one.parts for one in path.relative_to(ROOT / PACKAGE).parents]
    near = next(one for one in folders if not one or one in {test.parts[2:-1] for test in found})
    own = [test for test in found if test.parts[2:-1] == near]
    named = [test for test in own if test.name == f'test_{path.name}']
    rest = [test for test in own if test not in named]
    others = [test for test in found if test not in own]
    stages = [
        named,
        *([test for test in rest if test.parts[1] == level] for level in ('unit', 'engine')),
        others,
    ]
    return [list(map(str, stage)) for stage in stages]


@dataclass(eq=False)  # pytest wants plugins that can be hashed
class Report:
    """Part of pytest's report, collected as its plugin."""

    seconds: dict[str, float] = field(default_factory=lambda: defaultdict(float))  # by file
    failed: list[str] = field(default_factory=list)  # names of tests, or of files without import

    def pytest_runtest_setup(self) -> None:
        """Limit the time of each test."""
        _limit_time()

    def pytest_collection_modifyitems(
        self, config: pytest.Config, items: list[pytest.Item]
    ) -> None:
        """Restore the order of the command line, which test/conftest.py changes."""
        order = {
            Path(name.partition('::')[0]).resolve(): place for place, name in enumerate(config.args)
        }
        items.sort(key=lambda item: order[item.path])

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        """Note one phase of a test."""
        self.seconds[report.nodeid.partition('::')[0]] += report.duration
        if report.failed:
            self.failed.append(report.nodeid)

    def pytest_collectreport(self, report: pytest.CollectReport) -> None:
        """Note a file that cannot be imported."""
        if report.failed:
            self.failed.append(report.nodeid)


class Tests:
    """Runs tests on mutants.

    Attributes:
        broken: tests that fail without any change.
    """

    def __init__(self) -> None:
        self.broken: set[str] = set()
        self._sound: set[str] = set()  # tests, or all of some files, that pass without any change
        self._seconds: dict[str, float] = {}  # by file, as far as known

    def notice(self, path: Path, changed: ast.Module, tests: list[str]) -> str:
        """Return how tests notice that a file has another content, or '' if they do not."""
        while files := sorted(set(tests) - self.broken, key=self._order):
            left_out = [f'--deselect={name}' for name in self.broken if '::' in name]
            report, verdict = _run(path, changed, ['-x', *files, *left_out])
            for name, seconds in report.seconds.items():
                self._seconds[name] = max(seconds, self._seconds.get(name, 0.0))
            if not verdict:
                return ''
            blamed = report.failed[:1] or files
            if self._is_sound(blamed):
                return ' '.join((verdict, *report.failed[:1]))
            if not report.failed:
                raise SystemExit(f'without any change, one {verdict}, too: {" ".join(files)}')
            self.broken.add(blamed[0])
        return ''

    def _order(self, name: str) -> tuple[float, str]:
        return self._seconds.get(name, 0.0), name

    def _is_sound(self, tests: list[str]) -> bool:
        """Tell whether tests pass without any change."""
        called = ' '.join(tests)
        if called not in self._sound and not _run(None, None, tests)[1]:
            self._sound.add(called)
        return called in self._sound


def _run(path: Path | None, changed: ast.Module | None, arguments: list[str]) -> tuple[Report, str]:
    """Run pytest in a fork, with another content of a file if given.

    Returns:
        the report, empty if the tests did not end by themselves; and 'failed', 'hung', 'crashed',
        or '' if all tests passed.
    """
    with tempfile.TemporaryFile() as output:
        child = os.fork()
        if child == 0:
            with contextlib.suppress(BaseException):
                os.setsid()
                with open(os.devnull, 'wb') as nowhere:
                    os.dup2(nowhere.fileno(), 1)
                    os.dup2(nowhere.fileno(), 2)
                resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
                faulthandler.disable()  # a crash is a result, of which nobody needs a trace
                _limit_time()
                if path:
                    _replace(path, changed)
                report = _run_pytest(arguments)
                output.write(json.dumps(report.__dict__).encode())
                output.flush()
            os._exit(0)
        status = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
        with contextlib.suppress(ProcessLookupError):
            os.killpg(child, signal.SIGKILL)  # what its tests have left behind
        output.seek(0)
        text = output.read()
    if not text:
        return Report(), ('hung' if -status in (signal.SIGALRM, signal.SIGXCPU) else 'crashed')
    report = Report(**json.loads(text))
    return report, 'failed' if report.failed else ''


def _limit_time() -> None:
    """End this process if it takes much longer from now on."""
    used = math.ceil(time.process_time())
    resource.setrlimit(resource.RLIMIT_CPU, (used + HOPELESS_CPU, resource.RLIM_INFINITY))
    signal.alarm(HOPELESS_WALL)


def _replace(path: Path, changed: ast.Module | None) -> None:
    """Let imports of a file in this process give the changed content."""
    get_code = SourceFileLoader.get_code

    def get_changed(loader: SourceFileLoader, name: str) -> object:
        if changed is not None and Path(loader.path).resolve() == path:  # the product has two names
            return compile(changed, str(path), 'exec')
        return get_code(loader, name)

    SourceFileLoader.get_code = get_changed  # type: ignore[method-assign, assignment]


def _run_pytest(arguments: list[str]) -> Report:
    import pytest

    sys.dont_write_bytecode = True
    report = Report()
    code = int(
        pytest.main(
            ['-q', '-p', 'no:cacheprovider', '-p', 'no:xdist', *arguments], plugins=[report]
        )
    )
    if code > pytest.ExitCode.TESTS_FAILED and code != pytest.ExitCode.NO_TESTS_COLLECTED:
        report.failed.append(f'pytest: exit code {code}')
    return report


def files(rooms: list[str]) -> list[Path]:
    """Return the Python files of folders, or files, of the package."""
    found = [
        path
        for room in rooms
        for path in (
            [ROOT / PACKAGE / room]
            if room.endswith('.py')
            else sorted((ROOT / PACKAGE / room).rglob('*.py'))
        )
    ]
    return [path for path in found if path.name != '__init__.py' and path.is_file()]


@dataclass(frozen=True)
class Mutant:
    """One changed place of a file."""

    path: Path
    tree: ast.Module  # unchanged
    number: int  # of the node

    def __str__(self) -> str:
        """Return file and line, before and after."""
        return f'{self.path.relative_to(ROOT / PACKAGE)}: ' + '  ->  '.join(
            changed_line(self.tree, self.number)
        )


def choose(arguments: argparse.Namespace) -> list[Mutant]:
    """Return the mutants that the arguments ask for."""
    kind = statements if arguments.lines else places
    trees = {path: ast.parse(path.read_bytes()) for path in files(list(arguments.folders))}
    every = [Mutant(path, tree, number) for path, tree in trees.items() for number in kind(tree)]
    if arguments.again:
        survivors = arguments.again.read_text(encoding='utf-8').splitlines()
        return [
            one
            for one in every
            if any(line.startswith('survived') and line.endswith(str(one)) for line in survivors)
        ]
    print(f'{arguments.sample} of {len(every)} mutants, seed {arguments.seed}', flush=True)
    return random.Random(arguments.seed).sample(every, min(arguments.sample, len(every)))


def _is_noticed(one: Mutant, stage: int, tests: Tests, verdicts: Counter[str]) -> bool:
    """Tell whether one stage of the tests of its file notices a mutant; print and count how."""
    start = time.monotonic()
    verdict, _, name = tests.notice(
        one.path, mutant(one.tree, one.number), tests_of(one.path)[stage]
    ).partition(' ')
    if verdict:
        verdicts[verdict] += 1
        print(
            f'{verdict:8} {time.monotonic() - start:6.1f} s  {one}{name and "   by " + name}',
            flush=True,
        )
    return bool(verdict)


def main() -> int:
    """Make mutants; return 1 if the tests notice too few."""
    parser = argparse.ArgumentParser(
        prog='./rosbots bench mutants',
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument('--sample', type=int, default=SAMPLE, help='how many mutants')
    parser.add_argument('--seed', type=int, default=0)
    parser.add_argument(
        '--own', action='store_true', help="only by the tests of the file's own folder, in minutes"
    )
    parser.add_argument(
        '--lines',
        action='store_true',
        help='leave out statements, instead of changing numbers and signs',
    )
    parser.add_argument(
        '--again',
        type=Path,
        metavar='OUTPUT',
        help='only those that survived, by the saved output of an earlier run',
    )
    parser.add_argument('folders', nargs='*', default=ROOMS, help='of the package')
    arguments = parser.parse_args()
    chosen = choose(arguments)
    os.chdir(ROOT)
    for name in OTHERS:
        with contextlib.suppress(ImportError):
            importlib.import_module(name)
    tests, verdicts, living = Tests(), Counter[str](), chosen
    for stage in range(3 if arguments.own else 4):  # for all mutants the quick tests first
        living = [one for one in living if not _is_noticed(one, stage, tests, verdicts)]
    for one in living:
        print(f'survived            {one}')
    for name in sorted(tests.broken):
        print(f'left out, since it fails without any change: {name}')
    noticed = len(chosen) - len(living)
    print(
        f'{noticed} of {len(chosen)} noticed: a test failed for {verdicts["failed"]}, '
        f'{verdicts["crashed"]} crashed, {verdicts["hung"]} hung'
    )
    return 0 if noticed >= WANTED * len(chosen) else 1


if __name__ == '__main__':
    sys.exit(main())
