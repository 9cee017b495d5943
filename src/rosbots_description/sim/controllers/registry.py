"""Which class stands for which type of controller.

A type that is not known is looked for in the Python package of its name: `my_robot/Wave` is what
the module `my_robot.controllers` registers as that.
"""

import sys
from collections.abc import Callable
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import NamedTuple

from .controller import Controller
from .errors import ControllerError

_MODULE = 'controllers'
# Of the package that this module is in: in Python, and in a server of ROS.
_OWN_NAMES = 'rosbots_description', 'rosbots_simulator'

BASE_CLASS = 'controller_interface::ControllerBase'


class ControllerType(NamedTuple):
    """A class of controllers, and the hardware interface that it works on."""

    made_by: type[Controller]
    interface: str


_TYPES: dict[str, ControllerType] = {}


def register_controller(
    name: str, interface: str
) -> Callable[[type[Controller]], type[Controller]]:
    """Return a class decorator that makes a controller loadable.

    Args:
        name: the type, e.g. 'position_controllers/JointPositionController'.
        interface: e.g. 'hardware_interface::PositionJointInterface'.
    """

    def add(cls: type[Controller]) -> type[Controller]:
        if name in _TYPES:
            raise ValueError(f'{name} is already registered by {_TYPES[name].made_by.__name__}')
        _TYPES[name] = ControllerType(cls, interface)
        return cls

    return add


def find_type(name: str) -> ControllerType | None:
    """Return the type of that name, or None; the module of its package is imported for it.

    Raises:
        ControllerError: the module cannot be imported.
    """
    package = name.partition('/')[0]
    if name not in _TYPES and _has_controllers(package):
        _share_names()
        try:
            import_module(f'{package}.{_MODULE}')
        except Exception as error:
            raise ControllerError(
                f"Could not load class '{name}': {type(error).__name__} in "
                f'{package}.{_MODULE}: {error}'
            ) from error
    return _TYPES.get(name)


def _share_names() -> None:
    """Make this room one and the same module under both names of its package.

    A module that imports it by the other name would register in a copy of it.
    """
    own = __name__.rpartition('.')[0]
    room = own.partition('.')[2]
    for name in _OWN_NAMES:
        sys.modules.setdefault(f'{name}.{room}', sys.modules[own])


def _has_controllers(package: str) -> bool:
    """Tell whether a package has such a module, without importing anything."""
    if not package.isidentifier():
        return False
    try:
        spec = find_spec(package)
    except (ImportError, ValueError):
        return False
    places = spec.submodule_search_locations if spec is not None else None
    return any(
        file.is_file()
        for place in places or ()
        for file in (Path(place, f'{_MODULE}.py'), Path(place, _MODULE, '__init__.py'))
    )


def type_names() -> list[str]:
    """Return the names of all types, sorted."""
    return sorted(_TYPES)
