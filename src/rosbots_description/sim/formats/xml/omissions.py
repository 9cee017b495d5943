"""What a model is to have and stands without: shapes that cannot be made, parts that nobody has."""

import logging
from itertools import islice

from lxml import etree

from ...core import (
    MAX_NOTES,
    Fault,
    FaultPlace,
    ModelError,
    ShapeError,
    line_of,
    owner,
    place,
    shortened,
    warn,
)


class LeftOut:
    """Collects the parts of one description that are left out.

    Attributes:
        parts: each in a few words, to report at the spawn, e.g. "camera 'front'".
        warnings: about shapes that are valid but empty.
    """

    def __init__(self) -> None:
        self.parts: list[str] = []
        self.warnings: list[Fault] = []
        # Fault of a file -> where it is used first, and all elements that use it.
        self._meshes: dict[str, tuple[FaultPlace, list[str]]] = {}
        self._faults: list[Fault] = []

    def shape(self, element: etree._Element, error: ShapeError) -> None:
        """Record a <collision> or <visual> without a shape."""
        if error.uri:
            said = error.uri in str(error)
            written = '' if said else f" (written '{shortened(error.uri)}')"
            _, users = self._meshes.setdefault(f'{error}{written}', (place(element), []))
            users.append(f'{element.tag} of {owner(element)} ({line_of(element)})')
            self.parts.append(f"mesh '{shortened(error.uri, 100)}'")
            return
        warn(self.warnings, element, f'{error}; the {element.tag} is left out')
        self.parts.append(f'{element.tag} of {owner(element)}')

    def part(self, called: str, error: ModelError) -> None:
        """Record a part of a model that refers to something that does not exist."""
        if len(self._faults) < MAX_NOTES:
            self._faults.append(
                Fault(f'{error}; {called} is left out', logging.ERROR, **error.place)
            )
        self.parts.append(called)

    def errors(self) -> list[Fault]:
        """Return the errors about missing parts; one for each mesh, with all its users."""
        return [
            *self._faults,
            *(
                Fault(f'{reason}; left out: {listed(users)}', logging.ERROR, **first)
                for reason, (first, users) in islice(self._meshes.items(), MAX_NOTES)
            ),
        ]


def listed(items: list[str], most: int = 12) -> str:
    """Return the items as a list, cut short where there are many."""
    more = f' and {len(items) - most} more' if len(items) > most else ''
    return ', '.join(items[:most]) + more
