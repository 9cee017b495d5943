"""Parameters as dynamic_reconfigure describes them."""

from collections.abc import Sequence
from types import SimpleNamespace
from typing import NamedTuple

_EVERYTHING = 1  # the level of every parameter, as upstream
_TYPES = {float: 'double', int: 'int', bool: 'bool'}


class Parameter(NamedTuple):
    """A setting as dynamic_reconfigure describes it; its type is that of the default."""

    name: str
    default: float | int | bool
    minimum: float | int | bool
    maximum: float | int | bool
    description: str


def description(parameters: Sequence[Parameter]) -> SimpleNamespace:
    """Return the description as dynamic_reconfigure's generator writes it into a module."""
    return SimpleNamespace(
        defaults={p.name: p.default for p in parameters},
        min={p.name: p.minimum for p in parameters},
        max={p.name: p.maximum for p in parameters},
        config_description={
            'name': 'Default',
            'type': '',
            'id': 0,
            'parent': 0,
            'state': True,
            'groups': [],
            'parameters': [
                {
                    'name': p.name,
                    'type': _TYPES[type(p.default)],
                    'level': _EVERYTHING,
                    'description': p.description,
                    'edit_method': '',
                }
                for p in parameters
            ],
        },
    )
