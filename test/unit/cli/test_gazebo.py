"""The executable gazebo: server and window start and end together."""

import os
import signal
import sys

import pytest
from support.patience import PATIENCE, wait_until

from rosbots_description.cli import gazebo

RUN_UNTIL_CTRL_C = """
import signal, sys, time
signal.signal(signal.SIGINT, lambda *_: sys.exit({code}))
open(__file__ + '.arguments', 'w').write(' '.join(sys.argv[1:]))
time.sleep(60)
"""
WAIT_FOR_SERVER_THEN_END = """
import pathlib, time
while not (pathlib.Path(__file__).parent / 'gzserver.arguments').exists():
    time.sleep(0.01)
"""


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """Return a folder that replaces that of the executables."""
    monkeypatch.setattr(sys, 'argv', [str(tmp_path / 'gazebo')])
    monkeypatch.setattr(gazebo, 'display_works', lambda: True)
    monkeypatch.setattr(gazebo, '_GRACE', PATIENCE)  # a busy machine is slow to end a program
    monkeypatch.setenv('ROS_MASTER_URI', 'http://localhost:9')  # nothing answers there
    return tmp_path


def test_closing_the_window_interrupts_the_server(folder):
    (folder / 'gzserver').write_text(RUN_UNTIL_CTRL_C.format(code=7))
    (folder / 'gzclient').write_text(WAIT_FOR_SERVER_THEN_END)
    assert gazebo.main(['-u', '--verbose', 'my.world']) == 7
    assert (folder / 'gzserver.arguments').read_text() == '-u --verbose my.world'


def test_the_end_of_the_server_closes_the_window(folder):
    (folder / 'gzserver').write_text('raise SystemExit(3)')
    (folder / 'gzclient').write_text(RUN_UNTIL_CTRL_C.format(code=0))  # it would run for minutes
    assert gazebo.main([]) == 3


def test_server_keeps_running_without_a_display(folder, monkeypatch):
    monkeypatch.setattr(gazebo, 'display_works', lambda: False)
    (folder / 'gzserver').write_text('import time; time.sleep(0.5); raise SystemExit(5)')
    (folder / 'gzclient').write_text('')
    assert gazebo.main([]) == 5


@pytest.mark.parametrize('number', [signal.SIGINT, signal.SIGTERM])
def test_a_signal_right_after_the_start_ends_all_processes(folder, monkeypatch, number):
    def signalled_before_the_first_poll():
        wait_until((folder / 'gzserver.arguments').exists)
        os.kill(os.getpid(), number)
        return True

    monkeypatch.setattr(gazebo, 'display_works', signalled_before_the_first_poll)
    for name in ('gzserver', 'gzclient'):
        (folder / name).write_text(RUN_UNTIL_CTRL_C.format(code=7))
    assert gazebo.main([]) == 7
