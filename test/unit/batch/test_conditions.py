"""Conditions: expressions over a row, and what is said of those that do not hold."""

import pytest

from rosbots_description.batch import Condition

ROW = {'x_end': 3.0, 'y_end': 4.0, 'none': None, 'name': 'room', 'nan': float('nan')}


@pytest.mark.parametrize(
    'text',
    [
        'x_end == 3.0',
        'hypot(x_end, y_end) <= 5',
        '2 < x_end < 4 and not y_end < x_end',
        "x_end > 10 if name == 'empty' else x_end > 1",
        'abs(-x_end) < pi',
        'max(x_end, y_end) == 4',
    ],
)
def test_a_condition_holds(text):
    assert Condition(text, ROW).fault(ROW) == ''


def test_what_does_not_hold_is_said_with_the_values():
    assert (
        Condition('x_end > y_end', ROW).fault(ROW)
        == "'x_end > y_end' does not hold: x_end = 3, y_end = 4"
    )


def test_what_was_not_recorded_does_not_hold():
    assert (
        Condition('none < 1', ROW).fault(ROW)
        == "'none < 1' does not hold: nothing was recorded for none"
    )


def test_nothing_holds_of_what_is_not_a_number():
    assert 'nan = nan' in Condition('nan < 1', ROW).fault(ROW)


@pytest.mark.parametrize(
    ('text', 'said'),
    [
        (
            'z_end > 1',
            "'z_end', which is neither recorded nor a parameter; there are: x_end, y_end",
        ),
        ('x_end >', 'is not an expression'),
        ('', 'is not an expression'),
        ('x_end = 3', 'is not an expression'),
        ('exec(x_end)', "'exec', which is neither"),
    ],
)
def test_what_is_no_condition_is_named(text, said):
    with pytest.raises(ValueError, match=said):
        Condition(text, ROW)


@pytest.mark.parametrize(
    'text',
    [
        '1 / (x_end - 3) > 0',
        'x_end < name',
        'name.upper.__class__',
        '9 ** 9 ** 9 ** 9 > 1',
        'x_end.__class__ == 1',
        "name[9] == 'r'",
    ],
)
def test_what_cannot_be_computed_is_said(text):
    with pytest.raises(ValueError, match='cannot be computed'):
        Condition(text, ROW).fault(ROW)
