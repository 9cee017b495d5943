"""How an address is handed to a browser: where its owner alone can read it."""

import os
import stat
import time

import pytest

from rosbots_description.cli.gzweb import VARIABLE, given_token
from rosbots_description.cli.web_browser import opened

ADDRESS = 'http://127.0.0.1:1/?token=secret&a=1'


@pytest.fixture
def display(tmp_path, monkeypatch):
    """A display, and an xdg-open that notes what it is given."""
    folder = tmp_path / 'bin'
    folder.mkdir()
    program = folder / 'xdg-open'
    program.write_text(f'#!/bin/sh\necho "$@" > {tmp_path}/new\nmv {tmp_path}/new {tmp_path}/given')
    program.chmod(0o755)
    monkeypatch.setenv('PATH', f'{folder}:{os.environ["PATH"]}')
    monkeypatch.setenv('DISPLAY', ':1')
    monkeypatch.setenv('XDG_RUNTIME_DIR', str(tmp_path))
    return tmp_path


def given(folder):
    end = time.monotonic() + 60.0
    while not (folder / 'given').exists():
        assert time.monotonic() < end
        time.sleep(0.01)
    return (folder / 'given').read_text().strip()


def test_browser_gets_a_file_of_its_owner_and_no_command_line_has_the_token(display):
    with opened(ADDRESS) as is_open:
        assert is_open
        path = given(display)
        assert 'secret' not in path
        assert path.startswith(str(display))
        assert stat.S_IMODE(os.stat(path).st_mode) == 0o600
        assert stat.S_IMODE(os.stat(os.path.dirname(path)).st_mode) == 0o700
        with open(path, encoding='utf-8') as file:
            assert 'url=http://127.0.0.1:1/?token=secret&amp;a=1"' in file.read()
    assert not os.path.exists(path)


def test_without_a_display_nothing_is_opened(display, monkeypatch):
    monkeypatch.delenv('DISPLAY')
    monkeypatch.delenv('WAYLAND_DISPLAY', raising=False)
    with opened(ADDRESS) as is_open:
        assert not is_open
    assert not (display / 'given').exists()


def test_without_xdg_open_nothing_is_opened(display, monkeypatch):
    monkeypatch.setenv('PATH', '/nowhere')
    with opened(ADDRESS) as is_open:
        assert not is_open


def test_token_is_that_of_the_file_else_of_the_environment(tmp_path, monkeypatch):
    monkeypatch.delenv(VARIABLE, raising=False)
    assert given_token('') == ''
    monkeypatch.setenv(VARIABLE, 'of-the-environment')
    assert given_token('') == 'of-the-environment'
    path = tmp_path / 'token'
    path.write_text('of-the-file\n')
    path.chmod(0o600)
    assert given_token(str(path)) == 'of-the-file'


@pytest.mark.parametrize('mode', [0o644, 0o640, 0o604, 0o622, 0o601])
def test_a_token_that_others_can_read_is_refused(tmp_path, mode):
    path = tmp_path / 'token'
    path.write_text('of-the-file\n')
    path.chmod(mode)
    with pytest.raises(PermissionError, match='chmod 600'):
        given_token(str(path))
