"""Reject Collada files that would make pycollada hang or exhaust the memory.

pycollada trusts its input: it allocates as many corners as a polygon declares, expands every
instance of a node, and lets its XML parser expand entities.
"""

import codecs
import re

import numpy as np
from lxml import etree

from ..core import ModelError, plain_text
from ..resources import check_xml_bounds

MAX_COLLADA_ELEMENTS = 1_000_000
MAX_INSTANCES = 10_000  # of geometries, with all nodes expanded
MAX_CORNERS = 15_000_000  # of all instances together

_XML = re.compile(rb'\s*<\?xml\b[^>]*?(?:encoding\s*=\s*["\']([\w.-]+)["\'][^>]*?)?\?>')


class ColladaError(ModelError):
    """A fault of a file; the message continues after the file's name."""


def safe_collada(content: bytes) -> bytes:
    """Return a Collada file's text in UTF-8, safe to parse.

    Raises:
        ColladaError: it is not text, not XML, or beyond the limits.
    """
    document = _in_utf8(content)
    if not document.startswith(b'<'):
        raise ColladaError('is broken or no .dae file: it does not begin as XML')
    try:
        error = check_xml_bounds(document, 'it', MAX_COLLADA_ELEMENTS)
    except ModelError as refused:
        raise ColladaError(f'is not read: {refused}') from None
    if error is not None:
        raise ColladaError(f'is broken or no .dae file: {error}')
    parser = etree.XMLParser(resolve_entities=False, no_network=True, huge_tree=True)
    root = etree.fromstring(document, parser)
    _refuse_unknown_positions(root, document)
    _refuse_declared_sizes(root, len(document))
    _Nodes(root).refuse_excess()
    return document


def _in_utf8(content: bytes) -> bytes:
    """Return well-formed UTF-8; another encoding could hide a document type."""
    declared = _XML.match(content)
    encoding = (declared[1] or b'utf-8').decode() if declared else 'utf-8'
    if content.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
        encoding = 'utf-16'
    try:
        text = content.decode(encoding).removeprefix('\ufeff')
    except (LookupError, UnicodeDecodeError) as error:
        raise ColladaError(f'is broken or no .dae file: {error}') from None
    return plain_text(text, 'a Collada file').encode(errors='replace').lstrip()


def _refuse_unknown_positions(root: etree._Element, document: bytes) -> None:
    """Reject NaN vertices, which pycollada reads as zero."""
    if not re.search(rb'[\s>]-?nan\b', document, re.IGNORECASE):
        return
    positions = {
        use.get('source', '').removeprefix('#')
        for use in root.iterfind('.//{*}vertices/{*}input')
        if use.get('semantic') == 'POSITION'
    }
    for source in root.iterfind('.//{*}source'):
        numbers = source.findtext('{*}float_array') or ''
        if source.get('id') in positions and 'nan' in numbers.lower():
            raise ColladaError('is broken: a coordinate is no finite number')


def _refuse_declared_sizes(root: etree._Element, size: int) -> None:
    """Reject polygons that declare more corners than a file of `size` bytes can hold.

    Negative indices are rejected too, since pycollada counts them from the end.
    """
    for element in root.iterfind('.//{*}p'):
        if '-' in (element.text or ''):
            raise ColladaError(
                f'is broken: in line {element.sourceline} a triangle names a vertex that does not '
                'exist'
            )
    for element in root.iterfind('.//{*}vcount'):
        counts = np.array((element.text or '').split(), dtype=np.int64)
        if len(counts) and (counts.min() < 0 or counts.max() > size or counts.sum() > size):
            raise ColladaError(
                f'is broken: line {element.sourceline} promises polygons of {counts.max()} '
                'corners, which are not there'
            )


class _Nodes:
    """Counts the geometries of a scene, with instances of nodes expanded."""

    def __init__(self, root: etree._Element) -> None:
        self._scene = root.find('.//{*}library_visual_scenes')
        self._nodes = {node.get('id'): node for node in root.iterfind('.//{*}node')}
        self._corners = {
            geometry.get('id'): sum(len(p.text or '') for p in geometry.iterfind('.//{*}p')) // 2
            for geometry in root.iterfind('.//{*}geometry')
        }
        self._known: dict[etree._Element, tuple[int, int]] = {}
        self._open: set[etree._Element] = set()

    def refuse_excess(self) -> None:
        """Reject a file with too many instances, or nodes that contain each other."""
        instances, corners = (0, 0) if self._scene is None else self._count(self._scene)
        if instances > MAX_INSTANCES or corners > MAX_CORNERS:
            raise ColladaError(
                f'shows {instances} parts with {corners} corners; at most {MAX_INSTANCES} and '
                f'{MAX_CORNERS} are accepted: simplify it'
            )

    def _count(self, element: etree._Element) -> tuple[int, int]:
        """Return the number of geometries below an element, and of their corners."""
        if element in self._known:
            return self._known[element]
        if element in self._open:
            raise ColladaError('is broken: its nodes contain each other in a loop')
        self._open.add(element)
        instances = corners = 0
        for child in element.iterfind('{*}*'):
            url = child.get('url', '').removeprefix('#')
            tag = etree.QName(child).localname
            if tag in ('visual_scene', 'node'):
                found = self._count(child)
            elif tag == 'instance_node' and url in self._nodes:
                found = self._count(self._nodes[url])
            elif tag in ('instance_geometry', 'instance_controller'):
                found = (1, self._corners.get(url, 0))
            else:
                continue
            instances, corners = instances + found[0], corners + found[1]
        self._open.remove(element)
        self._known[element] = (instances, corners)
        return instances, corners
