"""Expand xacro files with the module `xacro`, if it is installed; ROS is not needed."""

import os
import re
from collections.abc import Callable, Mapping
from contextlib import suppress
from functools import partial
from types import ModuleType

from ...core import Fault, ModelError, printable, report, shortened, suggestion
from ...resources import FindPackage
from ...xacro_module import import_xacro

_SUBSTITUTION = re.compile(r'\$\((find|arg|env|optenv|dirname|cwd)\b([^()]*)\)')


class _Arguments(dict[str, str]):
    """The arguments of a xacro file; `asked` has the names that the file declares or uses."""

    def __init__(self, given: Mapping[str, str]) -> None:
        super().__init__(given)
        self.asked: dict[str, None] = {}

    def __contains__(self, name: object) -> bool:
        """Tell whether it has a value: asked for each <xacro:arg>."""
        self.asked[str(name)] = None
        return super().__contains__(name)

    def __getitem__(self, name: str) -> str:
        """Return a value: asked for each $(arg NAME)."""
        self.asked[name] = None
        return super().__getitem__(name)


def expand_xacro(path: str, arguments: Mapping[str, str], find_package: FindPackage) -> str:
    """Return the URDF that a xacro file expands to.

    An argument that neither the file nor its includes declare or use is a warning in the log.

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
    known = _Arguments({name: str(value) for name, value in arguments.items()})
    try:
        text = str(xacro.process_file(path, mappings=known).toxml())
    except Exception as error:  # whatever an expression in the file raises
        raise ModelError(f'{path}: xacro rejects it: {error}') from error
    finally:
        vars(xacro)['eval_extension'] = resolve
    for name in arguments:
        if name not in known.asked:
            what = f"{path}: there is no xacro argument '{shortened(name)}'"
            report(Fault(printable(what + suggestion(name, known.asked))))
    return text


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
        found = None
        with suppress(KeyError):
            found = xacro.substitution_args_context['arg'][value]
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
