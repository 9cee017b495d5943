"""Processes that the demo starts."""

import stat
import subprocess
import sys

import pytest

from rosbots_description.cli.launched import Launched, descendants


@pytest.mark.parametrize(
    ('output', 'sentence'),
    [
        (
            '[INFO] all well\n[ERROR] [1.5, 0.0]: no such mesh\n[INFO] bye\n',
            '[ERROR] [1.5, 0.0]: no such mesh (see {log})',
        ),
        (
            '\x1b]2;title\x07\x1b[31m[gazebo-2] process has died [pid 7, exit code 1, cmd /a/b '
            'c].\x1b[0m',
            '[gazebo-2] process has died [pid 7, exit code 1] (see {log})',
        ),
        ('done\n', 'see {log}'),
    ],
)
def test_reported_error_is_the_last_one_without_colours(tmp_path, output, sentence):
    log = tmp_path / 'launch.log'
    with Launched(['--version'], log, {'PATH': '/usr/bin'}) as launched:
        launched.wait(60.0)
    log.write_text(output)
    assert launched.error() == sentence.format(log=log)


def test_log_is_its_owners_alone(tmp_path):
    log = tmp_path / 'launch.log'
    with Launched(['--version'], log, {'PATH': '/usr/bin'}) as launched:
        launched.wait(60.0)
    assert stat.S_IMODE(log.stat().st_mode) == 0o600


def test_descendants_are_found_across_sessions():
    parent = subprocess.Popen(
        [
            sys.executable,
            '-c',
            'import subprocess; p = subprocess.Popen(["sleep", "60"], start_new_session=True); '
            'print(p.pid, flush=True); p.wait()',
        ],
        stdout=subprocess.PIPE,
        text=True,
    )
    try:
        child = int(parent.stdout.readline())
        assert descendants(parent.pid) == [child]
    finally:
        subprocess.run(['kill', str(child), str(parent.pid)], check=True)
        parent.wait()
        parent.stdout.close()
