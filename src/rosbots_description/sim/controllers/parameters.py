"""Typed reading of a controller's parameters, as roscpp reads the parameter server."""

import math
import re
from collections.abc import Mapping
from typing import TypeVar

Value = TypeVar('Value', bool, float, str)
_TAG = re.compile('<([^<>]+)>')


class ControllerParameters:
    """The parameters in one namespace, nested as in YAML; a value of a wrong type counts as absent.

    `values` has what `read` returned, by path.
    """

    def __init__(self, given: Mapping[str, object], namespace: str = '') -> None:
        self._given = given
        self.namespace = namespace  # for messages
        self.values: dict[str, bool | float | str] = {}

    def find(self, path: str) -> object | None:
        """Return what is stored under a path such as 'constraints/goal_time'; None if nothing."""
        found: object = self._given
        for key in path.split('/'):
            if not isinstance(found, Mapping) or key not in found:
                return None
            found = found[key]
        return found

    def read(self, path: str, default: Value) -> Value:
        """Return the value in the type of `default`, or `default`."""
        found = self.find(path)
        if isinstance(default, float):
            found = _number(found)
        value = found if isinstance(found, type(default)) else default
        self.values[path] = value
        return value

    def number(self, path: str) -> float | None:
        """Return a finite number; None if there is none."""
        return _number(self.find(path))

    def string(self, path: str) -> str | None:
        """Return a text; None if there is none."""
        found = self.find(path)
        return found if isinstance(found, str) else None

    def strings(self, path: str) -> list[str] | None:
        """Return a list of texts; None if there is none."""
        found = self.find(path)
        if isinstance(found, list | tuple) and all(isinstance(one, str) for one in found):
            return list(found)
        return None

    def section(self, path: str) -> 'ControllerParameters':
        """Return the parameters below a path; none if it has none."""
        found = self.find(path)
        return ControllerParameters(
            found if isinstance(found, Mapping) else {}, f'{self.namespace}/{path}'
        )

    def fill(self, template: str) -> str:
        """Return `template` with each `<path>` replaced by what `read` has returned for it."""
        return _TAG.sub(lambda tag: str(self.values[tag[1]]), template)


def _number(found: object) -> float | None:
    if isinstance(found, bool) or not isinstance(found, int | float):
        return None
    try:
        number = float(found)
    except OverflowError:
        return None
    return number if math.isfinite(number) else None
