"""How an address is handed to a browser: where its owner alone can read it."""

import io
import os
import stat
import sys

import pytest
from support.patience import wait_until

from rosbots_description.cli.page_token import VARIABLE, announced, given_token
from rosbots_description.cli.web_browser import is_readable_by_others, opened

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
    wait_until((folder / 'given').exists)
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


@pytest.mark.parametrize(('mode', 'readable'), [(0o644, True), (0o640, True), (0o600, False)])
def test_a_log_that_others_may_read_is_noticed(tmp_path, mode, readable):
    with open(tmp_path / 'log', 'w', encoding='utf-8') as log:
        os.chmod(log.name, mode)
        assert is_readable_by_others(log) == readable


def test_pipes_and_terminals_are_no_log():
    read, write = os.pipe()
    with open(read, encoding='utf-8'), open(write, 'w', encoding='utf-8') as pipe:
        assert not is_readable_by_others(pipe)
    assert not is_readable_by_others(io.StringIO())


@pytest.mark.parametrize('mode', [0o644, 0o600])
def test_a_log_that_others_may_read_gets_no_token(tmp_path, monkeypatch, mode):
    monkeypatch.setenv('XDG_RUNTIME_DIR', str(tmp_path))
    with open(tmp_path / 'log', 'w+', encoding='utf-8') as log:
        os.chmod(log.name, mode)
        monkeypatch.setattr(sys, 'stderr', log)
        with announced('gzweb', ADDRESS, ''):
            log.flush()
            said = (tmp_path / 'log').read_text(encoding='utf-8')
            assert ('secret' in said) == (mode == 0o600)
            assert 'http://127.0.0.1:1/' in said
            (page,) = [*tmp_path.glob('gzweb-*/window.html')] or [None]
            assert (page is None) == (mode == 0o600)
            if page is not None:
                assert str(page) in said
                assert 'secret' in page.read_text(encoding='utf-8')
                assert stat.S_IMODE(page.stat().st_mode) == 0o600
