"""Which tests a change can have touched, by the imports of Python files; all when unsure.

Tests of test/unit and test/engine are chosen if a chain of imports leads to a changed file. The
import of a package counts as that of all its modules, since packages import some only when used.
Tests that start other programs or read the source have no such chain and always run. Every change
of the product runs all rostests; a test program runs the files that name it, and a lesson the one
that follows it.
"""

from __future__ import annotations

import ast
import subprocess
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from results import ROOT

PROSE = ('.md', '.rst')
LESSONS = 'doc/lessons/'  # pages that a rostest follows
GRAPHED = (
    'src/rosbots_description/',
    'test/unit/',
    'test/engine/',
    'test/support/',
    'benchmark/',
    'tools/',
)
PLACES = (ROOT / 'src', ROOT / 'test', ROOT / 'benchmark', ROOT / 'tools')  # of absolute imports
# A test with one of these words depends on more than it imports.
BEYOND = ('subprocess', 'read_text', 'read_bytes', 'importlib', 'glob(')


@dataclass(frozen=True)
class Choice:
    """Tests to run; None: all of that kind."""

    cases: list[str] | None  # files of test/unit and test/engine
    rostests: list[Path] | None
    left_out: str  # a sentence


def changed_files() -> list[str]:
    """Return the files that differ from main, new ones included."""

    def git(*words: str) -> list[str]:
        return subprocess.run(
            ['git', *words], cwd=ROOT, capture_output=True, text=True, check=True
        ).stdout.splitlines()

    base = git('merge-base', 'main', 'HEAD')[0]
    return sorted(
        {*git('diff', '--name-only', base), *git('ls-files', '--others', '--exclude-standard')}
    )


def choose(changed: Iterable[str]) -> Choice:
    """Return the tests that changes of these files can have touched."""
    changed = list(changed)
    code = [name for name in changed if not name.endswith(PROSE)]
    every = test_files()
    unknown = [
        name
        for name in code
        if not (
            name.startswith('test/rostest/')
            or (name.startswith(GRAPHED) and name.endswith('.py') and (ROOT / name).exists())
        )
    ]
    if unknown:
        return Choice(None, None, f'nothing: {unknown[0]} can touch every test')
    seeds = {ROOT / name for name in code}
    cases = [path for path in every if reaches_beyond(path) or seeds & dependencies(path)]
    rostests = touched_rostests(
        [*code, *('test/rostest/lessons.test' for name in changed if name.startswith(LESSONS))]
    )
    files = sorted((ROOT / 'test' / 'rostest').glob('*.test'))
    chosen = len(files if rostests is None else rostests)
    return Choice(
        [str(path.relative_to(ROOT)) for path in cases],
        rostests,
        f'{len(every) - len(cases)} of {len(every)} files of test/unit and test/engine, '
        f'{len(files) - chosen} of {len(files)} rostests: no import leads from them to '
        'the change',
    )


def test_files() -> list[Path]:
    """Return the files of test/unit and test/engine."""
    return sorted(
        path for level in ('unit', 'engine') for path in (ROOT / 'test' / level).rglob('test_*.py')
    )


def touched_rostests(code: Iterable[str]) -> list[Path] | None:
    """Return the .test files that a change touches; None for all."""
    found: set[Path] = set()
    for name in code:
        path = ROOT / name
        if name.startswith(('test/unit/', 'test/engine/')):
            continue
        if path.parent == ROOT / 'test' / 'rostest':
            users = {
                one
                for one in path.parent.glob('*.test')
                if one == path or path.name in one.read_text(encoding='utf-8')
            }
            if users:
                found |= users
                continue
        return None
    return sorted(found)


@cache
def reaches_beyond(path: Path) -> bool:
    """Tell whether a test depends on more than its imports say."""
    text = path.read_text(encoding='utf-8')
    return any(word in text for word in BEYOND)


@cache
def dependencies(path: Path) -> frozenset[Path]:
    """Return a file and all files that it imports, directly or not."""
    found, waiting = {path}, [path]
    while waiting:
        for one in imports(waiting.pop()) - found:
            found.add(one)
            waiting.append(one)
    return frozenset(found)


@cache
def imports(path: Path) -> frozenset[Path]:
    """Return the files of this project that a file imports directly."""
    found: set[Path] = set()
    for node in statements(ast.parse(path.read_bytes())):
        if isinstance(node, ast.Import):
            for name in node.names:
                found |= absolute(name.name)
        elif isinstance(node, ast.ImportFrom):
            origin = [node.module] if node.module else []
            for full in map('.'.join, [origin, *([*origin, one.name] for one in node.names)]):
                found |= relative(path, node.level, full) if node.level else absolute(full)
    return frozenset(found)


def statements(node: ast.AST) -> Iterator[ast.AST]:
    """Yield the statements below a node, for those alone can be imports."""
    for field in ('body', 'orelse', 'finalbody', 'handlers', 'cases'):
        below = getattr(node, field, ())
        for one in below if isinstance(below, list) else ():
            yield one
            yield from statements(one)


def absolute(name: str) -> set[Path]:
    """Return the files of a module; the companions' name of the product is another for it."""
    name = name.replace('rosbots_simulator', 'rosbots_description', 1).replace('.', '/')
    return {one for place in PLACES for one in module(f'{place}/{name}')}


def relative(path: Path, level: int, name: str) -> frozenset[Path]:
    """Return the files of a module that is named relative to a file; none without a name."""
    folder = path.parents[level - 1]
    return module(f'{folder}/{name.replace(".", "/")}') if name else frozenset()


@cache
def module(place: str) -> frozenset[Path]:
    """Return the file of a module, or all files of a package; none if there is none."""
    if Path(f'{place}.py').is_file():
        return frozenset({file(f'{place}.py')})
    start = Path(place, '__init__.py')
    if not start.is_file():
        return frozenset()
    whole = start.parent != ROOT / 'src' / 'rosbots_description'
    return frozenset(map(file, map(str, start.parent.rglob('*.py') if whole else [start])))


@cache
def file(name: str) -> Path:
    """Return a path, always the same object: others compare slowly."""
    return Path(name)
