"""Reads the XML of a model, checks that it is well-formed, and normalises it for sending."""

from __future__ import annotations

import os
import re
from pathlib import Path
from xml.etree import ElementTree
from xml.parsers import expat

from ...sim.core import plain_text

_MESH_IN_PACKAGE = re.compile(r'(<mesh\b[^<>]*\bfilename\s*=\s*["\'])package://')


class SourceError(Exception):
    """The XML cannot be read; the message is for the user."""


class MissingFileError(SourceError):
    """The named file does not exist or is not a file."""


def read_file(name: str) -> bytes:
    """Return the contents of a file.

    Raises:
        MissingFileError: there is no such file.
        SourceError: the file is unreadable or empty.
    """
    path = Path(name)
    if not os.path.exists(path):  # False also for names that no file can have
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
    """Return the XML as ASCII without declaration and comments, with each element on its line.

    So line numbers in messages are those of the file. Tags keep their prefixes.

    Args:
        package_to_model: turn ``package://`` of mesh file names into ``model://``.
    Raises:
        SourceError: the text is not well-formed XML.
    """
    try:
        document = plain_text(text, 'the XML')
        _check(document)
        if '<!DOCTYPE' in document or not (document.isascii() or '<![CDATA[' not in document):
            # Entities need the document type, and CDATA cannot hold character references.
            document = ElementTree.tostring(ElementTree.fromstring(document)).decode('ascii')
    except (ElementTree.ParseError, expat.ExpatError, ValueError, LookupError) as error:
        # LookupError and ValueError: an encoding unknown to Python.
        raise SourceError(f'Invalid XML: {error}') from error
    if package_to_model:
        document = _MESH_IN_PACKAGE.sub(r'\1model://', document)
    return document.encode('ascii', 'xmlcharrefreplace').decode('ascii')


def _check(document: str) -> None:
    """Raise ExpatError if a text is not well-formed; prefixes need no declaration."""
    expat.ParserCreate('utf-8').Parse(document.encode(), True)
