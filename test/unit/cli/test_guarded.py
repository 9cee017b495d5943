"""A program in a child process: its exit code, its abrupt end, and signals that are passed on."""

import signal
import subprocess
import sys

import pytest

PROGRAM = """
import os, signal, sys, time
from rosbots_description.cli.guarded import guarded

def work():
    print('begun', flush=True)
    {work}

def abrupt(was_signalled):
    print('abrupt, signalled' if was_signalled else 'abrupt', flush=True)
    return 7

sys.exit(guarded(work, abrupt))
"""
WAIT = 'signal.pause()'
TRAPPED = (
    'signal.signal(signal.SIGTERM, lambda *_: os._exit(1)); print("ready", flush=True); ' + WAIT
)


def start(work):
    """Start the program; return it when `work` has begun."""
    program = subprocess.Popen(
        [sys.executable, '-c', PROGRAM.format(work=work)], stdout=subprocess.PIPE, text=True
    )
    assert program.stdout.readline() == 'begun\n'
    return program


@pytest.mark.parametrize(
    ('work', 'code', 'printed'),
    [
        ('return 0', 0, ''),
        ('return 130', 130, ''),
        ('os._exit(0)', 7, 'abrupt\n'),
        ('os.kill(os.getpid(), signal.SIGKILL)', 7, 'abrupt\n'),
    ],
)
def test_the_exit_code_is_that_of_the_work_or_of_its_abrupt_end(work, code, printed):
    program = start(work)
    assert (program.communicate()[0], program.returncode) == (printed, code)


def test_an_end_during_the_shutdown_after_a_signal_is_known_as_such():
    program = start(TRAPPED)
    assert program.stdout.readline() == 'ready\n'
    program.send_signal(signal.SIGTERM)
    assert (program.communicate()[0], program.returncode) == ('abrupt, signalled\n', 7)


def test_an_interrupt_reaches_the_work():
    program = start(f"""
    try:
        print('ready', flush=True)
        {WAIT}
    except KeyboardInterrupt:
        return 130""")
    assert program.stdout.readline() == 'ready\n'
    program.send_signal(signal.SIGINT)
    assert (program.communicate()[0], program.returncode) == ('', 130)


def test_the_work_ends_with_its_killed_program():
    program = start(WAIT)
    program.kill()
    assert program.stdout.read() == ''  # which the child would hold open
