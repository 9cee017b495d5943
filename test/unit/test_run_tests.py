"""The runner of all tests: counts, the order of the lanes, and what repeats a failure."""

import json
import os
import re
import signal
import sys
from pathlib import Path
from xml.etree import ElementTree

import pytest
import repeat_tests
import results
import rostests
import run_tests
from support.refusals import exit_code

HOPELESS = 900.0  # [s, wall]
JUNIT = """<testsuites><testsuite>
<testcase classname="test.unit.test_robot" name="test_a"/>
<testcase classname="test.unit.test_robot" name="test_b[x-1]"><failure>Traceback:
  line 7</failure></testcase>
<testcase classname="test.unit.test_robot" name="test_c"><skipped/></testcase>
</testsuite></testsuites>"""


@pytest.fixture(autouse=True)
def reports(monkeypatch, tmp_path):
    for module in (results, rostests, run_tests):
        monkeypatch.setattr(module, 'REPORTS', tmp_path / 'reports')
    monkeypatch.setattr(run_tests, 'SUMMARY', tmp_path / 'reports' / 'summary.json')


def test_the_longest_rostests_begin_first_and_none_is_lost():
    every = rostests.choose('')
    ordered = rostests.in_order(every)
    assert sorted(ordered) == every
    assert [path.stem for path in ordered[: len(rostests.LONGEST)]] == list(rostests.LONGEST)


def test_every_file_of_rostests_is_run_once():
    written = [path.name for path in rostests.FOLDER.glob('test_*.py')]
    texts = [path.read_text(encoding='utf-8') for path in rostests.FOLDER.glob('*.test')]
    run = [name for text in texts for name in re.findall(r'\btest_\w+\.py', text)]
    assert sorted(run) == sorted(written)


def test_failures_are_named_as_pytest_names_them(tmp_path):
    path = tmp_path / 'unit.xml'
    path.write_text(JUNIT)
    report = results.read_report(path)
    assert (report.count.passed, report.count.failed, report.count.skipped) == (1, 1, 1)
    (case,) = report.failed
    node = run_tests.node_of(case.class_name, case.name)
    assert node == 'test/unit/test_robot.py::test_b[x-1]'
    assert case.reason == 'Traceback:\n  line 7'


def test_a_report_that_cannot_be_read_is_a_failure(tmp_path):
    assert results.read_report(tmp_path / 'none.xml').count.failed == 1


def run_with(monkeypatch, code, arguments=('lint',)):
    command = [sys.executable, '-c', f'print("the cause"); raise SystemExit({code})']
    monkeypatch.setitem(
        run_tests.PHASES, 'lint', lambda _word: run_tests.run_command('lint', 'mypy', command)
    )
    return run_tests.main([*arguments])


def test_a_failure_ends_with_its_command_and_log(monkeypatch, capsys, tmp_path):
    assert run_with(monkeypatch, 3) == 1
    printed = capsys.readouterr().out
    log = tmp_path / 'reports' / 'lint_mypy.log'
    assert log.read_text() == 'the cause\n'
    assert '    the cause\n' in printed
    assert 'FAILED mypy\n    repeat: ./rosbots exec ' in printed
    assert f'    log:    {log}\n' in printed
    assert printed.endswith('0 passed, 1 failed\n')
    summary = json.loads((tmp_path / 'reports' / 'summary.json').read_text())
    assert (summary['failed'], summary['failures']) == (1, ['mypy'])
    assert summary['seconds'].keys() == {'lint', 'all'}


def test_no_phase_is_lost_and_rostests_have_ended_when_the_others_begin(monkeypatch):
    before, ended = {}, []

    def phase(name):
        def run(_word):
            before[name] = tuple(ended)
            ended.append(name)
            return results.Count(passed=1)

        return run

    monkeypatch.setattr(run_tests, 'PHASES', {name: phase(name) for name in run_tests.PHASES})
    took = {}
    assert run_tests.run_phases([*run_tests.PHASES], '', took).passed == len(run_tests.PHASES)
    assert took.keys() == before.keys() == run_tests.PHASES.keys()
    assert [name for name in before if 'rostest' not in before[name]] == ['rostest']


def test_success_is_exit_code_0(monkeypatch, capsys):
    assert run_with(monkeypatch, 0) == 0
    assert 'repeat' not in capsys.readouterr().out


def test_a_failed_test_is_repeated_with_its_seed_and_says_why(capsys):
    reason = '\n'.join(f'line {number}' for number in range(99))
    results.say_failures(
        (results.Failure('x', './rosbots test test/rostest/frames.test', Path('log'), reason),), 7
    )
    printed = capsys.readouterr().out
    assert 'repeat: ./rosbots test test/rostest/frames.test --seed 7\n' in printed
    assert printed.endswith('        line 97\n        line 98\n')  # where the cause is
    assert 'line 80\n' not in printed


def test_unknown_phases_and_files_are_named(capsys):
    assert exit_code(run_tests.main, ['test/unit/test_none.py']) == 2
    assert "no phase and no file 'test/unit/test_none.py'" in capsys.readouterr().err


def test_the_limit_of_a_rostest_only_ends_a_hopeless_wait():
    for path in rostests.choose(''):
        for test in ElementTree.parse(path).iter('test'):
            assert float(test.get('time-limit')) >= HOPELESS, path.name


def test_repeated_runs_end_with_a_table(monkeypatch, capsys):
    summaries = [
        {'seconds': {'unit': 10.0, 'all': 20.0}, 'failures': ['b']},
        {'seconds': {'unit': 30.0, 'all': 40.0}, 'failures': ['a', 'b']},
        {'seconds': {'unit': 20.0}, 'failures': []},
    ]
    given = []
    monkeypatch.setattr(
        repeat_tests, 'run', lambda words: given.append(words) or summaries[len(given) - 1]
    )
    assert repeat_tests.main(['3', 'unit']) == 1
    assert given == [['unit', '--seed', str(number)] for number in range(3)]
    assert capsys.readouterr().out.endswith("""
  failed  test
  2 of 3  b
  1 of 3  a

phase          min  median     max  [s]
unit            10      20      30
all             20      30      40
""")


def test_repeated_runs_are_made_beside_busy_processes_which_end(monkeypatch, capsys):
    from rosbots_description.cli.launched import descendants

    seen = []
    monkeypatch.setattr(
        repeat_tests,
        'run',
        lambda _: seen.extend(descendants(os.getpid())) or {'seconds': {}, 'failures': []},
    )
    before = set(descendants(os.getpid()))
    assert repeat_tests.main(['1', '--load', '2']) == 0
    busy = set(seen) - before
    assert len(busy) == 2
    assert not busy & set(descendants(os.getpid()))
    assert 'no failure in 1 runs' in capsys.readouterr().out


def test_a_run_that_ends_early_is_a_failure(monkeypatch, tmp_path):
    (tmp_path / 'rosbots').write_text('#!/bin/sh\nexit 3\n')
    (tmp_path / 'rosbots').chmod(0o755)
    monkeypatch.setattr(repeat_tests, 'ROOT', tmp_path)
    monkeypatch.setattr(repeat_tests, 'SUMMARY', tmp_path / 'summary.json')
    assert repeat_tests.run([])['failures'] == ['./rosbots test ended with exit code 3']


def test_ctrl_c_reaches_tests_that_run_in_the_background_of_a_shell(monkeypatch):
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        ignored = '__import__("signal").getsignal(2) == __import__("signal").SIG_IGN'
        assert run_with(monkeypatch, ignored) == 0
    finally:
        signal.signal(signal.SIGINT, before)
