#!/usr/bin/env python3
"""Mutation testing: whether the tests notice a wrong number, sign or comparison, or a lost line.

First all unit and engine tests that import the files run once, and it is recorded which functions
of the product each of them calls. Then one place is changed at a time, and the tests that call its
function run, those of the file's own folder and the quickest first, up to the first that fails. A
constant counts as called where its name is read.

A mutant that no test notices survived: it is to become a test, or to show that the line is not
needed. Tests that fail without any change are left out. The change is made in this process and its
forks: a program that a test starts, such as that of the renderer, has none. So try a survivor by
`./rosbots test` as well.

    ./rosbots bench mutants [--sample N] [--seed S] [--own] [--lines] [--again OUTPUT] [FOLDER…]
"""

from __future__ import annotations

import argparse
import ast
import contextlib
import multiprocessing
import os
import random
import signal
import sys
import time
from collections import Counter
from collections.abc import Iterable
from concurrent.futures import ProcessPoolExecutor, as_completed
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from calls import Function, Record
from forked_tests import import_others, record, run_tests
from mutation import Part, changed_line, mutant, parts, place_of, places, statements

sys.path.append(str(Path(__file__).resolve().parents[1] / 'tools'))
from changed import dependencies, test_files
from results import ROOT

PACKAGE = ROOT / 'src' / 'rosbots_description'
ROOMS = (
    'sim/plugins/drive',
    'sim/sensors',
    'sim/physics/bullet',
    'sim/description/inertia.py',
    'gym/tasks',
)
SAMPLE, WANTED = 300, 0.9  # mutants, share of them that tests have to notice
STAGES = "by the tests of the file's own folder", 'by any unit or engine test'
SURVIVED = 'survived            '
SHARES = 16  # of the files that run without any change; a process at a time takes one
FORK = multiprocessing.get_context('fork')


@dataclass(frozen=True)
class Mutant:
    """One changed place of a file."""

    path: Path
    tree: ast.Module  # unchanged
    number: int  # of the node

    def __str__(self) -> str:
        """Return file and line, before and after."""
        return f'{self.path.relative_to(PACKAGE)}: ' + '  ->  '.join(
            changed_line(self.tree, self.number)
        )


class Tests:
    """Runs tests on mutants.

    Attributes:
        broken: tests that fail without any change.
    """

    def __init__(self, records: dict[str, Record], imported: frozenset[Function]) -> None:
        self.broken = {name for name, record in records.items() if record.failed}
        self._records = records
        self._imported = imported
        self._sound: set[str] = set()  # tests that pass without any change when they run alone

    def of(self, one: Mutant) -> tuple[list[str], list[str]]:
        """Return the tests that can notice a mutant: those of its file's own folder, and others.

        The own folder is the nearest one above the file that has tests. Those with the file's name
        come first, then the quicker.
        """
        line, names = place_of(one.tree, one.number)
        function = (str(one.path), line)
        outside = not line or function in self._imported
        calls = self._readers(names) | {function} if outside else {function}
        found = {name for name, record in self._records.items() if record.calls & calls}
        folders = {_folder(name) for name in self._records}
        near = next(
            (path.parts for path in one.path.relative_to(PACKAGE).parents if path.parts in folders),
            (),
        )
        named = {name for name in self._records if f'/test_{one.path.name}' in name}
        own = {name for name in found if _folder(name) == near} | (named if outside else set())

        def order(name: str) -> tuple[bool, float]:
            return name not in named, self._records[name].seconds

        return sorted(own, key=order), sorted(found - own, key=order)

    @cached_property
    def _parts(self) -> list[Part]:
        return [part for path in files(['.']) for part in parts(path, ast.parse(path.read_bytes()))]

    def _readers(self, names: frozenset[str]) -> set[Function]:
        """Return the functions that read one of these names, or what is computed of them."""
        known = set(names)
        while True:
            readers = [part for part in self._parts if part.reads & known]
            more = set().union(*(part.defined for part in readers)) - known
            if not more:
                return {(str(part.path), part.line) for part in readers if part.line}
            known |= more

    def notice(self, one: Mutant, tests: list[str]) -> str:
        """Return how tests notice a mutant, or '' if they do not."""
        return self.notice_change(one.path, mutant(one.tree, one.number), tests)

    def notice_change(self, path: Path, changed: ast.Module, tests: list[str]) -> str:
        """Return how tests notice that a file has another content, or '' if they do not."""
        while left := [name for name in tests if name not in self.broken]:
            verdict, blamed = run_tests(left, path, changed)
            if not verdict:
                return ''
            if self._is_sound([blamed] if blamed else left):
                return f'{verdict} {blamed}'.rstrip()
            if blamed not in left:
                raise SystemExit(f'{verdict} without any change, too: {blamed or left}')
            self.broken.add(blamed)
        return ''

    def _is_sound(self, tests: list[str]) -> bool:
        """Tell whether tests pass without any change."""
        called = ' '.join(tests)
        if called not in self._sound and not run_tests(tests)[0]:
            self._sound.add(called)
        return called in self._sound


def _folder(name: str) -> tuple[str, ...]:
    """Return the folder of a test, below that of its level."""
    return Path(name.partition('::')[0]).parts[2:-1]


def files(rooms: list[str]) -> list[Path]:
    """Return the Python files of folders, or files, of the package."""
    found = [
        path
        for room in rooms
        for path in (
            [PACKAGE / room] if room.endswith('.py') else sorted((PACKAGE / room).rglob('*.py'))
        )
    ]
    return [path for path in found if path.name != '__init__.py' and path.is_file()]


def choose(arguments: argparse.Namespace) -> list[Mutant]:
    """Return the mutants that the arguments ask for."""
    kind = statements if arguments.lines else places
    paths = files(list(arguments.folders))
    survivors: set[str] = set()
    if arguments.again:
        lines = arguments.again.read_text(encoding='utf-8').splitlines()
        survivors = {line.removeprefix(SURVIVED) for line in lines if line.startswith(SURVIVED)}
        named = {one.partition(': ')[0] for one in survivors}
        paths = [path for path in paths if str(path.relative_to(PACKAGE)) in named]
    trees = {path: ast.parse(path.read_bytes()) for path in paths}
    every = [Mutant(path, tree, number) for path, tree in trees.items() for number in kind(tree)]
    if arguments.again:
        return [one for one in every if str(one) in survivors]
    print(f'{arguments.sample} of {len(every)} mutants, seed {arguments.seed}', flush=True)
    return random.Random(arguments.seed).sample(every, min(arguments.sample, len(every)))


@dataclass(frozen=True)
class Verdict:
    """What one stage of the tests says of a mutant."""

    one: Mutant
    noticed: str
    seconds: float
    broken: set[str]


class Worker:
    """A process of its own that runs one stage of the tests on mutants.

    Attributes:
        tests: what the main process has recorded; a fork shares it.
    """

    tests: Tests

    @classmethod
    def start(cls, tests: Tests) -> None:
        """Keep the tests."""
        cls.tests = tests

    @classmethod
    def judge(cls, one: Mutant, stage: int) -> Verdict:
        """Return what a stage says of a mutant."""
        start = time.monotonic()
        noticed = cls.tests.notice(one, cls.tests.of(one)[stage])
        return Verdict(one, noticed, time.monotonic() - start, cls.tests.broken)


def examine(chosen: list[Mutant], tests: Tests, stages: int) -> Counter[str]:
    """Print how each mutant is noticed; return the number of each verdict.

    For all mutants the tests of their own folders run first.
    """
    verdicts, living = Counter[str](), chosen
    with (
        ProcessPoolExecutor(None, FORK, Worker.start, (tests,)) as pool,
        contextlib.ExitStack() as at_end,
    ):
        at_end.callback(pool.shutdown, cancel_futures=True)  # also after a fault
        for stage in range(stages):
            tasks = [pool.submit(Worker.judge, one, stage) for one in living]
            living = []
            for task in as_completed(tasks):
                result = task.result()
                tests.broken |= result.broken
                verdict, _, name = result.noticed.partition(' ')
                if verdict:
                    verdicts[verdict] += 1
                    by = name and f'   by {name}'
                    print(f'{verdict:8} {result.seconds:6.1f} s  {result.one}{by}', flush=True)
                else:
                    living.append(result.one)
            print(f'{len(living)} of {len(chosen)} not noticed {STAGES[stage]}', flush=True)
    for one in living:
        print(f'{SURVIVED}{one}')
    return verdicts


def record_all(paths: Iterable[Path]) -> Tests:
    """Return the tests that import files, after a run without any change."""
    wanted = set(paths)
    found = [str(test.relative_to(ROOT)) for test in test_files() if wanted & dependencies(test)]
    print(f'{len(found)} files of tests without any change', flush=True)
    shares = [share for start in range(SHARES) if (share := found[start::SHARES])]
    records: dict[str, Record] = {}
    imported: set[Function] = set()
    with ProcessPoolExecutor(None, FORK) as pool:
        for some, called in pool.map(record, shares):
            records |= some
            imported |= called
    return Tests(records, frozenset(imported))


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
    # Shells start what they put in the background with it ignored, but tests send it.
    signal.signal(signal.SIGINT, signal.default_int_handler)
    os.chdir(ROOT)
    import_others()
    tests = record_all(one.path for one in chosen)
    verdicts = examine(chosen, tests, stages=1 if arguments.own else len(STAGES))
    for name in sorted(tests.broken):
        print(f'left out, since it fails without any change: {name}')
    noticed = verdicts.total()
    print(
        f'{noticed} of {len(chosen)} noticed: a test failed for {verdicts["failed"]}, '
        f'{verdicts["crashed"]} crashed, {verdicts["hung"]} hung'
    )
    return 0 if noticed >= WANTED * len(chosen) else 1


if __name__ == '__main__':
    sys.exit(main())
