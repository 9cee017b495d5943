"""What a model is to have and stands without: shapes that cannot be made, parts that nobody has."""

from itertools import islice

from lxml import etree

from ...core import MAX_NOTES, ModelError, ShapeError, line_of, location, owner, shortened


class LeftOut:
    """Collects the parts of one description that are left out.

    Attributes:
        parts: each in a few words, to report at the spawn, e.g. "camera 'front'".
        warnings: about shapes that are valid but empty.
    """

    def __init__(self) -> None:
        self.parts: list[str] = []
        self.warnings: list[str] = []
        self._meshes: dict[str, list[str]] = {}  # fault of a file -> elements that use it
        self._faults: list[str] = []

    def shape(self, element: etree._Element, error: ShapeError) -> None:
        """Record a <collision> or <visual> without a shape."""
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
        """Record a part of a model that refers to something that does not exist."""
        if len(self._faults) < MAX_NOTES:
            self._faults.append(f'{error}; {called} is left out')
        self.parts.append(called)

    def errors(self) -> list[str]:
        """Return the messages about missing parts; one for each mesh, with all its users."""
        return [
            *self._faults,
            *(
                f'{reason}; left out: {listed(users)}'
                for reason, users in islice(self._meshes.items(), MAX_NOTES)
            ),
        ]


def listed(items: list[str], most: int = 12) -> str:
    """Return the items as a list, cut short where there are many."""
    more = f' and {len(items) - most} more' if len(items) > most else ''
    return ', '.join(items[:most]) + more
