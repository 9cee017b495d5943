"""The window as a process: it reads no robot's TF, prints little, and ends on request."""

import ctypes
import ctypes.util
import os
import signal
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import pytest
import yaml
from support import ROOT
from support.patience import PATIENCE, wait_until

from rosbots_description.cli.gzclient import (
    STARTS,
    config_file,
    display_works,
    rviz_environment,
)

WINDOW = """#!/bin/sh
echo $$ "$@" > {folder}/arguments
exec sleep 60
"""
MAIN = (
    'import sys; from rosbots_description.cli import gzclient; '
    'gzclient.display_works = lambda: True; sys.exit(gzclient.main(sys.argv[1:]))'
)


# Crashes {times} times like Debian's RViz, then runs until it is ended.
CRASHES = """#!/bin/sh
echo >> {folder}/starts
test $(wc -l < {folder}/starts) -gt {times} && exec sleep 60
kill -{signal} $$
"""


def open_window(folder, text):
    """Start gzclient with a program of this text instead of RViz."""
    program = folder / 'rviz'
    program.write_text(text)
    program.chmod(0o755)
    return subprocess.Popen(
        [sys.executable, '-c', MAIN, '--verbose', '__name:=gazebo_gui'],
        env={
            **os.environ,
            'PATH': f'{folder}:{os.environ["PATH"]}',
            'ROS_MASTER_URI': 'http://127.0.0.1:1',
        },
        stderr=subprocess.PIPE,
        text=True,
    )


def count_starts(folder):
    starts = folder / 'starts'
    return len(starts.read_text().splitlines()) if starts.exists() else 0


def is_running(process):
    """Tell whether a process runs; a zombie, which nobody has reaped yet, does not."""
    try:
        return ' Z ' not in Path('/proc', process, 'stat').read_text()
    except (FileNotFoundError, ProcessLookupError):
        return False


@pytest.fixture
def window(tmp_path):
    """Return a gzclient with a program instead of RViz, and that program's PID and arguments."""
    process = open_window(tmp_path, WINDOW.format(folder=tmp_path))
    try:
        arguments = tmp_path / 'arguments'
        wait_until(lambda: arguments.exists() and arguments.read_text())
        yield process, arguments.read_text().split()
    finally:
        process.kill()
        process.wait()


def test_window_has_its_own_tf_topics_and_ends_on_request(window):
    process, words = window
    assert {'/tf:=gazebo/view/tf', '/tf_static:=gazebo/view/frames', '__name:=gazebo_gui'} <= set(
        words
    )
    process.send_signal(signal.SIGTERM)
    assert process.wait(PATIENCE) == 0


def test_window_ends_when_its_parent_is_killed(window):
    process, words = window
    process.kill()
    process.wait()
    wait_until(lambda: not is_running(words[0]))


@pytest.mark.parametrize(('number', 'times'), [('SEGV', 1), ('ABRT', STARTS - 1)])
def test_rviz_that_crashes_at_its_start_is_restarted(tmp_path, number, times):
    process = open_window(tmp_path, CRASHES.format(folder=tmp_path, signal=number, times=times))
    wait_until(lambda: count_starts(tmp_path) > times or process.poll() is not None)
    assert process.poll() is None
    process.send_signal(signal.SIGTERM)
    _, output = process.communicate(timeout=PATIENCE)
    assert process.returncode == 0
    assert (
        output.splitlines()
        == [f'gzclient: RViz crashed as it opened (SIG{number}); restarting it'] * times
    )


def test_restarts_of_a_crashing_rviz_are_limited(tmp_path):
    process = open_window(tmp_path, CRASHES.format(folder=tmp_path, signal='SEGV', times=99))
    _, output = process.communicate(timeout=PATIENCE)
    assert (process.returncode, count_starts(tmp_path)) == (128 + signal.SIGSEGV, STARTS)
    assert output.splitlines()[-1] == (
        f'gzclient: RViz crashed as it opened (SIGSEGV); no window after {STARTS} starts'
    )


def test_rviz_that_the_user_closes_is_not_restarted(tmp_path):
    process = open_window(tmp_path, CRASHES.format(folder=tmp_path, signal='KILL', times=9))
    _, output = process.communicate(timeout=PATIENCE)
    assert (process.returncode, count_starts(tmp_path), output) == (128 + signal.SIGKILL, 1, '')


def test_rviz_gets_default_folder_and_log_levels_unless_the_user_sets_them(tmp_path, monkeypatch):
    monkeypatch.setattr('tempfile.tempdir', str(tmp_path))
    made = rviz_environment({}, Path('/levels'))
    assert made['ROSCONSOLE_CONFIG_FILE'] == '/levels'
    assert Path(made['XDG_RUNTIME_DIR']).stat().st_mode & 0o777 == 0o700
    given = {'XDG_RUNTIME_DIR': '/run/user/1', 'ROSCONSOLE_CONFIG_FILE': '/mine'}
    assert rviz_environment(given, Path('/levels')) == given


def test_the_layouts_have_time_displays_and_views_and_the_window_can_follow_a_model():
    for path in (config_file(), *(ROOT / 'config').glob('*.rviz')):
        layout = yaml.safe_load(path.read_text())
        assert {panel['Name'] for panel in layout['Panels']} == {'Displays', 'Views', 'Time'}
        assert layout['Window Geometry']['Time'] == {'collapsed': False}
    shown = yaml.safe_load(config_file().read_text())['Visualization Manager']
    red, _, blue = map(int, shown['Global Options']['Background Color'].split(';'))
    assert blue > red > 100  # light blue
    views = shown['Views']
    assert views['Current']['Pitch'] > 0.3  # [rad], from above
    assert views['Saved'][0]['Target Frame'] == 'rosbots'


def link_to_a_folder(path, tmp_path):
    (tmp_path / 'elsewhere').mkdir()
    path.symlink_to(tmp_path / 'elsewhere')


def folder_of_another_user(path, _tmp_path):
    if os.getuid():
        pytest.skip('only root gives folders to other users')
    path.mkdir()
    os.chown(path, 65534, 65534)


@pytest.mark.parametrize(
    'plant', [link_to_a_folder, folder_of_another_user, lambda path, _: path.touch()]
)
def test_planted_runtime_folder_is_not_used(tmp_path, monkeypatch, plant):
    monkeypatch.setattr('tempfile.tempdir', str(tmp_path))
    plant(tmp_path / f'rosbots-runtime-{os.getuid()}', tmp_path)
    assert 'XDG_RUNTIME_DIR' not in rviz_environment({}, Path('/levels'))


def test_runtime_folder_is_made_private(tmp_path, monkeypatch):
    monkeypatch.setattr('tempfile.tempdir', str(tmp_path))
    (tmp_path / f'rosbots-runtime-{os.getuid()}').mkdir(mode=0o777)
    made = Path(rviz_environment({}, Path('/levels'))['XDG_RUNTIME_DIR'])
    assert made.stat().st_mode & 0o777 == 0o700


@pytest.mark.parametrize(
    ('variable', 'library', 'opened', 'works'),
    [
        (':0', 'libX11.so.6', 0x7F0000001234, True),
        (':0', 'libX11.so.6', None, False),
        (':0', None, 1, False),
        ('', 'libX11.so.6', 1, False),
    ],
)
def test_display_works_if_x11_opens_it(monkeypatch, variable, library, opened, works):
    closed = []

    def open_display(_name):
        return opened

    x11 = SimpleNamespace(
        XOpenDisplay=open_display, XCloseDisplay=lambda display: closed.append(display.value)
    )
    monkeypatch.setenv('DISPLAY', variable)
    monkeypatch.setattr(ctypes.util, 'find_library', lambda name: library)
    monkeypatch.setattr(ctypes, 'CDLL', {library: x11}.__getitem__)
    assert display_works() == works
    if works:
        assert open_display.restype is ctypes.c_void_p  # an address has 64 bits
    assert closed == ([opened] if works else [])  # no connection is left open
