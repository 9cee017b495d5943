"""Blocks of a description that are kept as they were written: elements, and plugins by them."""

from collections.abc import Mapping
from dataclasses import dataclass, field


@dataclass(frozen=True)
class Element:
    """One XML element of a plugin or sensor block, in plain values, with where it was read."""

    tag: str
    text: str = ''
    attributes: Mapping[str, str] = field(default_factory=dict)
    children: tuple['Element', ...] = ()
    line: int = 0

    def child(self, tag: str) -> 'Element | None':
        """Return the first child of that tag, or None."""
        return next((child for child in self.children if child.tag == tag), None)


@dataclass(frozen=True)
class PluginSpec:
    """A plugin as the description asks for it: `filename` picks the code, `element` its tags."""

    name: str
    filename: str
    element: Element
