"""The command line of run_scenario, as far as it needs no simulator."""

from unittest.mock import Mock

import pytest
import yaml
from support.batches import pushed_ball
from support.refusals import exit_code

from rosbots_description.batch import ScenarioError
from rosbots_description.cli import run_scenario
from rosbots_description.ros_api import transport
from rosbots_description.ros_api.clients import scenario_run


@pytest.mark.parametrize(
    ('changes', 'arguments', 'said'),
    [
        ({}, ['--run', '2'], 'run_scenario: there is no run 2; it has 2, from 0\n'),
        ({'modles': []}, [], 'run_scenario: {}: Object contains unknown field `modles`\n'),
    ],
)
def test_what_cannot_be_run_is_said_in_one_sentence(tmp_path, capsys, changes, arguments, said):
    path = tmp_path / 'ball.yaml'
    path.write_text(yaml.safe_dump(pushed_ball(**changes)))
    assert run_scenario.main([str(path), *arguments, '__name:=test']) == 2
    assert capsys.readouterr() == ('', said.format(path))


@pytest.mark.parametrize(
    ('outcome', 'code', 'out', 'err'),
    [
        ([{'x_end': 1.5}], 0, 'x_end: 1.5\n', ''),
        (AssertionError('it does not hold'), 1, '', 'run_scenario: it does not hold\n'),
        (ScenarioError('no topic'), 1, '', 'run_scenario: no topic\n'),
    ],
)
def test_a_run_by_hand_prints_its_row_or_one_sentence(
    tmp_path, monkeypatch, capsys, outcome, code, out, err
):
    path = tmp_path / 'ball.yaml'
    path.write_text(yaml.safe_dump(pushed_ball()))
    monkeypatch.setattr(transport, 'start_node', lambda *_: None)
    monkeypatch.setattr(scenario_run, 'run_scenario', Mock(side_effect=outcome))
    assert run_scenario.main([str(path)]) == code
    assert capsys.readouterr() == (out, err)


def test_what_is_no_command_is_refused(capsys):
    assert exit_code(run_scenario.main, ['--gtest_output=xml:a.xml']) == 2
    assert 'usage: run_scenario' in capsys.readouterr().err
