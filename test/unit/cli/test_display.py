"""A program with a window: it needs a display, and is started again if it crashes as it opens."""

import ctypes
import ctypes.util
import signal
import subprocess
import sys
from types import SimpleNamespace

import pytest
from support.patience import PATIENCE, wait_until

from rosbots_description.cli.display import STARTS, display_works

MAIN = (
    'import os, sys; from rosbots_description.cli.display import run_window; '
    'sys.exit(run_window(sys.argv[1:], os.environ, print))'
)
# Crashes {times} times like Debian's RViz, then runs until it is ended, by {end}.
PROGRAM = """#!/bin/sh
echo >> {folder}/starts
test $(wc -l < {folder}/starts) -gt {times} || kill -{signal} $$
trap 'kill -{end} $$' INT
echo > {folder}/open
while true; do sleep 0.1; done
"""


@pytest.fixture
def window(tmp_path):
    """Return a function that starts a program with a window, which crashes as told."""

    def start(times, signal, end='KILL'):
        program = tmp_path / 'program'
        program.write_text(PROGRAM.format(folder=tmp_path, times=times, signal=signal, end=end))
        program.chmod(0o755)
        started.append(
            subprocess.Popen([sys.executable, '-c', MAIN, program], stdout=-1, text=True)
        )
        return started[0]

    started = []
    yield start
    for process in started:
        process.kill()
        process.communicate()


def close(process, folder):
    """Close the window when it is open; return what was said."""
    wait_until(lambda: (folder / 'open').exists() or process.poll() is not None)
    process.send_signal(signal.SIGTERM)
    output, _ = process.communicate(timeout=PATIENCE)
    assert process.returncode == 0
    return output.splitlines()


def count_starts(folder):
    return len((folder / 'starts').read_text().splitlines())


@pytest.mark.parametrize(('number', 'times'), [('SEGV', 1), ('ABRT', STARTS - 1)])
def test_program_that_crashes_as_it_opens_is_restarted(window, tmp_path, number, times):
    said = close(window(times, number), tmp_path)
    assert count_starts(tmp_path) == times + 1
    assert said == [f'crashed as it opened (SIG{number}); restarting it'] * times


def test_restarts_of_a_crashing_program_are_limited(window, tmp_path):
    process = window(99, 'SEGV')
    output, _ = process.communicate(timeout=PATIENCE)
    assert (process.returncode, count_starts(tmp_path)) == (128 + signal.SIGSEGV, STARTS)
    assert output.splitlines()[-1] == (
        f'crashed as it opened (SIGSEGV); no window after {STARTS} starts'
    )


def test_program_that_the_user_closes_is_not_restarted(window, tmp_path):
    process = window(9, 'KILL')
    output, _ = process.communicate(timeout=PATIENCE)
    assert (process.returncode, count_starts(tmp_path), output) == (128 + signal.SIGKILL, 1, '')


@pytest.mark.parametrize(
    ('end', 'said'), [('ABRT', ['crashed as it was closed (SIGABRT)']), ('KILL', [])]
)
def test_program_that_crashes_as_it_is_closed_is_reported_and_not_restarted(
    window, tmp_path, end, said
):
    assert close(window(0, 'SEGV', end), tmp_path) == said
    assert count_starts(tmp_path) == 1


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
