"""The XML of a model: read it, check that it is XML, write it out in the form that is sent."""

from __future__ import annotations

from pathlib import Path
from xml.etree import ElementTree


class SourceError(Exception):
    """The XML cannot be had; the text is a sentence for the user."""


class MissingFileError(SourceError):
    """The named file does not exist or is not a file."""


def read_file(name: str) -> bytes:
    """Return the contents of a file.

    Raises:
        MissingFileError: there is no such file.
        SourceError: it is unreadable or empty.
    """
    path = Path(name)
    if not path.exists():
        raise MissingFileError(f'Error: specified file {name} does not exist')
    if not path.is_file():
        raise MissingFileError(f'Error: specified file {name} is not a file')
    try:
        text = path.read_bytes()
    except OSError as error:
        raise SourceError(f'Error reading file {name}: {error.strerror}') from error
    if not text.strip():
        raise SourceError(f'Error: file {name} is empty')
    return text


def canonical_xml(text: bytes | str, package_to_model: bool = False) -> str:
    """Return the XML as ASCII without declaration and comments.

    Args:
        package_to_model: turn ``package://`` of mesh file names into ``model://``.
    Raises:
        SourceError: the text is not well-formed XML.
    """
    try:
        root = ElementTree.fromstring(text)
    except (ElementTree.ParseError, ValueError, LookupError) as error:
        # LookupError and ValueError: an encoding that Python does not know.
        raise SourceError(f'Invalid XML: {error}') from error
    if package_to_model:
        for mesh in root.iter('mesh'):
            name = mesh.get('filename', '')
            if name.startswith('package://'):
                mesh.set('filename', 'model://' + name.removeprefix('package://'))
    return ElementTree.tostring(root).decode('ascii')
