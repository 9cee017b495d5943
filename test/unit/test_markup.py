"""Any text at all becomes a tree or one clear sentence."""

import pytest

from rosbots_description.sim import markup
from rosbots_description.sim.errors import ModelError
from rosbots_description.sim.markup import parse, root_tag, source_of


def complaint(text):
    with pytest.raises(ModelError) as caught:
        parse(text, 'bot.urdf')
    sentence = str(caught.value)
    assert sentence.startswith('bot.urdf')
    assert '\n' not in sentence
    return sentence


def test_an_element_knows_its_line_and_the_document_its_source():
    text = '<?xml version="1.0"?>\n<!-- one\n two -->\n<robot>\n  <link/>\n</robot>'
    root = parse(text, 'bot.urdf')
    assert root.tag == 'robot'
    assert root[0].sourceline == 5
    assert source_of(root) == 'bot.urdf'


@pytest.mark.parametrize('source', [
    '/tmp/Mein Roboter ä/a%20b #&"<.urdf', 'model://sun', '/tmp/not_utf8_\udcff.world',
])
def test_a_source_is_given_back_as_it_was_written(source):
    assert source_of(parse('<robot/>', source)) == source


def test_a_line_beyond_65535_is_counted_right():
    assert parse('<a>' + '\n' * 70000 + '<b/></a>', 's')[0].sourceline == 70001


@pytest.mark.parametrize('text', [
    '<?xml version="1.0" encoding="utf-16"?><a/>',
    '<?xml version="1.0" encoding="latin-1"?>\n<a b="ä"/>',
    '\n  <?xml version="1.0"?><a/>',
    '\ufeff<a/>',
    '<a/>'.encode('utf-8-sig'),
    '<?xml version="1.0" encoding="UTF-8"?><a b="ä"/>'.encode(),
])
def test_declarations_and_byte_order_marks_do_not_disturb(text):
    root = parse(text, 's')
    assert root.tag == 'a'
    assert root.get('b', 'ä') == 'ä'


def test_bytes_that_are_not_utf8_are_named_with_their_line():
    assert 'line 2: byte 0xe4 is not UTF-8' in complaint(b'<a>\n\xe4</a>')


def test_a_lone_surrogate_is_answered():
    assert 'not valid Unicode' in complaint('<a>\ud800</a>')


@pytest.mark.parametrize('text', ['', '  \n\t ', b'', '\ufeff'])
def test_empty_text_is_called_empty(text):
    assert 'the text is empty' in complaint(text)


def test_text_without_any_element_is_called_that():
    assert 'has no element at all' in complaint('hello world')


@pytest.mark.parametrize(('text', 'line'), [
    ('<robot>\n<link name="a">\n', 3),
    ('<robot>\n<link></joint>\n</robot>', 2),
    ('<robot>\n<link name=a/></robot>', 2),
    ('<robot/>\n<robot/>', 2),
    ('<robot>\n&nope;</robot>', 2),
])
def test_malformed_xml_is_named_with_its_line(text, line):
    assert complaint(text).startswith(f'bot.urdf, line {line}: not well-formed XML: ')


def test_an_unclosed_comment_is_answered_at_the_line_where_it_opens():
    sentence = complaint('<robot>\n<!-- fine -->\n<!-- not closed\n<link/>\n</robot>')
    assert sentence == "bot.urdf, line 3: a comment '<!--' is never closed; add '-->'"


def test_an_entity_bomb_is_refused():
    entity = '&e{};'
    levels = ''.join(
        f'<!ENTITY e{i + 1} "{10 * entity.format(i)}">' for i in range(12)
    )
    bomb = f'<!DOCTYPE r [<!ENTITY e0 "x">{levels}]><robot a="&e12;">&e12;</robot>'
    assert 'DOCTYPE' in complaint(bomb)


def test_a_document_type_behind_comments_is_refused_and_one_in_a_comment_is_not():
    assert 'DOCTYPE' in complaint('<!-- a --> <?b c?>\n<!DOCTYPE r><robot/>')
    assert parse('<!-- <!DOCTYPE r> --><robot/>', 'bot.urdf').tag == 'robot'


def test_a_long_row_of_comments_is_read_in_no_time():
    assert parse('<!-- -->' * 100_000 + '<robot/>', 'bot.urdf').tag == 'robot'


def test_a_file_is_never_read_through_an_entity(tmp_path):
    secret = tmp_path / 'secret'
    secret.write_text('treasure')
    text = f'<!DOCTYPE r [<!ENTITY e SYSTEM "file://{secret}">]><robot>&e;</robot>'
    sentence = complaint(text)
    assert 'DOCTYPE' in sentence
    assert 'treasure' not in sentence


@pytest.mark.parametrize('depth', [201, 5000])
def test_too_deep_nesting_is_refused(depth):
    assert 'nested more than 200 deep' in complaint('<a>' * depth + '</a>' * depth)


def test_the_deepest_accepted_nesting_is_accepted():
    assert parse('<a>' * 200 + '</a>' * 200, 's').tag == 'a'


def test_too_much_text_is_refused(monkeypatch):
    monkeypatch.setattr(markup, 'MAX_BYTES', 100)
    assert 'at most 100' in complaint('<a>' + ' ' * 100 + '</a>')


def test_too_many_elements_are_refused(monkeypatch):
    monkeypatch.setattr(markup, 'MAX_ELEMENTS', 10)
    assert 'more than 10 elements' in complaint('<a>' + '<b/>' * 10 + '</a>')


@pytest.mark.parametrize(('text', 'shown'), [
    ('<robot xmlns:xacro="http://ros.org/wiki/xacro">\n<xacro:wheel/></robot>', '<xacro:wheel>'),
    ('<robot>\n<xacro:wheel/></robot>', '<xacro:wheel>'),
    ('<robot>\n<link name="${prefix}link"/></robot>', 'name="${prefix}link"'),
    ('<robot>\n<mesh filename="$(find x)/m.dae"/></robot>', 'filename="$(find x)/m.dae"'),
    ('<robot>\n<topic>${ns}/scan</topic></robot>', '<topic>${ns}/scan'),
])
def test_unexpanded_xacro_is_recognised(text, shown):
    sentence = complaint(text)
    assert sentence.startswith(f'bot.urdf, line 2: {shown}')
    assert 'unexpanded xacro; run it through xacro first' in sentence


def test_expanded_xacro_keeps_its_namespace_and_is_accepted():
    text = '<robot xmlns:xacro="http://www.ros.org/wiki/xacro"><link name="price_in_$"/></robot>'
    assert len(parse(text, 's')) == 1


def test_a_prefix_nobody_declared_is_taken_as_part_of_the_name():
    root = parse('<robot><sensor:ray name="a"/><link/></robot>', 's')
    assert [child.tag for child in root] == ['sensor:ray', 'link']


@pytest.mark.parametrize(('text', 'tag'), [
    ('<robot name="x"/>', 'robot'),
    ('<?xml version="1.0"?><!-- c --><sdf version="1.6">', 'sdf'),
    ('<robot><link></robot>', 'robot'),
    ('<robot><!-- open', 'robot'),
    ('hello world', None),
    ('', None),
    (b'\xff\xfe', None),
])
def test_the_root_is_known_even_of_a_broken_document(text, tag):
    assert root_tag(text) == tag
