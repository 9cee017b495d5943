"""Programs of controller_manager say in one sentence that ROS_MASTER_URI is wrong."""

import pytest

from rosbots_description.cli import controller_manager


@pytest.mark.parametrize(
    ('program', 'arguments', 'name'),
    [
        (controller_manager.spawner, ['arm'], 'spawner'),
        (controller_manager.unspawner, ['arm'], 'unspawner'),
        (controller_manager.manager, ['list'], 'controller_manager'),
        (controller_manager.group, ['list'], 'controller_group'),
    ],
)
def test_wrong_address_of_the_master_is_one_sentence(monkeypatch, capsys, program, arguments, name):
    monkeypatch.setenv('ROS_MASTER_URI', 'foo')
    assert program(arguments) == 1
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith(f"{name}: ROS_MASTER_URI is 'foo'; it must be the address of a ROS ")
