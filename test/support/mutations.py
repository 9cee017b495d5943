"""Strategies that damage a description, like typing errors, converters and attackers."""

from copy import deepcopy

from hypothesis import strategies as st
from lxml import etree

# Replacements for numbers, names and flags.
ADVERSARIAL = st.sampled_from((
    '', ' ', '0', '-0', '-1', '1e999', '-1e999', '1e308', '-1e308', '1e-320', '1e16', 'nan',
    'NaN', 'inf', '-inf', '1,5', '0x10', '1_000', '1e', '1.2.3', '١٢', '1 2', '1 2 3', '0 0 0',
    '1e308 1e308 1e308', '0 0 0 0 0 nan', '1 2 3 4 5 6 7', 'true', 'world', '__model__', '::',
    'a::b', '\x00', 'a\x00b', '\n', 'a\nb', '1\n2', '\x7f', '\u202e', '\u2028', '\x85', 'ünï',
    '🤖', '\ufeff', '\ud800', '&amp;', '&lol;', '${x}', '$(find x)', '../../etc/passwd',
    'package://', 'package://nobody/x.dae', 'model://', 'file:///', '/dev/zero', '/', '.',
    'a' * 999, 'a' * 1001, '9' * 400, 'x' * 100_000, '1 ' * 5000,
)) | st.text(max_size=8)
RAW = st.text() | st.binary() | st.sampled_from((
    '<robot', '<robot/>', '<sdf/>', '<?xml?>', '<!DOCTYPE a [<!ENTITY b "c">]><robot/>', '<a:b/>',
    '<robot>' * 300, '<sdf version="x"><model/></sdf>', '<robot><link/></robot>', b'\xff\xfe<\x00',
    '<sdf><world><include/></world></sdf>', '\x00', '<robot name="&#0;"/>', '<robot>]]></robot>',
))
_MARK = '@@{}@@'  # placeholder of a text that lxml would not write


@st.composite
def damaged(draw, text: str) -> str:
    """Return the document with one to four errors."""
    root = etree.fromstring(text.encode())
    texts: list[str] = []
    for _ in range(draw(st.integers(1, 4))):
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
    places = [(element, key) for element in root.iter(etree.Element)
              for key in (*sorted(element.attrib), *([] if len(element) else ['']))]
    element, key = places[draw(st.integers(0, len(places) - 1))]
    if key:
        element.set(key, _MARK.format(0))
    else:
        element.text = _MARK.format(0)
    result = etree.tostring(root, encoding='unicode')
    return result.replace(_MARK.format(0), draw(ADVERSARIAL))


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
    others = [other for other in root.iter(etree.Element)
              if element not in (other, *other.iterancestors())]
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


_DAMAGES = (_drop, _double, _move, _rename, _drop_attribute, _spoil_attribute, _spoil_attribute,
            _borrow_attribute, _spoil_text, _spoil_text)
