"""The form of messages: where in a description, what is wrong, and what would be right."""

from collections.abc import Callable, Collection
from difflib import get_close_matches
from itertools import islice
from typing import TYPE_CHECKING
from urllib.parse import quote, unquote

from .errors import ModelError
from .faults import Fault, FaultPlace

if TYPE_CHECKING:
    from lxml import etree

MAX_NOTES = 40  # messages about one description; nobody reads more

_ANY_BYTES = 'surrogateescape'  # for file names that are not UTF-8
_EXPANDED = '#xacro'  # after the source in a tree's URL; a # in the source itself is quoted

# Elements with a name of their own, for messages to mention.
_OWNERS = {
    'link': 'name',
    'joint': 'name',
    'gazebo': 'reference',
    'model': 'name',
    'plugin': 'name',
    'sensor': 'name',
    'material': 'name',
}


def fault(
    element: 'etree._Element', sentence: str, kind: type[ModelError] = ModelError
) -> ModelError:
    """Return the error to raise about `element`: source, line and owner, then the sentence."""
    error = kind(f'{location(element)}: {sentence}')
    error.place = place(element)
    return error


def place(element: 'etree._Element') -> FaultPlace:
    """Return where an element is."""
    model = link = ''
    for ancestor in (element, *element.iterancestors()):
        if ancestor.tag == 'model':
            model = ancestor.get('name', '')
        elif ancestor.tag == 'link':
            link = ancestor.get('name', '')
    return {
        'model': model,
        'link': link,
        'element': owner(element) or f'<{element.tag}>',
        'line': element.sourceline or 0,  # type: ignore[typeddict-item]  # untyped in the stubs
    }


def location(element: 'etree._Element') -> str:
    """Return the location of an element, e.g. "robot_description, line 12: joint 'j1'"."""
    where = f'{source_of(element)}, {line_of(element)}'
    called = owner(element)
    return f'{where}: {called}' if called else where


def owner(element: 'etree._Element') -> str:
    """Return the closest named element, e.g. "link 'base'": this or an ancestor; '' if none."""
    for candidate in (element, *element.iterancestors()):
        name = candidate.get(_OWNERS[candidate.tag]) if candidate.tag in _OWNERS else None
        if name:
            shown = shortened(name, 60)
            if candidate.tag == 'gazebo':
                return f"<gazebo reference='{shown}'>"
            return f"{candidate.tag} '{shown}'"
    return ''


def document_url(source: str, is_expanded_xacro: bool) -> str:
    """Return the base URL of a tree, which `source_of` and `line_of` decode."""
    return quote(source, errors=_ANY_BYTES) + (_EXPANDED if is_expanded_xacro else '')


def source_of(element: 'etree._Element') -> str:
    """Return the source as it was given to `parse_xml`."""
    return _read_url(element)[0]


def line_of(element: 'etree._Element') -> str:
    """Return the line of an element in its source: 'line 12', or 'line 12 of the expanded xacro'.

    The lines of xacro's output differ from those of the file that the user wrote.
    """
    line = f'line {element.sourceline}'
    return f'{line} of the expanded xacro' if _read_url(element)[1] else line


def _read_url(element: 'etree._Element') -> tuple[str, str]:
    """Return the source, and a mark if xacro wrote the document."""
    source, mark, _ = str(element.getroottree().docinfo.URL).partition(_EXPANDED)
    return unquote(source, errors=_ANY_BYTES), mark


def suggestion(name: str, known: Collection[str]) -> str:
    """Return "; did you mean 'x'?" if a known name is close, else the known names, if few."""
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
        text = f'{text[: most // 2]} ... {text[-most // 2 :]}'
    return ' '.join(''.join(c if c.isprintable() else ' ' for c in text).split())


def warning(element: 'etree._Element', sentence: str, cure: str = '') -> Fault:
    """Return a warning about `element`: source, line and owner, then the sentence."""
    return Fault(f'{location(element)}: {sentence}', cure=cure, **place(element))


def warn(notes: list[Fault], element: 'etree._Element', sentence: str, cure: str = '') -> None:
    """Add a warning about `element`, unless there are too many notes already."""
    note(notes, lambda: warning(element, sentence, cure))


def note(notes: list[Fault], made: Callable[[], Fault]) -> None:
    """Add what `made` returns, unless there are too many notes already."""
    if len(notes) < MAX_NOTES:
        notes.append(made())
    elif len(notes) == MAX_NOTES:
        notes.append(Fault('more warnings of this kind are not listed'))
