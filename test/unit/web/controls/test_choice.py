"""Names of strangers in a list: each is one line of text, no two alike, and stands for itself."""

import pytest
from hypothesis import given
from hypothesis import strategies as st
from support.hostile_texts import TEXTS

from rosbots_description.web.controls.choice import Choice, _by_text
from rosbots_description.web.controls.text import MOST, plain

ALIKE = st.lists(
    st.one_of(
        st.sampled_from([*TEXTS, 'a\0', 'a\u202e', 'a\ufffd', 'a\ufffd (2)', 'x' * 400, 'x' * 500]),
        st.text('a\0\u202e (2)'),
    ),
    max_size=9,
)


@given(ALIKE)
def test_properties_of_names_that_look_alike(names):
    texts = _by_text(names)
    assert list(texts.values()) == list(dict.fromkeys(names))
    assert all(plain(text) == text and len(text) <= MOST for text in texts)


def test_a_thousand_long_names_that_look_alike_are_told_apart():
    names = [500 * 'x' + str(number) for number in range(1000)]
    assert list(_by_text(names).values()) == names


@pytest.fixture
def choice(site):
    return Choice(site.gui, 'Which', ['none'])


def test_what_is_chosen_is_the_name(browser, choice):
    heard = []
    choice.on_update(lambda: heard.append(choice.value))
    choice.offer(['a\0', 'a\u202e', 'b'])
    shown = ['a\ufffd', 'a\ufffd (2)', 'b']
    browser.wait_until(lambda: browser.props('Which')['options'] == shown)
    browser.choose('Which', 'a\ufffd (2)')
    browser.wait_until(lambda: heard and heard[-1] == 'a\u202e')
    choice.offer(['b'])
    assert choice.value == 'b'
    assert choice.names == ('b',)
