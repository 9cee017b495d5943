"""Trials of hostile input fail on what they are there for."""

import logging
import os

import numpy as np
import pytest
from support import box_urdf
from support.fuzzing import MEMORY, Fuzzer

from rosbots_description.sim import World

BOX = f'<robot name="b">{box_urdf("1 1 1", 1.0)}</robot>'


def hog():
    np.ones(2 * MEMORY // 8)  # more than it may, whatever was freed before


def stranger():
    raise KeyError('x')


def two_lines():
    logging.getLogger('rosbots').error('one\ntwo')


def traceback():
    try:
        stranger()
    except KeyError:
        logging.getLogger('rosbots').exception('it failed')


def crash():
    os.abort()


@pytest.mark.parametrize(
    ('fault', 'said'),
    [
        (hog, 'MemoryError'),
        (stranger, 'KeyError'),
        (two_lines, 'not a printable line'),
        (traceback, 'KeyError'),
        (lambda: os.write(1, b'x'), 'printed: x'),
        (crash, 'SIGABRT'),
    ],
)
def test_a_fault_fails_the_trial_and_the_next_one_begins_anew(monkeypatch, fault, said):
    with Fuzzer() as fuzzer:  # its child has the methods of now
        fuzzer.judge('model', BOX)
    run = World.run

    def faulty(world, steps):
        fault()
        return run(world, steps)

    monkeypatch.setattr(World, 'run', faulty)
    with Fuzzer() as fuzzer:
        with pytest.raises(AssertionError, match=said):
            fuzzer.judge('model', BOX)
        fuzzer.judge('model', '<robot/>')
    assert fuzzer.verdicts == {'refused': 1}


def test_a_number_that_is_not_finite_fails_the_trial(monkeypatch):
    monkeypatch.setattr('support.fuzzing._states', lambda _: [float('nan')])
    with Fuzzer() as fuzzer, pytest.raises(AssertionError, match='isfinite'):
        fuzzer.judge('model', BOX)
