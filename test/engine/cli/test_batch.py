"""The command line of ./rosbots batch: what it prints, and its exit codes."""

import io

import pytest
import yaml
from support.batches import pushed_ball
from support.refusals import exit_code

from rosbots_description.batch.table import Table
from rosbots_description.cli import batch


@pytest.fixture
def write(tmp_path):
    def to_file(**changes):
        path = tmp_path / 'ball.yaml'
        path.write_text(yaml.safe_dump(pushed_ball(duration=0.1, **changes)))
        return [str(path), '--workers', '0', '--output', str(tmp_path / 'out')]

    return to_file


def test_all_passed(write, tmp_path, capsys):
    assert batch.main(write(conditions=['x_end >= 0'])) == 0
    assert capsys.readouterr() == (
        f'2 runs: 2 passed, 0 failed, 0 with an error\nrows: {tmp_path}/out/rows.parquet\n',
        '',
    )


def test_progress_is_shown_on_a_terminal(write, monkeypatch):
    terminal = io.StringIO()
    terminal.isatty = lambda: True
    monkeypatch.setattr('sys.stderr', terminal)
    monkeypatch.setenv('TERM', 'xterm')
    assert batch.main(write(conditions=[])) == 0
    assert '2/2' in terminal.getvalue()


def test_an_interruption_says_what_is_in_the_folder(write, tmp_path, monkeypatch, capsys):
    add = Table.add

    def interrupted(table, row):
        add(table, row)
        raise KeyboardInterrupt

    monkeypatch.setattr(Table, 'add', interrupted)
    for rows in (1, 2):
        assert batch.main(write(conditions=[])) == 130
        assert capsys.readouterr().err == (
            f'batch: interrupted; {rows} rows are in {tmp_path}/out, and the same command makes '
            'the others\n'
        )


def test_reasons_are_printed_the_most_frequent_first(write, capsys):
    code = batch.main(
        write(
            conditions=[],
            world='$world',
            parameters={'world': {'grid': ['empty', 'nowhere', 'nowhere']}, 'force': 1.0},
        )
    )
    assert code == 1
    lines = capsys.readouterr().out.splitlines()
    assert lines[0] == '3 runs: 1 passed, 0 failed, 2 with an error'
    assert lines[1].startswith('  error 2 x, as run 1: ')
    assert 'nowhere' in lines[1]


@pytest.mark.parametrize(
    ('changes', 'said'),
    [
        ({'modles': []}, 'ball.yaml: Object contains unknown field `modles`'),
        ({'parameters': {'force': {'gird': [1]}}}, "the parameter 'force' is of the kind 'gird'"),
    ],
)
def test_what_is_no_scenario_is_said_in_one_sentence(write, capsys, changes, said):
    assert batch.main(write(**changes)) == 2
    printed = capsys.readouterr()
    assert printed.out == ''
    assert printed.err.startswith('batch: ')
    assert said in printed.err
    assert printed.err.count('\n') == 1


def test_rows_of_another_scenario_are_left_alone(write, capsys):
    assert batch.main(write(conditions=[])) == 0
    assert batch.main(write(conditions=[], seed=2)) == 2
    assert 'holds the rows of another scenario; name another folder' in capsys.readouterr().err


@pytest.mark.parametrize(
    'arguments',
    [['a.yaml', '--workers', '-1'], ['a.yaml', '--workers', '2', '--address', 'auto'], []],
)
def test_what_is_no_command_is_refused(arguments, capsys):
    assert exit_code(batch.main, arguments) == 2
    assert 'usage: ./rosbots batch' in capsys.readouterr().err
