#!/usr/bin/env python3
"""Mutation testing: whether the tests notice a wrong number, sign or comparison.

One place of a file is changed, and the unit and engine tests that import the file run, those of its
own folder first, up to the first that fails. That happens in a fork of this process, where the
import of the file gives the changed one; no file is written. A mutant that no test notices
survived: it is printed, to become a test, or to show that the line is not needed.

    ./rosbots bench mutants [--sample N] [--seed S] [--own] [FOLDER…]
"""

from __future__ import annotations

import argparse
import ast
import contextlib
import copy
import importlib
import os
import random
import resource
import signal
import sys
from importlib.machinery import SourceFileLoader
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1] / 'tools'))
from changed import dependencies, test_files
from results import ROOT

PACKAGE = Path('src', 'rosbots_description')
ROOMS = ('sim/plugins/drive', 'sim/sensors', 'sim/physics/bullet', 'sim/description/inertia.py',
         'gym/tasks')
SAMPLE, WANTED = 300, 0.9  # mutants, share of them that tests have to notice
HOPELESS = 300, 1800  # [s, processor], [s, wall] after which a mutant hangs, and so was noticed
# What tests import besides the product; all forks share it.
OTHERS = ('pytest', '_pytest.assertion.rewrite', 'hypothesis', 'numpy', 'pybullet', 'lxml.etree',
          'yaml', 'msgspec', 'gymnasium', 'rospy', 'collada', 'PIL.Image', 'rosgraph',
          'sensor_msgs.msg', 'gazebo_msgs.srv', 'tf2_msgs.msg', 'pyarrow', 'viser', 'scipy.spatial')
OPPOSITE: dict[type[ast.AST], type[ast.AST]] = {
    ast.Add: ast.Sub, ast.Sub: ast.Add, ast.Mult: ast.Div, ast.Div: ast.Mult,
    ast.Lt: ast.GtE, ast.GtE: ast.Lt, ast.Gt: ast.LtE, ast.LtE: ast.Gt, ast.Eq: ast.NotEq,
    ast.NotEq: ast.Eq, ast.And: ast.Or, ast.Or: ast.And}
OTHER_NAME = {'min': 'max', 'max': 'min'}


def mutate(node: ast.AST) -> bool:
    """Change a node in place; return whether there is something to change."""
    match node:
        case ast.Constant(value=bool(value)):
            node.value = not value
        case ast.Constant(value=int(value) | float(value)):
            node.value = 2 * value or type(value)(1)
        case ast.BinOp() | ast.BoolOp() if type(node.op) in OPPOSITE:
            node.op = OPPOSITE[type(node.op)]()  # type: ignore[assignment]
        case ast.Compare(ops=[first, *others]) if type(first) in OPPOSITE:
            node.ops = [OPPOSITE[type(first)](), *others]  # type: ignore[list-item]
        case ast.UnaryOp(op=ast.USub()):
            node.op = ast.UAdd()
        case ast.Call(func=ast.Name(id='min' | 'max' as name)):
            node.func = ast.Name(OTHER_NAME[name])
        case _:
            return False
    return True


def places(tree: ast.Module) -> list[int]:
    """Return the numbers of the nodes that can be changed; strict=True only asserts."""
    asserted = {id(node.value) for node in ast.walk(tree)
                if isinstance(node, ast.keyword) and node.arg == 'strict'}
    return [number for number, node in enumerate(ast.walk(tree))
            if id(node) not in asserted and mutate(copy.copy(node))]


def changed_line(tree: ast.Module, number: int) -> tuple[str, str]:
    """Return the first line that differs in a mutant, before and after."""
    before = ast.unparse(tree).splitlines()
    after = ast.unparse(mutant(tree, number)).splitlines()
    return next((one.strip(), other.strip()) for one, other in zip(before, after, strict=True)
                if one != other)


def mutant(tree: ast.Module, number: int) -> ast.Module:
    """Return the tree with the node of this number changed."""
    made = copy.deepcopy(tree)
    mutate(list(ast.walk(made))[number])
    return made


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
    stages = [named, *([test for test in rest if test.parts[1] == level]
                       for level in ('unit', 'engine')), others]
    return [list(map(str, stage)) for stage in stages]


def is_noticed(path: Path, changed: ast.Module, tests: list[list[str]]) -> bool:
    """Tell whether a test fails, hangs or crashes where the content of a file is another."""
    return any(_fails(path, changed, some) for some in tests if some)


def _fails(path: Path, changed: ast.Module, tests: list[str]) -> bool:
    child = os.fork()
    if child == 0:
        code = 1
        with contextlib.suppress(BaseException):
            os.setsid()
            nowhere = os.open(os.devnull, os.O_WRONLY)
            os.dup2(nowhere, 1)
            os.dup2(nowhere, 2)
            resource.setrlimit(resource.RLIMIT_CPU, (HOPELESS[0], HOPELESS[0]))
            signal.alarm(HOPELESS[1])
            code = _run_tests(path, changed, tests)
        os._exit(code)
    _, status = os.waitpid(child, 0)
    with contextlib.suppress(ProcessLookupError):
        os.killpg(child, signal.SIGKILL)  # what its tests have left behind
    return status != 0


def _run_tests(path: Path, changed: ast.Module, tests: list[str]) -> int:
    import pytest

    get_code = SourceFileLoader.get_code

    def get_changed(loader: SourceFileLoader, name: str) -> object:
        if Path(loader.path).resolve() == path:  # the product has two names
            return compile(changed, str(path), 'exec')
        return get_code(loader, name)

    SourceFileLoader.get_code = get_changed  # type: ignore[method-assign, assignment]
    sys.dont_write_bytecode = True
    return int(pytest.main(['-xq', '-p', 'no:cacheprovider', '-p', 'no:xdist', *tests]))


def files(rooms: list[str]) -> list[Path]:
    """Return the Python files of folders, or files, of the package."""
    found = [path for room in rooms for path in (
        [ROOT / PACKAGE / room] if room.endswith('.py')
        else sorted((ROOT / PACKAGE / room).rglob('*.py')))]
    return [path for path in found if path.name != '__init__.py' and path.is_file()]


def main() -> int:
    """Make mutants; return 1 if the tests notice too few."""
    parser = argparse.ArgumentParser(prog='./rosbots bench mutants', description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--sample', type=int, default=SAMPLE, help='how many mutants')
    parser.add_argument('--seed', type=int, default=0)
    parser.add_argument('--own', action='store_true',
                        help="only by the tests of the file's own folder, in minutes")
    parser.add_argument('folders', nargs='*', default=ROOMS, help='of the package')
    arguments = parser.parse_args()
    trees = {path: ast.parse(path.read_bytes()) for path in files(list(arguments.folders))}
    every = [(path, number) for path, tree in trees.items() for number in places(tree)]
    chosen = random.Random(arguments.seed).sample(every, min(arguments.sample, len(every)))
    print(f'{len(chosen)} of {len(every)} mutants, seed {arguments.seed}')
    os.chdir(ROOT)
    for name in OTHERS:
        with contextlib.suppress(ImportError):
            importlib.import_module(name)
    noticed = 0
    for path, number in chosen:
        tests = tests_of(path)[:3 if arguments.own else None]
        if is_noticed(path, ast.fix_missing_locations(mutant(trees[path], number)), tests):
            noticed += 1
        else:
            lines = '  ->  '.join(changed_line(trees[path], number))
            print(f'survived: {path.relative_to(ROOT / PACKAGE)}: {lines}', flush=True)
    print(f'{noticed} of {len(chosen)} noticed')
    return 0 if noticed >= WANTED * len(chosen) else 1


if __name__ == '__main__':
    sys.exit(main())
