#!/usr/bin/env python3
"""Mutation testing: whether the tests notice a wrong number, sign or comparison.

One place of a file is changed in a copy of the repository, and the unit and engine tests that
import the file run there, those of its own folder first. A mutant that no test notices survived:
it is printed, to become a test, or to show that the line is not needed.

    ./rosbots bench mutants [--sample N] [--seed S] [FOLDER…]
"""

from __future__ import annotations

import argparse
import ast
import copy
import os
import random
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1] / 'tools'))
from changed import dependencies, test_files
from results import ROOT

PACKAGE = Path('src', 'rosbots_description')
ROOMS = ('sim/plugins/drive', 'sim/sensors', 'sim/physics/bullet', 'sim/description/inertia.py',
         'gym/tasks')
SAMPLE, WANTED = 300, 0.9  # mutants, share of them that tests have to notice
HOPELESS = 900.0  # [s, wall] after which a mutant runs forever, and so was noticed
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
    """Return the numbers of the nodes that can be changed."""
    return [number for number, node in enumerate(ast.walk(tree)) if mutate(copy.copy(node))]


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
    """Return the tests that import a file: those of its folder, and the others."""
    folder = path.relative_to(ROOT / PACKAGE).parent
    found = [test for test in test_files() if path in dependencies(test)]
    own = [test for test in found if test.relative_to(ROOT / 'test').parts[1:-1] == folder.parts]
    return [[str(test.relative_to(ROOT)) for test in tests]
            for tests in (own, [test for test in found if test not in own]) if tests]


def is_noticed(place: Path, tests: list[list[str]]) -> bool:
    """Tell whether a test fails in a copy of the repository."""
    for some in tests:
        try:
            code = subprocess.run(
                [sys.executable, '-m', 'pytest', '-xq', '-n', 'auto', '--dist', 'loadfile', *some],
                cwd=place, env=os.environ | {'PYTHONDONTWRITEBYTECODE': '1'}, timeout=HOPELESS,
                stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=False).returncode
        except subprocess.TimeoutExpired:
            return True
        if code:
            return True
    return False


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
    parser.add_argument('folders', nargs='*', default=ROOMS, help='of the package')
    arguments = parser.parse_args()
    trees = {path: ast.parse(path.read_bytes()) for path in files(list(arguments.folders))}
    every = [(path, number) for path, tree in trees.items() for number in places(tree)]
    chosen = random.Random(arguments.seed).sample(every, min(arguments.sample, len(every)))
    print(f'{len(chosen)} of {len(every)} mutants, seed {arguments.seed}')
    noticed = 0
    with tempfile.TemporaryDirectory() as folder:
        place = Path(folder, 'copy')
        shutil.copytree(ROOT, place, ignore=shutil.ignore_patterns('.ws', '.git', '__pycache__'))
        for path, number in chosen:
            copied = place / path.relative_to(ROOT)
            copied.write_text(ast.unparse(mutant(trees[path], number)), encoding='utf-8')
            if is_noticed(place, tests_of(path)):
                noticed += 1
            else:
                lines = '  ->  '.join(changed_line(trees[path], number))
                print(f'survived: {path.relative_to(ROOT / PACKAGE)}: {lines}')
            shutil.copy(path, copied)
    print(f'{noticed} of {len(chosen)} noticed')
    return 0 if noticed >= WANTED * len(chosen) else 1


if __name__ == '__main__':
    sys.exit(main())
