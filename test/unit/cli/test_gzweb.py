"""What gzweb says when there can be no window in a browser."""

import importlib.util
import re

import pytest
from support import ROOT

from rosbots_description.cli import gzweb


def test_without_viser_it_says_how_to_get_it(monkeypatch, capsys):
    find = importlib.util.find_spec
    monkeypatch.setattr(importlib.util, 'find_spec',
                        lambda name, *more: None if name == 'viser' else find(name, *more))
    assert gzweb.main([]) == 1
    said = capsys.readouterr().err
    assert said.startswith('gzweb: no window: the Python package viser is not installed')
    (needed,) = re.findall(r'viser==\S+', said)
    assert needed in (ROOT / 'requirements' / 'web.pip').read_text(encoding='utf-8').split()


@pytest.mark.parametrize('arguments', [
    ['--port', '99999'], ['--host', 'no such host'], ['--port', '-1'],
])
def test_an_address_that_cannot_be_served_is_told_in_a_sentence(arguments, capsys):
    assert gzweb.main(arguments) == 1
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith('gzweb: no window at ')


@pytest.mark.parametrize(('arguments', 'token'), [
    (['--token-file', '/nowhere/token'], ''), ([], 'short'),
])
def test_a_token_that_cannot_be_used_is_told_in_a_sentence(arguments, token, monkeypatch, capsys):
    monkeypatch.setenv(gzweb.VARIABLE, token)
    assert gzweb.main([*arguments, '--port', '0']) == 1
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith('gzweb: ')
    assert 'token' in line


def test_a_token_is_no_argument(capsys):
    with pytest.raises(SystemExit):
        gzweb.main(['--token', 'x' * 20])
    assert 'unrecognized' in capsys.readouterr().err
