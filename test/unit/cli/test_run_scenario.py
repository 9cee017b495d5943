"""The command line of run_scenario, as far as it needs no simulator."""

import pytest
import yaml
from support.batches import pushed_ball

from rosbots_description.cli import run_scenario


@pytest.mark.parametrize(('changes', 'arguments', 'said'), [
    ({}, ['--run', '2'], 'run_scenario: there is no run 2; it has 2, from 0\n'),
    ({'modles': []}, [], 'run_scenario: {}: Object contains unknown field `modles`\n'),
])
def test_what_cannot_be_run_is_said_in_one_sentence(tmp_path, capsys, changes, arguments, said):
    path = tmp_path / 'ball.yaml'
    path.write_text(yaml.safe_dump(pushed_ball(**changes)))
    assert run_scenario.main([str(path), *arguments, '__name:=test']) == 2
    assert capsys.readouterr() == ('', said.format(path))


def test_what_is_no_command_is_refused(capsys):
    with pytest.raises(SystemExit, match='2'):
        run_scenario.main(['--gtest_output=xml:a.xml'])
    assert 'usage: run_scenario' in capsys.readouterr().err
