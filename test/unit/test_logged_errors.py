"""Rostests fail on errors and tracebacks in their logs, but on those that they expect."""

import re

import logged_errors
import pytest
import yaml
from support import ROOT

TIME = '2026-11-24 06:02:48,519'
FAULT = 'Traceback (most recent call last):\n  File "a.py", line 1, in f\nValueError: no minimum\n'


@pytest.mark.parametrize(
    ('text', 'found'),
    [
        (f'[rosout][INFO] {TIME}: ready\n[rosout][ERROR] {TIME}: gone\n', ['gone']),
        ('[ERROR] [1795500162.086625, 0.015000]: gone\n', ['gone']),
        ('\x1b[31m[FATAL] [1795500162.08]: gone\x1b[0m\n', ['gone']),
        (f'[rosbots_simulator.sim.x][ERROR] {TIME}: gone\n', ['gone']),
        ('[ WARN] [1795500162.08]: odd\nErrors: 0\n', []),
        (
            f'[rosout][ERROR] {TIME}: bad callback\n{FAULT}',
            ['bad callback', 'traceback: ValueError: no minimum'],
        ),
        (f'[rosout][INFO] {TIME}: ready\n{FAULT}', ['traceback: ValueError: no minimum']),
        (FAULT, ['traceback: ValueError: no minimum']),
        ('Traceback (most recent call last):\n  File', ['traceback: without an end']),
        (f'[rospy.internal][ERROR] {TIME}: {FAULT}[rosout][ERROR] {TIME}: gone\n', ['gone']),
        (f'[rosmaster.threadpool][ERROR] {TIME}: {FAULT}', []),
        ('', []),
    ],
)
def test_errors_and_tracebacks_are_found_but_not_those_of_connections(text, found):
    assert list(logged_errors.errors(text.splitlines(keepends=True))) == found


@pytest.mark.parametrize(
    ('expected', 'said'),
    [
        ({}, ['not expected, in it.log: model [x] does not exist']),
        ({r'^model \[x\]': 'it is absent'}, []),
        (
            {r'^model \[x\]': 'it is absent', 'never': 'it fails'},
            ['expected, but not logged: never'],
        ),
        ({r'^model \[x\]': 'it is absent', 'never': 'perhaps, if late'}, []),
    ],
)
def test_what_is_not_expected_or_not_logged_is_told_once(tmp_path, expected, said):
    log = tmp_path / 'it.log'
    log.write_text(2 * f'[rosout][ERROR] {TIME}: model [x] does not exist\n')
    assert logged_errors.unexpected([log, log], expected) == said


def test_each_expected_error_belongs_to_a_rostest_and_has_a_reason():
    lists = yaml.safe_load((ROOT / 'test' / 'rostest' / 'expected_errors.yaml').read_text())
    for test, expected in lists.items():
        assert test == 'any' or (ROOT / 'test' / 'rostest' / f'{test}.test').is_file()
        for pattern, why in expected.items():
            assert test != 'any' or why.startswith('perhaps')
            assert re.compile(pattern).search('') is None
            assert why
