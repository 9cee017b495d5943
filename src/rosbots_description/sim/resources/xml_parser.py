"""Parse XML safely: bounded, no DTD, no network; errors name file and line.

The result is an lxml tree without comments and processing instructions.
"""

import contextlib
import re
from xml.parsers import expat

from lxml import etree

from ..core import (
    ModelError,
    SimError,
    document_url,
    is_expanded_xacro,
    plain_text,
    shortened,
)

MAX_XML_BYTES = 10_000_000
MAX_XML_DEPTH = 200
MAX_XML_ELEMENTS = 100_000
MAX_XML_ATTRIBUTES = 200  # of one element; libxml2 compares all pairs

_UNDEFINED_PREFIX = etree.ErrorTypes.NS_ERR_UNDEFINED_NAMESPACE
_MAX_LINE = 65535  # libxml2 cannot store greater line numbers; it then reports where the tag ends


def parse_xml(text: str | bytes, source: str) -> etree._Element:
    """Return the root element of a document.

    Every element knows the line where its tag begins (`sourceline`) and its `source` (see
    `source_of`), a file or parameter name that begins every message.

    Raises:
        ModelError: the text is empty, too big, too deeply nested, of unknown encoding, not
            well-formed XML, or has a DTD (and so perhaps exponential entities).
    """
    document = _decode(text, source)
    lines: list[int] = []
    fault = check_xml_bounds(document, source, lines=lines)
    if fault is not None:
        raise ModelError(_syntax_sentence(document, source, fault))
    root = _parse_document(document, source)
    for element, line in zip(root.iter(etree.Element), lines, strict=False):
        if line < _MAX_LINE:
            element.sourceline = line  # type: ignore[assignment]  # untyped in the stubs
    if b'xmlns=' in document:
        _drop_default_namespace(root)
    return root


def root_tag(text: str | bytes) -> str | None:
    """Return the name of the first element, or None if the text does not begin as XML.

    It reads no further, so a document that is broken or too big later on still has a root.
    """
    tags: list[str] = []

    def found(tag: str, *_: object) -> None:
        tags.append(tag)
        raise _Found

    parser = expat.ParserCreate('utf-8')
    parser.StartElementHandler = found
    parser.StartDoctypeDeclHandler = found  # it names the first element; entities are not read
    with contextlib.suppress(_Found, expat.ExpatError, LookupError, UnicodeDecodeError):
        text = plain_text(text[:MAX_XML_BYTES], 'the text')
        parser.Parse(text.lstrip().encode(errors='replace'), True)
    return tags[0] if tags else None


def text_of_upload(name: str, content: bytes, kinds: str) -> str:
    """Return the text of a file that a browser has sent.

    Args:
        name: of the file, for messages.
        kinds: what may be sent, for messages: "URDF or SDF".
    Raises:
        SimError: it is too large, or not text.
    """
    if len(content) > MAX_XML_BYTES:
        raise SimError(f"'{name}' has {len(content)} bytes; {MAX_XML_BYTES} are accepted")
    try:
        return plain_text(content, name)
    except (LookupError, UnicodeDecodeError):
        raise SimError(f"'{name}' is not text; upload a {kinds}") from None


def own_name(text: str | bytes, source: str) -> str:
    """Return the name that a URDF or SDF gives its model or light.

    Raises:
        ModelError: it gives none, or is not XML.
    """
    root = parse_xml(text, source)
    element = root if root.tag == 'robot' else root.find('.//model')
    if element is None:
        element = root.find('.//light')
    name = '' if element is None else element.get('name', '')
    if not name:
        raise ModelError(f'{source}: it gives the model no name; give one with name=')
    return name


class _Found(Exception):  # noqa: N818 (it ends a search)
    pass


def check_xml_bounds(
    document: bytes,
    source: str,
    max_elements: int | None = None,
    lines: list[int] | None = None,
) -> expat.ExpatError | None:
    """Scan a possibly malicious document once, before a tree is built from it.

    libxml2 needs hours for an element with very many attributes, and gigabytes for nested entities.
    This parser needs neither, and stops at the first limit that is exceeded.

    Args:
        document: UTF-8; an XML declaration does not count.
        max_elements: instead of MAX_XML_ELEMENTS.
        lines: takes the line where each element's tag begins, in document order.
    Returns:
        The fault if the document is not well-formed; nothing after it is read.
    Raises:
        ModelError: it has a document type, is nested too deep, or has too many elements or
            attributes.
    """
    most = MAX_XML_ELEMENTS if max_elements is None else max_elements
    depth = count = 0
    parser = expat.ParserCreate('utf-8')
    parser.ordered_attributes = True  # a list of alternating names and values

    def start(tag: str, attributes: list[str]) -> None:
        nonlocal depth, count
        depth, count = depth + 1, count + 1
        if lines is not None:
            lines.append(parser.CurrentLineNumber)
        if depth > MAX_XML_DEPTH:
            raise ModelError(_depth_sentence(source, parser.CurrentLineNumber))
        if count > most:
            raise ModelError(f'{source}: more than {most} elements are not accepted')
        if len(attributes) > 2 * MAX_XML_ATTRIBUTES:
            raise ModelError(
                f'{source}, line {parser.CurrentLineNumber}: <{tag[:60]}> has '
                f'{len(attributes) // 2} attributes; at most {MAX_XML_ATTRIBUTES} are accepted'
            )

    def end(_: str) -> None:
        nonlocal depth
        depth -= 1

    def refuse_type(*_: object) -> None:
        raise ModelError(f'{source}: a document type (<!DOCTYPE>) is not accepted; remove it')

    parser.StartElementHandler, parser.EndElementHandler = start, end
    parser.StartDoctypeDeclHandler = refuse_type
    return _run(parser, document)


def _run(parser: expat.XMLParserType, document: bytes) -> expat.ExpatError | None:
    try:
        parser.Parse(document, True)
    except expat.ExpatError as error:
        error.offset = parser.ErrorByteIndex
        return error
    return None


def _decode(text: str | bytes, source: str) -> bytes:
    """Return the document as UTF-8 without declaration and comments, with its line breaks."""
    if len(text) > MAX_XML_BYTES:
        raise _too_big(len(text), source)
    try:
        text = plain_text(text, source)
    except LookupError as error:
        raise ModelError(f'{source}, line 1: {error}; save the file in UTF-8') from error
    except UnicodeDecodeError as error:
        line = error.object.count(b'\n', 0, error.start) + 1
        raise ModelError(
            f'{source}, line {line}: byte 0x{error.object[error.start]:02x} is not UTF-8; '
            'save the file in UTF-8'
        ) from error
    if not text.strip():
        raise ModelError(f'{source}: the text is empty; a <robot> or <sdf> element was expected')
    try:
        document = text.encode()
    except UnicodeEncodeError as error:
        line = text.count('\n', 0, error.start) + 1
        raise ModelError(
            f'{source}, line {line}: character {text[error.start]!r} is not valid Unicode text'
        ) from error
    if len(document) > MAX_XML_BYTES:
        raise _too_big(len(document), source)
    return document


def _too_big(size: int, source: str) -> ModelError:
    return ModelError(f'{source}: the text has {size} bytes; at most {MAX_XML_BYTES} are accepted')


def _parser(recover: bool = False) -> etree.XMLParser:
    return etree.XMLParser(
        resolve_entities=False,
        no_network=True,
        load_dtd=False,
        dtd_validation=False,
        huge_tree=False,
        remove_comments=True,
        remove_pis=True,
        recover=recover,
        encoding='utf-8',
    )


def _parse_document(document: bytes, source: str) -> etree._Element:
    parser, url = _parser(), document_url(source, is_expanded_xacro(document))
    try:
        return etree.fromstring(document, parser, base_url=url)
    except etree.XMLSyntaxError as error:
        faults = list(parser.error_log)
        if not faults or any(fault.type != _UNDEFINED_PREFIX for fault in faults):
            raise ModelError(_malformed(source, error.lineno or 1, error.msg or '')) from error
    # An undeclared prefix (<sensor:ray>) is harmless, and Gazebo accepts it, too.
    return etree.fromstring(document, _parser(recover=True), base_url=url)


def _drop_default_namespace(root: etree._Element) -> None:
    """Name elements as they are written: Gazebo's parser does not know namespaces either."""
    for element in root.iter(etree.Element):
        if element.prefix is None and element.tag.startswith('{'):
            element.tag = etree.QName(element).localname


def _syntax_sentence(document: bytes, source: str, error: expat.ExpatError) -> str:
    opened = document.rfind(b'<!--')
    if opened >= 0 and document.find(b'-->', opened) < 0:
        line = document.count(b'\n', 0, opened) + 1
        return f"{source}, line {line}: a comment '<!--' is never closed; add '-->'"
    if b'<' not in document:
        return _malformed(
            source, 1, 'a URDF or SDF document was expected, the text has no element at all'
        )
    # libxml2 explains it better, e.g. naming both of two mismatched tags. It gets only the part
    # that was scanned, and a little more.
    tag = document.rfind(b'<', 0, error.offset)
    if document.count(b'=', max(tag, 0), error.offset) <= MAX_XML_ATTRIBUTES:
        try:
            etree.fromstring(document[: error.offset + MAX_XML_ATTRIBUTES], _parser())
        except etree.XMLSyntaxError as better:
            return _malformed(source, better.lineno or 1, better.msg or '')
    return _malformed(source, error.lineno, expat.ErrorString(error.code))


def _malformed(source: str, line: int, reason: str) -> str:
    reason = re.sub(r',? line \d+, column \d+$', '', reason.strip()) or 'unreadable'
    return f'{source}, line {line}: not well-formed XML: {shortened(reason)}'


def _depth_sentence(source: str, line: int) -> str:
    return (
        f'{source}, line {line}: elements are nested more than {MAX_XML_DEPTH} deep; '
        'no model needs that, look for elements that are not closed'
    )
