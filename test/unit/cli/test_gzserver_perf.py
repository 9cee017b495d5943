"""The server with a profile of its simulation thread, whatever the server returns."""

import pytest

from rosbots_description.cli import gzserver_perf


def test_profile_is_printed_and_the_servers_arguments_and_exit_code_passed_on(monkeypatch, capsys):
    given = []
    monkeypatch.setattr(
        gzserver_perf.gzserver, 'main', lambda arguments: given.append(arguments) or sum(range(3))
    )
    assert gzserver_perf.main(['-u']) == 3
    assert given == [['-u']]
    assert 'built-in method builtins.sum' in capsys.readouterr().out


def test_profile_is_printed_when_the_server_fails(monkeypatch, capsys):
    def fail(_arguments):
        raise OSError('no port')

    monkeypatch.setattr(gzserver_perf.gzserver, 'main', fail)
    with pytest.raises(OSError, match='no port'):
        gzserver_perf.main([])
    assert 'function calls' in capsys.readouterr().out
