"""The executable xacro: PyPI's xacro 1.13 with the features of Noetic's 1.14 that robots need.

Noetic's version is on no package index. The ROS 2 version supports neither rospack nor tags without
`xacro:`, as in older robots. Version 1.13 alone cannot read YAML files with current PyYAML.
"""

from __future__ import annotations

import io
import math
import os
import sys
from collections.abc import Callable
from functools import partial
from types import ModuleType, SimpleNamespace
from xml.dom.minidom import Element

import yaml

from ..sim.xacro_module import import_xacro
from .program import fail

_PYTHON = {'bool': bool, 'len': len, 'range': range, 'sorted': sorted}
# in rad and m
_UNITS = {
    '!radians': 1.0,
    '!degrees': math.pi / 180.0,
    '!meters': 1.0,
    '!millimeters': 1e-3,
    '!foot': 0.3048,
    '!inches': 0.0254,
}


def main() -> int:
    """Expand the file given on the command line; return the exit code."""
    # Remove folders with a script xacro.py from the path: it would hide the module.
    sys.path[:] = [p for p in sys.path if not os.path.isfile(os.path.join(p or '.', 'xacro.py'))]
    try:
        xacro = import_xacro()  # after the path is cleaned
    except ImportError:
        return fail(
            'xacro',
            f'the Python module xacro is missing for {sys.executable}; install '
            'it with "python3 -m pip install xacro==1.13.3".',
        )
    if isinstance(sys.stdout, io.TextIOWrapper):
        sys.stdout.reconfigure(encoding='utf-8')  # the encoding of XML, despite PYTHONIOENCODING
    extend(xacro)
    xacro.main()
    return 0


def extend(xacro: ModuleType) -> None:
    """Add Noetic's expressions and includes to the module, in place."""
    for unit, factor in _UNITS.items():
        _Loader.add_constructor(unit, partial(_scaled, xacro, factor))
    load_yaml = partial(_load_yaml, xacro)
    symbols = xacro.global_symbols
    symbols['__builtins__'].update(_PYTHON)
    symbols.update(
        load_yaml=load_yaml,
        math=math,
        python=SimpleNamespace(**symbols['__builtins__']),
        xacro=SimpleNamespace(
            load_yaml=load_yaml,
            abs_filename=xacro.abs_filename_spec,
            arg=lambda name: xacro.substitution_args_context['arg'][name],
            dotify=_Dotted,
        ),
    )
    vars(xacro)['process_include'] = partial(_include, xacro, xacro.process_include)


def _scaled(xacro: ModuleType, factor: float, loader: yaml.Loader, node: yaml.Node) -> float:
    return factor * float(eval(loader.construct_scalar(node), xacro.global_symbols))


class _Dotted(dict[str, object]):
    """A mapping with attribute access: robot.wheel.radius."""

    def __getattr__(self, name: str) -> object:
        try:
            return self[name]
        except KeyError:
            raise AttributeError(f"there is no '{name}' in the YAML at this place") from None


def _dotted(value: object) -> object:
    if isinstance(value, dict):
        return _Dotted({key: _dotted(inner) for key, inner in value.items()})
    if isinstance(value, list):
        return [_dotted(inner) for inner in value]
    return value


class _Loader(yaml.SafeLoader):  # type: ignore[misc]  # yaml has no types
    """A YAML loader that supports units: !degrees 90."""


def _load_yaml(xacro: ModuleType, name: str) -> object:
    """Return the contents of a YAML file; a relative name starts at the current file's folder."""
    path = xacro.abs_filename_spec(name)
    files = xacro.push_file(path)
    try:
        with open(path, encoding='utf-8') as file:
            return _dotted(yaml.load(file, _Loader))  # it is a SafeLoader
    finally:
        xacro.restore_filestack(files)
        xacro.all_includes.append(path)


def _include(
    xacro: ModuleType,
    include: Callable[..., None],
    element: Element,
    macros: object,
    symbols: object,
    func: object,
) -> None:
    """Include a file, or nothing if it is `optional` and missing."""
    optional = element.getAttribute('optional')
    if optional:
        element.removeAttribute('optional')
        path = xacro.abs_filename_spec(xacro.eval_text(element.getAttribute('filename'), symbols))
        if xacro.get_boolean_value(
            xacro.eval_text(optional, symbols), optional
        ) and not os.path.exists(path):
            xacro.remove_previous_comments(element)
            xacro.replace_node(element, by=[])
            return
    include(element, macros, symbols, func)
