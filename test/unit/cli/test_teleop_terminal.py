"""Single keys from a terminal, on a pseudo-terminal; and the node's settings."""

import contextlib
import os
import pty
import termios
import time

import pytest
from support.patience import PATIENCE
from support.programs import ran_by_python

from rosbots_description.cli.key_terminal import read_key, single_keys
from rosbots_description.cli.teleop_twist_keyboard import Settings


def _always():
    return True


@pytest.fixture
def terminal():
    """Return both ends of a pseudo-terminal: the keyboard's and the program's."""
    keyboard, program = pty.openpty()
    yield keyboard, program
    for end in (keyboard, program):
        with contextlib.suppress(OSError):  # closed by the test
            os.close(end)


def test_each_key_is_read_at_once_ctrl_c_too(terminal):
    keyboard, program = terminal
    with single_keys(program):
        os.write(keyboard, b'iq\x03')
        assert [read_key(program, PATIENCE, _always) for _ in range(3)] == ['i', 'q', '\x03']


def test_terminal_is_restored_even_after_an_error(terminal):
    _, program = terminal
    before = termios.tcgetattr(program)
    with pytest.raises(RuntimeError), single_keys(program):
        assert termios.tcgetattr(program) != before
        raise RuntimeError
    assert termios.tcgetattr(program) == before


def test_timeout_without_a_key_returns_none(terminal):
    _, program = terminal
    start = time.monotonic()
    with single_keys(program):
        assert read_key(program, 0.03, _always) is None
    assert time.monotonic() - start >= 0.03


def test_wait_for_a_key_can_be_interrupted(terminal):
    _, program = terminal
    with single_keys(program):
        assert read_key(program, float('inf'), iter([True, False]).__next__) is None


def test_hangup_of_the_terminal_is_end_of_file(terminal):
    keyboard, program = terminal
    os.close(keyboard)
    with pytest.raises(EOFError):
        read_key(program, PATIENCE, _always)


def test_missing_terminal_is_an_error():
    program = ran_by_python(
        '-c',
        'import sys; sys.modules["rospy"] = None\n'
        'from rosbots_description.cli.teleop_twist_keyboard import main; sys.exit(main())',
        input='',
    )
    assert program.returncode == 1
    assert 'not a terminal' in program.stderr and 'Traceback' not in program.stderr


@pytest.mark.parametrize(
    'wrong',
    [
        {'speed': 'fast'},
        {'turn': True},
        {'speed': float('inf')},
        {'key_timeout': -1},
        {'repeat_rate': float('nan')},
    ],
)
def test_error_names_the_invalid_parameter(wrong):
    ((name, value),) = wrong.items()
    with pytest.raises(ValueError, match=f'~{name} must be .*{value!r}'):
        Settings(**wrong)
