"""What a model is to have and stands without: shapes that cannot be made, sensors, plugins."""

from collections.abc import Iterable
from itertools import islice

from lxml import etree

from ...core import MAX_NOTES, ModelError, ShapeError, line_of, location, owner, shortened
from ...description import Element
from ...plugin_registry import PAGE, library_remark


class LeftOut:
    """Collects what one description is read without.

    Attributes:
        parts: each in few words, for who spawns the model, e.g. "camera 'front'".
        warnings: sentences about shapes that are as the description has them, but nothing.
    """

    def __init__(self) -> None:
        self.parts: list[str] = []
        self.warnings: list[str] = []
        self._meshes: dict[str, list[str]] = {}  # what is wrong with a file -> who uses it
        self._faults: list[str] = []
        self._sensors: list[str] = []

    def shape(self, element: etree._Element, error: ShapeError) -> None:
        """Take note of a <collision> or <visual> without a shape."""
        if error.uri:
            said = error.uri in str(error)
            written = '' if said else f" (written '{shortened(error.uri)}')"
            users = self._meshes.setdefault(f'{error}{written}', [])
            users.append(f'{element.tag} of {owner(element)} ({line_of(element)})')
            self.parts.append(f"mesh '{shortened(error.uri, 100)}'")
            return
        if len(self.warnings) < MAX_NOTES:
            self.warnings.append(f'{location(element)}: {error}; the {element.tag} is left out')
        self.parts.append(f'{element.tag} of {owner(element)}')

    def part(self, called: str, error: ModelError) -> None:
        """Take note of a part of a model that names what is not there."""
        if len(self._faults) < MAX_NOTES:
            self._faults.append(f'{error}; the model stands without {called}')
        self.parts.append(called)

    def sensor(self, part: Element, element: etree._Element, link: str) -> None:
        """Take note of a <sensor> of a link, with the plugins in it."""
        libraries = [
            child.attributes.get('filename', '').strip() for child in part.children
            if child.tag == 'plugin'
        ]
        kind, name = part.attributes.get('type', part.tag), part.attributes.get('name', '')
        called = shortened(f"{kind} '{name}'", 100)
        within = f' ({", ".join(shortened(library, 60) for library in libraries)})'
        self.parts.append(called + (within if libraries else ''))
        remarks = ''.join(f', {library_remark(library)}' for library in libraries)
        at = f"link '{shortened(link, 60)}' ({line_of(element)})"
        self._sensors.append(f'{called} of {at}{remarks}')

    def errors(self) -> list[str]:
        """Return the sentences about what is not there; one for each mesh, with all who use it."""
        return [
            *self._faults,
            *(f'{reason}; left out: {_listed(users)}'
              for reason, users in islice(self._meshes.items(), MAX_NOTES)),
        ]

    def remarks(self) -> list[str]:
        """Return the sentences to warn with."""
        if not self._sensors:
            return self.warnings
        sensors = _listed(self._sensors, '; ')
        return [*self.warnings,
                f'left out, as no <sensor> is simulated yet: {sensors}; see {PAGE}']


def _listed(items: Iterable[str], separator: str = ', ', most: int = 12) -> str:
    items = list(items)
    more = f' and {len(items) - most} more' if len(items) > most else ''
    return separator.join(items[:most]) + more
