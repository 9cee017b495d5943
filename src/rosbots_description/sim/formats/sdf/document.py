"""A parsed SDF document with its version and folder; and the documents that it includes."""

import os
from collections.abc import Callable
from typing import TypeVar

from lxml import etree

from ...core import Fault, fault, line_of, place
from ...description import Material
from ...resources import (
    MAX_XML_BYTES,
    Addresses,
    description_file,
    parse_xml,
    read_file,
)
from ..ogre import script_material
from ..xml import remove_xacro, scalar, tag_of
from .conversion import FIRST_WITH_ELEMENTS, to_elements
from .omissions import Notes
from .pose_repair import complete_poses

NEWEST = (1, 7)
_UNVERSIONED = (1, 6)
MAX_INCLUDE_DEPTH = 50  # deeper nesting means that files include each other
MAX_INCLUDES = 5000

T = TypeVar('T')


class SdfDocument:
    """A parsed SDF text.

    Attributes:
        root: the <sdf> (or <gazebo>) element.
        version: e.g. (1, 6); the frame of joint axes depends on it.
        notes: what to log about it.
    """

    def __init__(
        self,
        text: str | bytes,
        source: str,
        library: 'SdfLibrary',
        directory: str = '',
        home: str = '',
    ) -> None:
        """Parse a text.

        Args:
            directory: folder of its file, the base of relative addresses; '' if it has none.
            home: the folder that relative addresses must not leave; '' for no such limit.
        Raises:
            ModelError: the text is not XML, or not SDF.
        """
        self.library = library
        self.root = parse_xml(text, source)
        self.notes = Notes(source)
        if self.root.tag not in ('sdf', 'gazebo'):
            raise fault(
                self.root,
                f'the first element is <{tag_of(self.root)}>; an SDF begins with '
                '<sdf version="1.6">',
            )
        for sentence in remove_xacro(self.root):
            self.notes.add(Fault(f'{source}: {sentence}'))
        self._directory = directory
        self._home = home
        self.version = self._read_version()
        if self.version < FIRST_WITH_ELEMENTS:
            to_elements(self.root)
        for pose, sentence in complete_poses(self.root):
            self.notes.add(Fault(f'{source}, {line_of(pose)}: {sentence}', **place(pose)))

    def file(self, element: etree._Element, uri: str) -> str:
        """Return the absolute path of an address in `element`; see `Addresses.path`."""
        return self.library.addresses.path(element, uri, self._directory, self._home)

    def script_material(self, element: etree._Element, name: str) -> Material | None:
        """Return a material of a script that a <material> names; see `ogre.script_material`."""
        return script_material(element, name, self.library.addresses, self._directory, self._home)

    def included(self, element: etree._Element) -> 'SdfDocument':
        """Return the document that an <include> names.

        Raises:
            ModelError: it does not exist or cannot be read.
        """
        uri_element = element.find('uri')
        if uri_element is None or not (uri := scalar(uri_element)):
            raise fault(element, 'an <include> without <uri>; add <uri>model://MODEL</uri>')
        if uri.startswith(('http://', 'https://')):
            raise fault(
                uri_element,
                f"'{uri}': models are not fetched from the network; put the model's folder on "
                'GAZEBO_MODEL_PATH and include model://FOLDER',
            )
        path = self.file(uri_element, uri)
        return self.library.open(description_file(path, uri_element), _home(uri, path))

    def _read_version(self) -> tuple[int, int]:
        text = self.root.get('version', '').strip()
        if not text:
            self.notes.warn(self.root, 'no version="..." is given; SDF 1.6 is assumed')
            return _UNVERSIONED
        parts = text.split('.')
        if not all(part.isdecimal() and len(part) < 10 for part in parts) or len(parts) < 2:
            raise fault(self.root, f'version="{text}" is not valid; write e.g. "1.6"')
        version = (int(parts[0]), int(parts[1]))
        if version > NEWEST:
            self.notes.warn(self.root, f'SDF {text} is newer than 1.7; it is read as SDF 1.7')
        return version


def _home(uri: str, path: str) -> str:
    """Return the folder of the model or package that an address names, found at `path`."""
    if uri.startswith(('model://', 'package://')):
        inner = os.path.normpath(uri.split('://', 1)[1].lstrip('/')).split('/')
        for _ in inner[1:]:
            path = os.path.dirname(path)
    return path if os.path.isdir(path) else os.path.dirname(path)


class SdfLibrary:
    """The documents that are opened while one is read, each file once."""

    def __init__(self, addresses: Addresses) -> None:
        self.addresses = addresses
        self._documents: dict[str, SdfDocument] = {}
        self._reading: list[SdfDocument] = []
        self._included = 0

    def add(
        self, text: str | bytes, source: str, directory: str = '', home: str = ''
    ) -> SdfDocument:
        """Return the document of a text; see `SdfDocument` for `directory` and `home`."""
        document = SdfDocument(text, source, self, directory, home)
        self._documents[source] = document
        return document

    def open(self, path: str, home: str) -> SdfDocument:
        """Return the document of a file, whose relative addresses may not leave `home`.

        Raises:
            ModelError: the file cannot be read, or is not SDF.
        """
        if path not in self._documents:
            self.add(read_file(path, MAX_XML_BYTES), path, os.path.dirname(path), home)
        return self._documents[path]

    def within(self, document: SdfDocument, element: etree._Element, read: Callable[[], T]) -> T:
        """Return `read()`, with `document` marked as being read meanwhile.

        Raises:
            ModelError: it is being read already, as files include each other.
        """
        if document in self._reading or len(self._reading) >= MAX_INCLUDE_DEPTH:
            raise fault(element, 'the included model includes itself')
        self._included += 1
        if self._included > MAX_INCLUDES:
            raise fault(element, f'more than {MAX_INCLUDES} includes are not accepted')
        self._reading.append(document)
        try:
            return read()
        finally:
            self._reading.pop()

    def report(self, model: str = '') -> None:
        """Report the notes about all documents; see `Notes.report`."""
        for document in self._documents.values():
            document.notes.report(model)
