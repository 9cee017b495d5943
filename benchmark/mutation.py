"""Mutants of a syntax tree: one number, sign, comparison or limit changed, or one statement gone.

Left alone is what only asserts or only saves time and memory, where every mutant is equivalent:
strict=True of zip, frozen=True and slots=True of a dataclass, and the size of a cache.

Beside them, who reads what: a number outside functions counts where its name is read.
"""

from __future__ import annotations

import ast
import copy
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

FUNCTION = (ast.FunctionDef, ast.AsyncFunctionDef)

OPPOSITE: dict[type[ast.AST], type[ast.AST]] = {
    ast.Add: ast.Sub,
    ast.Sub: ast.Add,
    ast.Mult: ast.Div,
    ast.Div: ast.Mult,
    ast.Lt: ast.GtE,
    ast.GtE: ast.Lt,
    ast.Gt: ast.LtE,
    ast.LtE: ast.Gt,
    ast.Eq: ast.NotEq,
    ast.NotEq: ast.Eq,
    ast.And: ast.Or,
    ast.Or: ast.And,
}
OTHER_NAME = {'min': 'max', 'max': 'min'}
EQUIVALENT = ('strict', 'frozen', 'slots', 'maxsize')  # keyword arguments


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
    equivalent = {
        id(node.value)
        for node in ast.walk(tree)
        if isinstance(node, ast.keyword) and node.arg in EQUIVALENT
    }
    return [
        number
        for number, node in enumerate(ast.walk(tree))
        if id(node) not in equivalent and mutate(copy.copy(node))
    ]


def statements(tree: ast.Module) -> list[int]:
    """Return the numbers of the statements that can be left out: no import, docstring or pass."""
    return [
        number
        for number, node in enumerate(ast.walk(tree))
        if isinstance(
            node,
            ast.Assign
            | ast.AugAssign
            | ast.Return
            | ast.Raise
            | ast.Delete
            | ast.Continue
            | ast.Break,
        )
        or (isinstance(node, ast.AnnAssign) and node.value)
        or (isinstance(node, ast.Expr) and not isinstance(node.value, ast.Constant))
    ]


def mutant(tree: ast.Module, number: int) -> ast.Module:
    """Return the tree with the node of this number changed, or left out if it is a statement."""
    made = copy.deepcopy(tree)
    nodes = list(ast.walk(made))
    node = nodes[number]
    if isinstance(node, ast.stmt):
        for parent in nodes:
            for name, body in ast.iter_fields(parent):
                if isinstance(body, list) and node in body:
                    setattr(parent, name, [ast.Pass() if one is node else one for one in body])
    else:
        mutate(node)
    return ast.fix_missing_locations(made)


def changed_line(tree: ast.Module, number: int) -> tuple[str, str]:
    """Return the first line that differs in a mutant, before and after."""
    before = ast.unparse(tree).splitlines()
    after = ast.unparse(mutant(tree, number)).splitlines()
    return next(
        (one.strip(), other.strip())
        for one, other in zip(before, after, strict=False)
        if one != other
    )


@dataclass(frozen=True)
class Part:
    """A function, or a statement outside functions, with the names that it reads.

    Attributes:
        line: of the function, as its code object has it; 0: outside functions.
        defined: what a statement outside functions gives a value.
    """

    path: Path
    line: int
    reads: frozenset[str]
    defined: frozenset[str] = frozenset()


def parts(path: Path, tree: ast.Module) -> Iterator[Part]:
    """Yield all functions, and statements outside them, of a file."""
    for node in ast.walk(tree):
        if isinstance(node, FUNCTION):
            yield Part(path, _line(node), _names(node))
        elif isinstance(node, ast.Module | ast.ClassDef):
            for one in node.body:
                if isinstance(one, ast.Assign | ast.AnnAssign):
                    yield Part(path, 0, _names(one), _defined(one))
        if isinstance(node, ast.ClassDef):
            yield Part(path, 0, _names(*node.bases, *node.decorator_list), frozenset({node.name}))


def place_of(tree: ast.Module, number: int) -> tuple[int, frozenset[str]]:
    """Return the line of the innermost function of a node; or else 0; and the names it defines.

    A function defines its own name; a statement outside functions, those that it gives a value, and
    the names of the classes around it.
    """
    wanted = list(ast.walk(tree))[number]
    around = [
        node
        for node in ast.walk(tree)
        if isinstance(node, (*FUNCTION, ast.ClassDef, ast.Assign, ast.AnnAssign))
        and any(one is wanted for one in ast.walk(node))
    ]
    functions = [node for node in around if isinstance(node, FUNCTION)]
    if functions:
        return _line(functions[-1]), frozenset({functions[-1].name})
    return 0, frozenset().union(
        *(
            {node.name} if isinstance(node, ast.ClassDef) else _defined(node)
            for node in around
            if not isinstance(node, FUNCTION)
        )
    )


def _line(node: ast.FunctionDef | ast.AsyncFunctionDef) -> int:
    return min(one.lineno for one in (node, *node.decorator_list))


def _names(*nodes: ast.AST) -> frozenset[str]:
    return frozenset(
        one.id if isinstance(one, ast.Name) else one.attr
        for node in nodes
        for one in ast.walk(node)
        if isinstance(one, ast.Name | ast.Attribute)
    )


def _defined(node: ast.Assign | ast.AnnAssign) -> frozenset[str]:
    targets = node.targets if isinstance(node, ast.Assign) else [node.target]
    return _names(*targets)
