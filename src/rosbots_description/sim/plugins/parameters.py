"""Typed reading of a plugin's tags, with upstream's defaults and upstream's warnings."""

import re
from collections.abc import Callable
from typing import TypeVar

from ..core import MIN_UPDATE_RATE, Fault, PluginError, Vector, parse_number, report
from ..description import Element

Value = TypeVar('Value', str, float, bool)
Missing = Callable[[str, str | float | bool], str]  # a tag and its default -> a warning
_TAG = re.compile('<([^<>]+)>')
_BOOLEANS = {'true': True, '1': True, 'false': False, '0': False}


class Params:
    """The tags of one plugin element.

    `prefix` begins every message, e.g. 'DiffDrive(ns = //): '. `values` has what `read` returned.
    """

    def __init__(self, element: Element, missing: Missing, level: int) -> None:
        """Read the tags of `element`; `missing` words the message about a missing tag."""
        self.prefix = ''
        self._element, self._missing, self._level = element, missing, level
        self._read: set[str] = set()
        self.values: dict[str, str | float | bool] = {}

    def text(self, tag: str) -> str | None:
        """Return the tag's text without surrounding blanks, or None; reports nothing."""
        self._read.add(tag)
        child = self._element.child(tag)
        return None if child is None else child.text.strip()

    def read(self, tag: str, default: Value, shown: str | None = None) -> Value:
        """Return the tag's value in the type of `default`; a missing tag is a warning.

        Args:
            shown: text of the default in the warning, if it is not the plain value.
        Raises:
            PluginError: a number was expected, and the text is not a finite number.
        """
        text = self.text(tag)
        value = default
        if text is None:
            what = f'{self.prefix}{self._missing(tag, shown or default)}'
            report(Fault(what, self._level))
        elif isinstance(default, bool):
            value = self._boolean(tag, text, default)
        elif isinstance(default, float):
            value = self._number(tag, text)
        else:
            value = text
        self.values[tag] = value
        return value

    def string(self, tag: str) -> str:
        """Return the text that `read` has returned for a tag."""
        return str(self.values[tag])

    def fill(self, template: str) -> str:
        """Return `template` with each `<tag>` replaced by what `read` has returned for that tag."""
        return _TAG.sub(lambda tag: str(self.values[tag[1]]), template)

    def required(self, tag: str) -> str:
        """Return the tag's text.

        Raises:
            PluginError: there is none.
        """
        text = self.values[tag] = self.text(tag) or ''
        if not text:
            raise PluginError(f'{self.prefix}missing <{tag}>, cannot proceed')
        return text

    def vector(self, tag: str) -> Vector:
        """Return a tag's three numbers; zeros if it is missing, with the warning of `read`.

        Raises:
            PluginError: the text is anything else.
        """
        numbers = self.read(tag, '0 0 0').split()
        if len(numbers) != 3:
            raise PluginError(
                f"{self.prefix}<{tag}> is '{' '.join(numbers)}'; it takes three numbers"
            )
        x, y, z = (self._number(tag, number) for number in numbers)
        return (x, y, z)

    def length(self, tag: str, default: float) -> float:
        """Return a length [m], as `read` does.

        Raises:
            PluginError: it is not above zero.
        """
        value = self.read(tag, default)
        if value <= 0.0:
            raise PluginError(f'{self.prefix}<{tag}> is {value:g} m; it must be above 0')
        return value

    def rate(self, tag: str, default: float) -> float:
        """Return a rate [Hz], as `read` does; <= 0 means every step.

        Raises:
            PluginError: it is positive but below MIN_UPDATE_RATE.
        """
        value = self.read(tag, default)
        if 0.0 < value < MIN_UPDATE_RATE:
            raise PluginError(
                f'{self.prefix}<{tag}> is {value:g} Hz; it must be at least '
                f'{MIN_UPDATE_RATE:g}, or 0 for every step'
            )
        return value

    def ignore(self, *tags: str) -> None:
        """Mark `tags` as read: they are known to have no effect here."""
        self._read.update(tags)

    def unread(self) -> list[str]:
        """Return the tags that were not read, in order, each once."""
        return list(dict.fromkeys(c.tag for c in self._element.children if c.tag not in self._read))

    def _boolean(self, tag: str, text: str, default: bool) -> bool:
        value = _BOOLEANS.get(text.lower())
        if value is None:
            what = f"{self.prefix}<{tag}> is '{text}', which is neither true nor false"
            report(Fault(f'{what}; default is {_show(default)}'))
            return default
        return value

    def _number(self, tag: str, text: str) -> float:
        value = parse_number(text)
        if value is None:
            raise PluginError(f"{self.prefix}<{tag}> is '{text}'; it takes a finite number")
        return value


def says_default(tag: str, default: str | float | bool) -> str:
    """Word a warning as diff_drive and tricycle_drive do."""
    return f'missing <{tag}> default is {_show(default)}'


def says_defaults_to(tag: str, default: str | float | bool) -> str:
    """Word a warning as skid_steer_drive and planar_move do."""
    shown = f'"{default}"' if isinstance(default, str) else _show(default)
    if isinstance(default, float):
        shown = f'{default:.6f}'
    return f'missing <{tag}>, defaults to {shown}'


def _show(value: str | float | bool) -> str:
    if isinstance(value, bool):
        return 'true' if value else 'false'
    return f'{value:g}' if isinstance(value, float) else value
