"""Strategies that damage a document, like typing errors, converters and attackers."""

import struct
from collections.abc import Iterator
from copy import deepcopy
from typing import Any

from hypothesis import strategies as st
from lxml import etree

# Replacements for numbers, names and flags.
ADVERSARIAL = st.sampled_from(
    (
        '',
        ' ',
        '0',
        '-0',
        '-1',
        '1e999',
        '-1e999',
        '1e308',
        '-1e308',
        '1e-320',
        '1e16',
        'nan',
        'NaN',
        'inf',
        '-inf',
        '1,5',
        '0x10',
        '1_000',
        '1e',
        '1.2.3',
        '١٢',
        '1 2',
        '1 2 3',
        '0 0 0',
        '1e308 1e308 1e308',
        '0 0 0 0 0 nan',
        '1 2 3 4 5 6 7',
        'true',
        'world',
        '__model__',
        '::',
        'a::b',
        '\x00',
        'a\x00b',
        '\n',
        'a\nb',
        '1\n2',
        '\x7f',
        '\u202e',
        '\u2028',
        '\x85',
        'ünï',
        '🤖',
        '\ufeff',
        '\ud800',
        '&amp;',
        '&lol;',
        '${x}',
        '$(find x)',
        '../../etc/passwd',
        'package://',
        'package://nobody/x.dae',
        'model://',
        'file:///',
        '/dev/zero',
        '/',
        '.',
        'a' * 999,
        'a' * 1001,
        '9' * 400,
        'x' * 100_000,
        '1 ' * 5000,
    )
) | st.text(max_size=8)
RAW = (
    st.text()
    | st.binary()
    | st.sampled_from(
        (
            '<robot',
            '<robot/>',
            '<sdf/>',
            '<?xml?>',
            '<!DOCTYPE a [<!ENTITY b "c">]><robot/>',
            '<a:b/>',
            '<robot>' * 300,
            '<sdf version="x"><model/></sdf>',
            '<robot><link/></robot>',
            b'\xff\xfe<\x00',
            '<sdf><world><include/></world></sdf>',
            '\x00',
            '<robot name="&#0;"/>',
            '<robot>]]></robot>',
        )
    )
)
WORDS = st.sampled_from(
    [struct.pack('<f', x) for x in (0.0, -0.0, 1e-40, 1e30, -3e38, float('nan'), float('inf'))]
    + [struct.pack('<I', n) for n in (1, 2, 127, 2**31 - 1, 2**31, 2**32 - 1)]
) | st.binary(min_size=4, max_size=4)
VALUES = ADVERSARIAL | st.sampled_from(
    (
        None,
        True,
        False,
        0,
        -1,
        1,
        10**9,
        10**400,
        -(2**63),
        0.5,
        -0.5,
        1e-300,
        1e308,
        float('nan'),
        float('inf'),
        float('-inf'),
        b'x',
        [],
        {},
        [[]],
        [{}],
        {'': ''},
        {1: 2},
        {'x': None},
        [1, 2, 3],
        {'x': 1.0},
        {'grid': [1, 2]},
        {'uniform': [0, 1]},
        '$force',
        '$nothing',
        '${x}',
    )
)
_MARK = '@@{}@@'  # placeholder of a text that lxml would not write


@st.composite
def damaged(draw, text: str, most: int = 4) -> str:
    """Return the XML document with one to `most` errors."""
    root = etree.fromstring(text.encode())
    texts: list[str] = []
    for _ in range(draw(st.integers(1, most))):
        elements = list(root.iter(etree.Element))
        element = elements[draw(st.integers(0, len(elements) - 1))]
        draw(st.sampled_from(_DAMAGES))(draw, root, element, texts)
    result = etree.tostring(root, encoding='unicode')
    for i, replacement in enumerate(texts):
        result = result.replace(_MARK.format(i), replacement)
    if draw(st.integers(0, 9)) == 0:
        cut = draw(st.integers(0, len(result)))
        result = result[:cut] + draw(st.sampled_from(('', result[:cut], '<', '\x00', ']]>')))
    return result


@st.composite
def spoiled(draw, text: str) -> str:
    """Return the document with one wrong attribute or text."""
    root = etree.fromstring(text.encode())
    places = [
        (element, key)
        for element in root.iter(etree.Element)
        for key in (*sorted(element.attrib), *([] if len(element) else ['']))
    ]
    element, key = places[draw(st.integers(0, len(places) - 1))]
    if key:
        element.set(key, _MARK.format(0))
    else:
        element.text = _MARK.format(0)
    result = etree.tostring(root, encoding='unicode')
    return result.replace(_MARK.format(0), draw(ADVERSARIAL))


@st.composite
def damaged_lines(draw, text: str) -> str:
    """Return a text of words in lines with one or two errors."""
    lines = [line.split(' ') for line in text.splitlines()]
    for _ in range(draw(st.integers(1, 2))):
        line = draw(st.sampled_from(lines))
        at = draw(st.integers(0, len(line) - 1))
        match draw(st.sampled_from(('drop', 'double', 'word', 'word', 'other word', 'cut'))):
            case 'drop':
                line[:] = ['']
            case 'double':
                lines.append(list(line))
            case 'word':
                line[at] = draw(ADVERSARIAL)
            case 'other word':
                line[at] = draw(st.sampled_from(draw(st.sampled_from(lines))))
            case _:
                del line[at + 1 :], lines[draw(st.integers(1, len(lines))) :]
    return '\n'.join(' '.join(line) for line in lines)


@st.composite
def damaged_bytes(draw, data: bytes) -> bytes:
    """Return binary data with one or two errors, in words of four bytes mostly."""
    for _ in range(draw(st.integers(1, 2))):
        at = draw(st.integers(0, len(data) - 1) | st.sampled_from(range(0, len(data), 4)))
        match draw(st.sampled_from(('word', 'word', 'cut', 'insert', 'double'))):
            case 'word':
                data = data[:at] + draw(WORDS) + data[at + 4 :]
            case 'cut':
                data = data[:at]
            case 'insert':
                data = data[:at] + draw(WORDS) + data[at:]
            case _:
                data = data[:at] + data
        if not data:
            break
    return data


@st.composite
def damaged_tree(draw, document: Any) -> Any:
    """Return a document of lists and mappings, as in YAML, with one or two errors."""
    document = deepcopy(document)
    for _ in range(draw(st.integers(1, 2))):
        places = list(_places(document))
        if not places:
            break
        parent, key = draw(st.sampled_from(places))
        match draw(st.sampled_from(('drop', 'value', 'value', 'other value', 'rename'))):
            case 'drop':
                del parent[key]
            case 'value':
                parent[key] = draw(VALUES)
            case 'other value':
                other, place = draw(st.sampled_from(places))
                if other is parent or not list(_places(parent[key])):
                    parent[key] = deepcopy(other[place])
            case _ if isinstance(parent, dict):
                parent[draw(ADVERSARIAL | st.integers())] = parent.pop(key)
    return document


def _places(document: Any) -> Iterator[tuple[Any, Any]]:
    """Yield the containers and keys of all values within."""
    keys = (
        document
        if isinstance(document, dict)
        else range(len(document))
        if isinstance(document, list)
        else ()
    )
    for key in keys:
        yield document, key
        yield from _places(document[key])


def _adversarial(draw, texts: list[str]) -> str:
    texts.append(draw(ADVERSARIAL))
    return _MARK.format(len(texts) - 1)


def _drop(_draw, _root, element, _texts) -> None:
    if element.getparent() is not None:
        element.getparent().remove(element)


def _double(_draw, _root, element, _texts) -> None:
    if element.getparent() is not None:
        element.addnext(deepcopy(element))


def _move(draw, root, element, _texts) -> None:
    """Move an element elsewhere, but not into itself."""
    others = [
        other
        for other in root.iter(etree.Element)
        if element not in (other, *other.iterancestors())
    ]
    if others and element is not root:
        others[draw(st.integers(0, len(others) - 1))].append(element)


def _rename(draw, root, element, _texts) -> None:
    tags = sorted({other.tag for other in root.iter(etree.Element)} | {'nonsense'})
    element.tag = draw(st.sampled_from(tags))


def _drop_attribute(draw, _root, element, _texts) -> None:
    if element.attrib:
        del element.attrib[draw(st.sampled_from(sorted(element.attrib)))]


def _spoil_attribute(draw, _root, element, texts) -> None:
    keys = sorted(element.attrib) or ['name']
    element.set(draw(st.sampled_from(keys)), _adversarial(draw, texts))


def _borrow_attribute(draw, root, element, _texts) -> None:
    """Copy the value of another attribute: duplicate names, wrong references."""
    elements = root.iter(etree.Element)
    values = sorted({value for other in elements for value in other.attrib.values()})
    if element.attrib and values:
        element.set(draw(st.sampled_from(sorted(element.attrib))), draw(st.sampled_from(values)))


def _spoil_text(draw, _root, element, texts) -> None:
    element.text = _adversarial(draw, texts)


_DAMAGES = (
    _drop,
    _double,
    _move,
    _rename,
    _drop_attribute,
    _spoil_attribute,
    _spoil_attribute,
    _borrow_attribute,
    _spoil_text,
    _spoil_text,
)
