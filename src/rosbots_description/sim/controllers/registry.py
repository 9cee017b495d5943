"""Which class stands for which type of controller."""

from collections.abc import Callable
from typing import NamedTuple

from .controller import Controller

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
    """Return the type of that name, or None."""
    return _TYPES.get(name)


def type_names() -> list[str]:
    """Return the names of all types, sorted."""
    return sorted(_TYPES)
