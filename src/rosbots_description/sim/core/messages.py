"""How a complaint is worded: where in a description, what is wrong, and what would be right."""

from collections.abc import Callable, Collection
from difflib import get_close_matches
from itertools import islice
from typing import TYPE_CHECKING
from urllib.parse import quote, unquote

from .errors import ModelError

if TYPE_CHECKING:
    from lxml import etree

MAX_NOTES = 40  # sentences about one description; who needs more does not read them

_ANY_BYTES = 'surrogateescape'  # in the name of a file that is not UTF-8
_EXPANDED = '#xacro'  # behind the source in a tree's URL; a # of the source itself is quoted there

# Elements with a name of their own, which a message should mention.
_OWNERS = {'link': 'name', 'joint': 'name', 'gazebo': 'reference', 'model': 'name',
           'plugin': 'name', 'sensor': 'name', 'material': 'name'}


def fault(
    element: 'etree._Element', sentence: str, kind: type[ModelError] = ModelError
) -> ModelError:
    """Return the error to raise about `element`: source, line and owner before the sentence."""
    return kind(f'{location(element)}: {sentence}')


def location(element: 'etree._Element') -> str:
    """Return where an element stands, e.g. "robot_description, line 12: joint 'j1'"."""
    where = f'{source_of(element)}, {line_of(element)}'
    called = owner(element)
    return f'{where}: {called}' if called else where


def owner(element: 'etree._Element') -> str:
    """Return what an element belongs to or is, e.g. "link 'base'"; '' where nothing has a name."""
    for candidate in (element, *element.iterancestors()):
        name = candidate.get(_OWNERS[candidate.tag]) if candidate.tag in _OWNERS else None
        if name:
            shown = shortened(name, 60)
            if candidate.tag == 'gazebo':
                return f"<gazebo reference='{shown}'>"
            return f"{candidate.tag} '{shown}'"
    return ''


def document_url(source: str, is_expanded_xacro: bool) -> str:
    """Return the base URL of a tree, from which `source_of` and `line_of` read it again."""
    return quote(source, errors=_ANY_BYTES) + (_EXPANDED if is_expanded_xacro else '')


def source_of(element: 'etree._Element') -> str:
    """Return the source that was given to `parse_xml`, as it was written."""
    return _read_url(element)[0]


def line_of(element: 'etree._Element') -> str:
    """Return where an element stands in its source: 'line 12', or 'line 12 of the expanded xacro'.

    What xacro wrote has other lines than the file that its user did.
    """
    line = f'line {element.sourceline}'
    return f'{line} of the expanded xacro' if _read_url(element)[1] else line


def _read_url(element: 'etree._Element') -> tuple[str, str]:
    """Return the source and, where xacro wrote the document, a mark."""
    source, mark, _ = str(element.getroottree().docinfo.URL).partition(_EXPANDED)
    return unquote(source, errors=_ANY_BYTES), mark


def suggestion(name: str, known: Collection[str]) -> str:
    """Return "; did you mean 'x'?" where a known name is close, else the known ones, if few."""
    near = [other for other in islice(known, 1000) if abs(len(other) - len(name)) < 10]
    close = get_close_matches(name, near, n=1) if len(name) <= 100 else []
    if close:
        return f"; did you mean '{close[0]}'?"
    if 0 < len(known) <= 8:
        return '; there are ' + ', '.join(f"'{other}'" for other in known)
    return ''


def shortened(text: str, most: int = 600) -> str:
    """Return a text as one line of at most about `most` characters, for a message."""
    if len(text) > most:
        text = f'{text[:most // 2]} ... {text[-most // 2:]}'
    return ' '.join(''.join(c if c.isprintable() else ' ' for c in text).split())


def note(notes: list[str], sentence: Callable[[], str]) -> None:
    """Add what `sentence` returns, unless so much has been noted already that no one reads it."""
    if len(notes) < MAX_NOTES:
        notes.append(sentence())
    elif len(notes) == MAX_NOTES:
        notes.append('there is more of that kind, which is not listed')
