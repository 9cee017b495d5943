"""Parameters of a scenario: their values in each run, and where these stand in it."""

import math
import re
from collections.abc import Callable, Mapping, Sequence
from string import Template
from typing import Any, NamedTuple, TypeGuard
from zlib import crc32

import numpy as np

Value = bool | int | float | str

MAX_RUNS = 10_000_000
_MAX_INT = 2**63  # of a column
_WHOLE = re.compile(r'\$(?:(\w+)|\{(\w+)\})')
# Distributions: methods of NumPy's Generator, with their arguments in that order.
_DISTRIBUTIONS = {
    'uniform': 'low, high',
    'normal': 'mean, standard deviation',
    'exponential': 'scale',
    'integers': 'low, high (excluded)',
    'lognormal': 'mean, sigma',
    'triangular': 'left, mode, right',
}


class Run(NamedTuple):
    """One run: its number, its values of the parameters, and the seed of all that is random."""

    number: int
    parameters: Mapping[str, Value]
    seed: int


class Parameters:
    """The values of the parameters in each run.

    A parameter is a value, `{grid: […]}`, `{list: […]}`, `{choice: […]}` or a distribution, as
    `{uniform: [0, 1]}`. There is a run for each combination of the grids and each index of the
    lists, which are of equal length, `repeat` times. Random values depend on seed, number of the
    run and name of the parameter only.
    """

    def __init__(self, content: Mapping[str, Any], seed: int = 0, repeat: int = 1) -> None:
        """Take the parameters by name.

        Raises:
            ValueError: they are not valid; the message says why.
        """
        if not isinstance(content, Mapping):
            raise ValueError(f'parameters takes a mapping from names to values, not {content!r}')
        for what, number, least in (('seed', seed, 0), ('repeat', repeat, 1)):
            if not isinstance(number, int) or isinstance(number, bool) or number < least:
                raise ValueError(
                    f'{what} is {number!r}; it takes a whole number of at least {least}'
                )
        self.seed, self.content = seed, (dict(content), seed, repeat)
        self.names = list(content)
        self._grids: dict[str, list[Value]] = {}
        self._lists: dict[str, list[Value]] = {}
        self._drawn: dict[str, Callable[[np.random.Generator], Value]] = {}
        self._fixed: dict[str, Value] = {}
        self._types: dict[str, set[type]] = {}
        for name, spec in content.items():
            if not (isinstance(name, str) and name.isidentifier()):
                raise ValueError(
                    f'{name!r} cannot be the name of a parameter; use letters, digits and _'
                )
            self._add(name, spec)
        lengths = {len(values) for values in self._lists.values()}
        if len(lengths) > 1:
            raise ValueError(
                'lists of parameters are of equal length; these are not: ' + ', '.join(self._lists)
            )
        # The last index changes first: repetition, then place in the lists, then in the grids.
        self._shape = (*map(len, self._grids.values()), max(lengths, default=1), repeat)
        self.runs = math.prod(self._shape)
        if self.runs > MAX_RUNS:
            raise ValueError(f'the parameters make {self.runs} runs; at most {MAX_RUNS} are made')

    def _add(self, name: str, spec: object) -> None:
        if _is_value(spec):
            self._fixed[name], self._types[name] = spec, {type(spec)}
            return
        kinds = ', '.join(('grid', 'list', 'choice', *_DISTRIBUTIONS))
        if not (isinstance(spec, Mapping) and len(spec) == 1):
            raise ValueError(
                f"the parameter '{name}' takes a number, a text, true, false, or one "
                f'of these with its values: {kinds}'
            )
        ((kind, values),) = spec.items()
        if not (isinstance(values, list | tuple) and values and all(map(_is_value, values))):
            raise ValueError(
                f"{kind} of the parameter '{name}' takes a list of values; they are "
                'finite numbers, texts, true or false'
            )
        self._types[name] = set(map(type, values))
        if kind == 'grid':
            self._grids[name] = list(values)
        elif kind == 'list':
            self._lists[name] = list(values)
        elif kind == 'choice':
            self._drawn[name] = lambda random: values[random.integers(len(values))]
        elif kind in _DISTRIBUTIONS:
            self._types[name] = {int if kind == 'integers' else float}
            self._drawn[name] = _distribution(name, kind, values)
        else:
            raise ValueError(f"the parameter '{name}' is of the kind '{kind}'; there are: {kinds}")

    def run(self, number: int) -> Run:
        """Return the run of that number, from 0."""
        *places, index, _ = map(int, np.unravel_index(number, self._shape))
        values = dict(self._fixed)
        for (name, grid), place in zip(self._grids.items(), places, strict=True):
            values[name] = grid[place]
        for name, listed in self._lists.items():
            values[name] = listed[index]
        for name, draw in self._drawn.items():
            values[name] = draw(np.random.default_rng([self.seed, number, crc32(name.encode())]))
        seed = int(np.random.SeedSequence([self.seed, number]).generate_state(1)[0])
        return Run(number, {name: values[name] for name in self.names}, seed)

    def type_of(self, name: str) -> type:
        """Return the one type of all values of a parameter: bool, int, float or str."""
        kinds = self._types[name]
        if kinds == {int, float}:
            return float
        return next(iter(kinds)) if len(kinds) == 1 else str


def _is_value(value: object) -> TypeGuard[Value]:
    if isinstance(value, int):
        return abs(value) < _MAX_INT
    return isinstance(value, str) or (isinstance(value, float) and math.isfinite(value))


def _distribution(
    name: str, kind: str, values: Sequence[Any]
) -> Callable[[np.random.Generator], Value]:
    def draw(random: np.random.Generator) -> Value:
        drawn = getattr(random, kind)(*values)
        return int(drawn) if kind == 'integers' else float(drawn)

    try:
        draw(np.random.default_rng(0))
    except (TypeError, ValueError, OverflowError, MemoryError) as error:
        raise ValueError(
            f"{kind} of the parameter '{name}' takes {_DISTRIBUTIONS[kind]}: {error}"
        ) from None
    return draw


def substitute(content: object, values: Mapping[str, Value]) -> object:
    """Return a copy with `$name` or `${name}` replaced in all texts; `$$` is a dollar sign.

    A text that is nothing else becomes the value itself, with its type.

    Raises:
        ValueError: a name is not that of a parameter.
    """
    if isinstance(content, Mapping):
        return {key: substitute(value, values) for key, value in content.items()}
    if isinstance(content, list):
        return [substitute(value, values) for value in content]
    if not isinstance(content, str) or '$' not in content:
        return content
    whole = _WHOLE.fullmatch(content)
    try:
        return values[whole[1] or whole[2]] if whole else Template(content).substitute(values)
    except KeyError as error:
        known = ', '.join(values) or 'none'
        raise ValueError(
            f'there is no parameter {error}; the parameters: {known}. $$ stands for a dollar sign'
        ) from None
    except ValueError:
        raise ValueError(
            f'{content[:60]!r} has a $ without the name of a parameter; $$ stands for a dollar sign'
        ) from None
