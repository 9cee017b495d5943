"""Read XML safely: bounded, no DTD, no network; what is wrong is said with file and line.

The tree that comes out is lxml's, without comments and processing instructions. `markup_values`
reads numbers, poses and names from it and words the complaints.
"""

import re

from lxml import etree

from .errors import ModelError

MAX_BYTES = 10_000_000
MAX_DEPTH = 200
MAX_ELEMENTS = 100_000

_DECLARATION = re.compile(r'\s*<\?xml\b[^>]*\?>')
_XACRO_EXPRESSION = re.compile(r'\$\{[^}]*\}|\$\([^)]*\)')
_UNDEFINED_PREFIX = etree.ErrorTypes.NS_ERR_UNDEFINED_NAMESPACE
# A document type can only come before the first element, after comments and instructions. Atomic
# groups, so that a long row of comments takes no longer than reading it.
_DOCTYPE = re.compile(rb'(?>\s*+(?><!--.*?-->|<\?.*?\?>))*+\s*+<!DOCTYPE', re.DOTALL)
_XACRO_CURE = 'run it through xacro first, e.g. command="xacro FILE" in the launch file'


def parse(text: str | bytes, source: str) -> etree._Element:
    """Return the root element of a document.

    Every element knows its line (`sourceline`) and the document its `source`
    (`getroottree().docinfo.URL`), a file or parameter name that begins every message.

    Raises:
        ModelError: the text is empty, too big, too deep, not UTF-8, no well-formed XML, has a
            DTD (and so perhaps entities that multiply), or is xacro nobody expanded.
    """
    document = _decode(text, source)
    if _DOCTYPE.match(document):  # before the parser sees an entity
        raise ModelError(f'{source}: a document type (<!DOCTYPE>) is not accepted; remove it')
    root = _parse_document(document, source)
    _check_bounds(root, source)
    _refuse_xacro(root, source)
    return root


def root_tag(text: str | bytes) -> str | None:
    """Return the name of the first element, or None where the text does not begin as XML.

    It looks no further, so a document that is broken later on still has a root.
    """
    try:
        document = _decode(text, '')
    except ModelError:
        return None
    parser = etree.XMLPullParser(
        events=('start',), recover=True, resolve_entities=False, no_network=True
    )
    try:
        parser.feed(document)
    except etree.XMLSyntaxError:
        return None
    _, element = next(parser.read_events(), (None, None))
    return None if element is None else element.tag


def _decode(text: str | bytes, source: str) -> bytes:
    """Return the document as UTF-8 without its declaration, lines kept."""
    if isinstance(text, bytes):
        try:
            text = text.decode('utf-8-sig')
        except UnicodeDecodeError as error:
            line = text.count(b'\n', 0, error.start) + 1
            raise ModelError(
                f'{source}, line {line}: byte 0x{text[error.start]:02x} is not UTF-8; '
                'save the file in UTF-8'
            ) from error
    text = text.removeprefix('\ufeff')
    if not text.strip():
        raise ModelError(f'{source}: the text is empty; a <robot> or <sdf> element was expected')
    # The text is decoded already: whatever encoding the declaration names would only confuse.
    declaration = _DECLARATION.match(text)
    if declaration:
        text = '\n' * declaration[0].count('\n') + text[declaration.end():]
    try:
        document = text.encode()
    except UnicodeEncodeError as error:
        line = text.count('\n', 0, error.start) + 1
        raise ModelError(
            f'{source}, line {line}: character {text[error.start]!r} is not valid Unicode text'
        ) from error
    if len(document) > MAX_BYTES:
        raise ModelError(
            f'{source}: the text has {len(document)} bytes; at most {MAX_BYTES} are accepted'
        )
    return document


def _parser(recover: bool = False) -> etree.XMLParser:
    return etree.XMLParser(
        resolve_entities=False, no_network=True, load_dtd=False, dtd_validation=False,
        huge_tree=False, remove_comments=True, remove_pis=True, recover=recover,
        encoding='utf-8',
    )


def _parse_document(document: bytes, source: str) -> etree._Element:
    parser = _parser()
    try:
        return etree.fromstring(document, parser, base_url=source)
    except etree.XMLSyntaxError as error:
        faults = list(parser.error_log)
        if not faults or any(fault.type != _UNDEFINED_PREFIX for fault in faults):
            raise ModelError(_syntax_sentence(document, source, error)) from error
    # A prefix that nobody declared (<sensor:ray>) is harmless, and Gazebo takes it too.
    return etree.fromstring(document, _parser(recover=True), base_url=source)


def _syntax_sentence(document: bytes, source: str, error: etree.XMLSyntaxError) -> str:
    opened = document.rfind(b'<!--')
    if opened >= 0 and document.find(b'-->', opened) < 0:
        line = document.count(b'\n', 0, opened) + 1
        return f"{source}, line {line}: a comment '<!--' is never closed; add '-->'"
    if 'Excessive depth' in (error.msg or ''):
        return _depth_sentence(source, error.lineno or 0)
    reason = re.sub(r',? line \d+, column \d+$', '', (error.msg or 'unreadable').strip())
    if b'<' not in document:
        reason = 'a URDF or SDF document was expected, the text has no element at all'
    return f'{source}, line {error.lineno or 1}: not well-formed XML: {reason}'


def _depth_sentence(source: str, line: int) -> str:
    return (
        f'{source}, line {line}: elements are nested more than {MAX_DEPTH} deep; '
        'no model needs that, look for elements that are not closed'
    )


def _check_bounds(root: etree._Element, source: str) -> None:
    count, level, depth = 0, [root], 0
    while level:
        count, depth = count + len(level), depth + 1
        if depth > MAX_DEPTH:
            raise ModelError(_depth_sentence(source, level[0].sourceline))
        if count > MAX_ELEMENTS:
            raise ModelError(f'{source}: more than {MAX_ELEMENTS} elements are not accepted')
        level = [child for element in level for child in element]


def _refuse_xacro(root: etree._Element, source: str) -> None:
    for element in root.iter(etree.Element):
        name = f'{element.prefix}:{etree.QName(element).localname}' \
            if element.prefix else element.tag
        if name.startswith('xacro:'):
            raise ModelError(
                f'{source}, line {element.sourceline}: <{name}> is unexpanded xacro; {_XACRO_CURE}'
            )
        places = [(f'{key}="{value}"', value) for key, value in element.attrib.items()]
        places.append((f'<{name}>{(element.text or "").strip()}', element.text or ''))
        for shown, value in places:
            if '$' in value and _XACRO_EXPRESSION.search(value):
                raise ModelError(
                    f'{source}, line {element.sourceline}: {shown} in <{name}> is unexpanded '
                    f'xacro; {_XACRO_CURE}'
                )
