"""Policies: Python functions that command a run by what is recorded."""

import importlib
import importlib.util
import os
import sys
import sysconfig
from collections.abc import Callable, Mapping
from traceback import walk_tb
from typing import Any

from .parameters import Run

_STDLIB = sysconfig.get_path('stdlib')

# Topic -> message, such as {'linear': {'x': 0.5}}.
Commands = Mapping[str, Mapping[str, Mapping[str, float]]]
# Called each period with the time [s] and the newest of each record, None before the first.
Policy = Callable[[float, Mapping[str, Any]], Commands | None]


class PolicyError(Exception):
    """A policy that cannot be loaded, or that raised."""


def load_policy(address: str, folder: str, run: Run) -> Policy:
    """Return the policy of one run: what the function at `address` returns for the run.

    Args:
        address: `module:function`, or `file.py:function` with a path relative to `folder`.
    Raises:
        PolicyError: there is no such function, or it raised.
    """
    place, colon, name = address.rpartition(':')
    if not (colon and place and name):
        raise PolicyError(
            f"'{address}' is not a policy; it takes module:function or file.py:function"
        )
    try:
        if place.endswith('.py'):
            path = os.path.join(folder, place)
            spec = importlib.util.spec_from_file_location('rosbots_policy', path)
            assert spec is not None and spec.loader is not None
            module = importlib.util.module_from_spec(spec)
            sys.modules[spec.name] = module  # where dataclasses look for it
            spec.loader.exec_module(module)
        else:
            module = importlib.import_module(place)
    except Exception as error:  # whatever a user's module raises
        raise PolicyError(f"the policy '{address}' cannot be loaded: {in_words(error)}") from error
    if not callable(getattr(module, name, None)):
        raise PolicyError(
            f"the policy '{address}' cannot be loaded: {place} has no function '{name}'"
        )
    try:
        policy: Policy = getattr(module, name)(run)
    except Exception as error:
        raise PolicyError(f"the policy '{address}' raised {in_words(error)}") from error
    if not callable(policy):
        raise PolicyError(
            f"the policy '{address}' returned {type(policy).__name__}; it returns "
            'a function of time and readings'
        )
    return policy


def commands_of(policy: Policy, address: str, time: float, readings: Mapping[str, Any]) -> Commands:
    """Return the commands of a policy at a time [s].

    Raises:
        PolicyError: it raised, or returned anything else.
    """
    where = f"the policy '{address}' at {time:g} s"
    try:
        commands = policy(time, dict(readings))
    except Exception as error:
        raise PolicyError(f'{where} raised {in_words(error)}') from error
    if not isinstance(commands, Mapping | None):
        raise PolicyError(f'{where} returned {commands!r}; it returns messages by topic')
    return commands or {}


def in_words(error: BaseException) -> str:
    """Return an exception's type and text, and the line of a user's file that raised it, if any."""
    _, *files = ((frame.f_code.co_filename, line) for frame, line in walk_tb(error.__traceback__))
    lines = [
        f' ({os.path.basename(file)}, line {line})'
        for file, line in files
        if not file.startswith(('<', _STDLIB)) and '-packages' not in file
    ]
    return f'{type(error).__name__}: {error}{lines[-1] if lines else ""}'
