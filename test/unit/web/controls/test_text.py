"""Text of strangers is shown as text: it makes no element, no attribute and no second line."""

import re
from html.parser import HTMLParser
from pathlib import Path

import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from support.hostile_texts import TEXTS

from rosbots_description import web
from rosbots_description.web.controls.text import MOST, markup, plain, table

FOLDER = Path(web.__file__).parent
ANY = st.one_of(st.text(), st.sampled_from(TEXTS), st.text('<>&"\'`=/! \n\\[](){}*_#|~@:;-.wha'))


class Parts(HTMLParser):
    """What a parser of HTML finds in a text."""

    def __init__(self, text):
        super().__init__(convert_charrefs=True)
        self.tags, self.attributes, self.text = [], [], ''
        self.feed(text)
        self.close()

    def handle_starttag(self, tag, attributes):
        self.tags.append(tag)
        self.attributes += attributes

    def handle_endtag(self, tag):
        self.tags.append(f'/{tag}')

    def handle_data(self, data):
        self.text += data

    def handle_comment(self, data):
        raise AssertionError(data)

    handle_decl = handle_pi = unknown_decl = handle_comment


@given(ANY)
def test_properties_of_marked_up_text(text):
    found = Parts(f'<p title="{markup(text)}">{markup(text)}</p>')
    assert found.tags == ['p', '/p']
    assert found.text == plain(text)
    assert found.attributes == [('title', plain(text))]
    assert not set('<>"\'') & set(markup(text))


@given(ANY)
@example('a\u00a0b')  # a space that breaks no line
def test_properties_of_plain_text(text):
    shown = plain(text)
    assert len(shown) <= MOST
    assert len(shown.splitlines()) <= 1
    assert shown.isprintable()
    assert plain(shown) == shown
    shown.encode('utf-8')


@given(st.lists(st.tuples(ANY, ANY), max_size=4))
def test_properties_of_a_table_of_texts(rows):
    found = Parts(table(rows))
    assert found.tags.count('tr') == len(rows)
    assert set(found.tags) <= {one for tag in ('table', 'tr', 'td') for one in (tag, f'/{tag}')}
    assert {name for name, _ in found.attributes} <= {'style'}


@pytest.mark.parametrize('text', ['r\u00e4der', '\u8f2e', 'a b', 'wheel_1', '\U0001f916'])
def test_letters_of_all_languages_stay(text):
    assert plain(text) == text


def test_long_text_is_cut_off():
    assert plain('x' * 500) == 'x' * (MOST - 1) + '\u2026'


def test_names_of_strangers_are_offered_in_one_place():
    offered = {
        path.name
        for path in FOLDER.rglob('*.py')
        if re.search(r'\w\.options = (?!{)', path.read_text(encoding='utf-8'))
    }
    assert offered == {'choice.py'}  # other lists are the page's own, and stay as they are


def test_html_is_made_in_one_place_and_markdown_nowhere():
    made = {
        path.name
        for path in FOLDER.rglob('*.py')
        if re.search(r'add_html\(|\.content = ', path.read_text(encoding='utf-8'))
    }
    # texts by `markup` and `table`
    assert made == {
        'text.py',
        'faults.py',
        'inspector.py',  # both: what descriptions.py made
        'time_control.py',
        'camera_keys.py',
        'drive.py',
        'layout.py',  # constants
        'clock.py',
        'keys.py',
        'world_name.py',
    }
    everything = '\n'.join(path.read_text(encoding='utf-8') for path in FOLDER.rglob('*.py'))
    # a constant
    assert not re.search(
        r'add_markdown|add_modal|add_label|run_javascript|add_plotly|'
        r'html\.escape|import escape',
        everything.replace('return html.escape(plain(text, most))', '').replace(
            'client.gui.add_modal(TITLE)', ''
        ),
    )
