"""Commands of the page to the thread that owns a world."""

import threading

import pytest

from rosbots_description.sim import SimError
from rosbots_description.viewer.commands import WorldCommands


def test_commands_that_wait_at_the_end_and_later_ones_are_refused_at_once():
    changed = threading.Condition()
    commands, refused, done = WorldCommands(changed), [], []

    def press():
        try:
            commands.call(lambda: done.append(1), 600.0)
        except SimError as error:
            refused.append(str(error))

    thread = threading.Thread(target=press)
    thread.start()
    with changed:
        assert changed.wait_for(lambda: commands.are_waiting, 60.0)
    commands.post(lambda: done.append(2))
    commands.end()
    thread.join()
    assert len(refused) == 1
    commands.post(lambda: done.append(3))
    with pytest.raises(SimError, match='dropped'):
        commands.call(lambda: done.append(4), 600.0)
    assert done == []


def test_a_command_that_nobody_carries_out_never_begins():
    commands, done = WorldCommands(threading.Condition()), []
    with pytest.raises(SimError, match='does not run its world'):
        commands.call(lambda: done.append(1), patience=0.0)
    commands.carry_out()
    assert done == []
