"""Conditions: expressions over the columns of a row, which must hold for a run to pass."""

import ast
import math
from collections.abc import Collection, Mapping

from simpleeval import DEFAULT_OPERATORS, SimpleEval

_FUNCTIONS = {
    'abs': abs,
    'min': min,
    'max': max,
    'sqrt': math.sqrt,
    'hypot': math.hypot,
    'sin': math.sin,
    'cos': math.cos,
    'atan2': math.atan2,
}
_CONSTANTS = {'pi': math.pi}
MAX_LENGTH = 1000  # [characters]


def _remainder(value: float, divisor: float) -> float:
    return float(value) % float(divisor)  # never the formatting of a text


# What could take hours or gigabytes: powers of integers, shifts, texts with widths, methods.
_OPERATORS = {
    kind: function
    for kind, function in DEFAULT_OPERATORS.items()
    if kind not in (ast.LShift, ast.RShift)
} | {ast.Pow: math.pow, ast.Mod: _remainder}
_EXCLUDED = ast.Attribute, ast.JoinedStr, ast.FormattedValue, ast.Subscript


class Condition:
    """One condition, such as `hypot(x_end - goal_x, y_end) < 0.2 and nearest_min > 0.1`."""

    def __init__(self, text: str, known: Collection[str]) -> None:
        """Take an expression in Python's syntax over the names `known`.

        Raises:
            ValueError: it is not such an expression.
        """
        self.text = text
        if len(text) > MAX_LENGTH:
            raise ValueError(
                f"the condition '{text[:40]}...' has {len(text)} characters; at most "
                f'{MAX_LENGTH} are accepted'
            )
        self._eval = SimpleEval(_OPERATORS, _FUNCTIONS, {})
        for kind in _EXCLUDED:
            self._eval.nodes.pop(kind, None)
        try:
            self._parsed = ast.parse(text.strip(), mode='eval').body
        except (SyntaxError, ValueError, RecursionError, MemoryError) as error:
            raise ValueError(
                f"the condition '{text}' is not an expression: {getattr(error, 'msg', error)}"
            ) from None
        nodes = [node for node in ast.walk(self._parsed) if isinstance(node, ast.Name)]
        names = [node.id for node in sorted(nodes, key=lambda node: node.col_offset)]
        self._names = [name for name in dict.fromkeys(names) if name not in _FUNCTIONS]
        unknown = [name for name in self._names if name not in {*known, *_CONSTANTS}]
        if unknown:
            raise ValueError(
                f"the condition '{text}' has '{unknown[0]}', which is neither "
                f'recorded nor a parameter; there are: {", ".join(known) or "none"}'
            )

    def fault(self, row: Mapping[str, object]) -> str:
        """Return why the condition does not hold for a row; '' if it does.

        Raises:
            ValueError: it cannot be computed.
        """
        absent = [name for name in self._names if row.get(name, 0.0) is None]
        if absent:
            return f"'{self.text}' does not hold: nothing was recorded for {absent[0]}"
        self._eval.names = {**_CONSTANTS, **row}
        try:
            holds = self._eval.eval(self.text, previously_parsed=self._parsed)
        except Exception as error:  # whatever the expression raises
            raise ValueError(f"the condition '{self.text}' cannot be computed: {error}") from None
        if holds:
            return ''
        values = ', '.join(f'{name} = {_shown(row[name])}' for name in self._names if name in row)
        return f"'{self.text}' does not hold" + (f': {values}' if values else '')


def _shown(value: object) -> str:
    return f'{value:.6g}' if isinstance(value, float) else repr(value)
