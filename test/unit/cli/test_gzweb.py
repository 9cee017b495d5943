"""What gzweb says when there can be no window in a browser."""

import importlib.util
import re
from pathlib import Path

import pytest
from support import ROOT
from support.refusals import exit_code

from rosbots_description.cli import gzweb, page_token


def test_without_viser_it_says_how_to_get_it(monkeypatch, capsys):
    find = importlib.util.find_spec
    monkeypatch.setattr(
        importlib.util,
        'find_spec',
        lambda name, *more: None if name == 'viser' else find(name, *more),
    )
    assert gzweb.main([]) == 1
    said = capsys.readouterr().err
    assert said.startswith('gzweb: no window: the Python package viser is not installed')
    (needed,) = re.findall(r'viser==\S+', said)
    assert needed in (ROOT / 'requirements' / 'web.pip').read_text(encoding='utf-8').split()


@pytest.mark.parametrize(
    'arguments',
    [
        ['--port', '99999'],
        ['--host', 'no such host'],
        ['--port', '-1'],
    ],
)
def test_an_address_that_cannot_be_served_is_told_in_a_sentence(arguments, capsys):
    assert gzweb.main(arguments) == 1
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith('gzweb: no window at ')


@pytest.mark.parametrize(
    ('arguments', 'token'),
    [
        (['--token-file', '/nowhere/token'], ''),
        ([], 'short'),
        (['--viewing-token-file', '/nowhere/token'], ''),
    ],
)
def test_a_token_that_cannot_be_used_is_told_in_a_sentence(arguments, token, monkeypatch, capsys):
    monkeypatch.setenv(page_token.VARIABLE, token)
    assert gzweb.main([*arguments, '--port', '0']) == 1
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith('gzweb: ')
    assert 'token' in line


def test_a_token_is_no_argument(capsys):
    assert exit_code(gzweb.main, ['--token', 'x' * 20]) == 2
    assert 'unrecognized' in capsys.readouterr().err


def test_a_token_of_a_file_that_others_can_read_is_refused(tmp_path, capsys):
    path = tmp_path / 'token'
    path.write_text('a-token_of_16-chars', encoding='utf-8')
    path.chmod(0o644)
    assert gzweb.main(['--viewing-token-file', str(path), '--port', '0']) == 1
    assert capsys.readouterr().err == (
        f"gzweb: no token in '{path}': others can read it; make it your own, and chmod 600\n"
    )
    path.chmod(0o600)
    assert page_token.given_token(str(path)) == 'a-token_of_16-chars'


@pytest.mark.parametrize('number', ['0', '-1', '1001', '2.5', 'many', '', '\u0665'])
def test_a_number_of_viewers_that_cannot_be_is_refused(number, capsys):
    assert exit_code(gzweb.main, [f'--max-viewers={number}']) == 2
    assert f"'{number}' is no number from 1 to 1000" in capsys.readouterr().err


def test_both_addresses_are_printed_and_tokens_only_where_nobody_else_reads(
    tmp_path, capsys, monkeypatch
):
    address, viewing = 'http://127.0.0.1:1/?token=a', 'http://127.0.0.1:1/?token=b'
    with page_token.announced('gzweb', address, viewing):
        said = capsys.readouterr().err
    assert said == f'gzweb: the world is at {address}\ngzweb: to look at it only: {viewing}\n'
    with open(tmp_path / 'log', 'w', encoding='utf-8') as log:
        log.reconfigure(line_buffering=True)
        (tmp_path / 'log').chmod(0o644)
        monkeypatch.setattr('sys.stderr', log)
        with page_token.announced('gzweb', address, viewing):
            said = (tmp_path / 'log').read_text(encoding='utf-8')
            pages = re.findall(r'; (\S+) opens it', said)
            texts = [Path(page).read_text(encoding='utf-8') for page in pages]
            assert ['token=a' in text for text in texts] == [True, False]
            assert ['token=b' in text for text in texts] == [False, True]
    assert 'token=' not in said
