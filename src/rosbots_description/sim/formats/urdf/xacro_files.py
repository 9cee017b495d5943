"""Expand xacro files with the module `xacro`, if it is installed; ROS is not needed."""

import os
import re
from collections.abc import Callable, Mapping
from functools import partial
from types import ModuleType

from ...core import ModelError
from ...resources import FindPackage
from ...xacro_module import import_xacro

_SUBSTITUTION = re.compile(r'\$\((find|arg|env|optenv|dirname|cwd)\b([^()]*)\)')


def expand_xacro(path: str, arguments: Mapping[str, str], find_package: FindPackage) -> str:
    """Return the URDF that a xacro file expands to.

    Args:
        path: of the file; its includes are searched beside it.
        arguments: values for its <xacro:arg>, by name.
        find_package: see `load_urdf`; for $(find NAME).

    Raises:
        ModelError: xacro is not installed, or rejects the file.
    """
    try:
        xacro = import_xacro()  # an optional dependency
    except ImportError:
        raise ModelError(
            f'{path}: the Python module xacro is missing; install it with "python3 -m pip install '
            'xacro==1.13.3", or expand the file elsewhere'
        ) from None
    resolve = xacro.eval_extension
    vars(xacro)['eval_extension'] = partial(_resolved, xacro, resolve, find_package, path)
    try:
        return str(xacro.process_file(path, mappings=dict(arguments)).toxml())
    except Exception as error:  # whatever an expression in the file raises
        raise ModelError(f'{path}: xacro rejects it: {error}') from error
    finally:
        vars(xacro)['eval_extension'] = resolve


def _resolved(
    xacro: ModuleType,
    others: Callable[[str], object],
    find_package: FindPackage,
    path: str,
    text: str,
) -> object:
    """Return the value of $(KIND VALUE); kinds that need ROS are left to `others`."""
    match = _SUBSTITUTION.fullmatch(text)
    if not match:
        return others(text)
    kind, value = match[1], match[2].strip()
    found: str | None
    if kind == 'find':
        found = find_package(value)
    elif kind == 'arg':
        found = xacro.substitution_args_context['arg'].get(value)
    elif kind == 'env':
        found = os.environ.get(value)
    elif kind == 'optenv':
        name, _, default = value.partition(' ')
        found = os.environ.get(name, default.strip())
    else:
        found = os.path.dirname(os.path.abspath(path)) if kind == 'dirname' else os.getcwd()
    if found is None:
        raise ModelError(f"'{text}' is not a known substitution")
    return found
