"""Suppressed output of C code."""

import os

from rosbots_description.sim.physics.bullet.silence import silent


def test_only_output_within_is_lost_and_later_output_is_on_its_own_stream(capfd):
    with silent():
        os.write(1, b'lost')
        os.write(2, b'lost')
    os.write(1, b'result')
    os.write(2, b'warning')
    assert capfd.readouterr() == ('result', 'warning')
