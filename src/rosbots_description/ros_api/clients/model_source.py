"""The XML of a model: read it, check that it is XML, bring it into the form that is sent."""

from __future__ import annotations

import re
from pathlib import Path
from xml.etree import ElementTree
from xml.parsers import expat

from ...sim.core import plain_text

_MESH_IN_PACKAGE = re.compile(r'(<mesh\b[^<>]*\bfilename\s*=\s*["\'])package://')


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
    """Return the XML as ASCII without declaration and comments, every element in its own line.

    What is said about a line of it is so true of the file, and tags keep the prefix they have.

    Args:
        package_to_model: turn ``package://`` of mesh file names into ``model://``.
    Raises:
        SourceError: the text is not well-formed XML.
    """
    try:
        document = plain_text(text, 'the XML')
        _check(document)
        if '<!DOCTYPE' in document or not (document.isascii() or '<![CDATA[' not in document):
            # Entities stay behind with the document type, and references mean nothing in CDATA.
            document = ElementTree.tostring(ElementTree.fromstring(document)).decode('ascii')
    except (ElementTree.ParseError, expat.ExpatError, ValueError, LookupError) as error:
        # LookupError and ValueError: an encoding that Python does not know.
        raise SourceError(f'Invalid XML: {error}') from error
    if package_to_model:
        document = _MESH_IN_PACKAGE.sub(r'\1model://', document)
    return document.encode('ascii', 'xmlcharrefreplace').decode('ascii')


def _check(document: str) -> None:
    """Raise ExpatError where a text is not well-formed; prefixes need no declaration."""
    expat.ParserCreate('utf-8').Parse(document.encode(), True)
