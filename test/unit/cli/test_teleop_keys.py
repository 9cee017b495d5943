"""Keys to commands: the tables, the speed keys, stopping."""

import re

import pytest
from support import ROOT

from rosbots_description.cli.teleop_keys import (
    BANNER,
    BANNER_EVERY,
    MOVES,
    SPEED_STEPS,
    Driver,
    Speeds,
    Velocity,
)


def _velocity_after(keys, speeds=None):
    driver = Driver(speeds or Speeds())
    for key in keys:
        driver.press(key)
    return driver.velocity()


@pytest.mark.parametrize(
    'key, expected',
    [
        ('i', Velocity(x=0.5)),
        ('o', Velocity(x=0.5, yaw=-1.0)),
        ('u', Velocity(x=0.5, yaw=1.0)),
        ('j', Velocity(yaw=1.0)),
        ('l', Velocity(yaw=-1.0)),
        (',', Velocity(x=-0.5)),
        ('.', Velocity(x=-0.5, yaw=1.0)),
        ('m', Velocity(x=-0.5, yaw=-1.0)),
        ('I', Velocity(x=0.5)),
        ('O', Velocity(x=0.5, y=-0.5)),
        ('U', Velocity(x=0.5, y=0.5)),
        ('J', Velocity(y=0.5)),
        ('L', Velocity(y=-0.5)),
        ('<', Velocity(x=-0.5)),
        ('>', Velocity(x=-0.5, y=-0.5)),
        ('M', Velocity(x=-0.5, y=0.5)),
        ('t', Velocity(z=0.5)),
        ('b', Velocity(z=-0.5)),
    ],
)
def test_move_key_gives_its_velocity(key, expected):
    assert _velocity_after(key) == expected


def test_the_table_of_keys_is_complete():
    assert len(MOVES) == 18


@pytest.mark.parametrize('key', ['k', 'K', ' ', '\x1b', '[', 'A', '\xe4'])
def test_any_other_key_stops(key):
    assert _velocity_after(['i', key]) == Velocity()


@pytest.mark.parametrize(
    'key, linear, angular',
    [
        ('q', 0.55, 1.1),
        ('z', 0.45, 0.9),
        ('w', 0.55, 1.0),
        ('x', 0.45, 1.0),
        ('e', 0.5, 1.1),
        ('c', 0.5, 0.9),
    ],
)
def test_speed_key_scales_and_keeps_the_direction(key, linear, angular):
    velocity = _velocity_after(['u', key])
    assert (velocity.x, velocity.yaw) == pytest.approx((linear, angular))


def test_speed_key_at_standstill_does_not_move_the_robot():
    assert _velocity_after('q') == Velocity()


def test_speed_key_shows_the_speeds():
    driver = Driver()
    driver.press('q')
    assert driver.press('q') == ['currently:\tspeed 0.6050000000000001\tturn 1.2100000000000002 ']


def test_speed_keys_stop_at_the_limit_with_a_message():
    driver = Driver(Speeds(linear_limit=0.5, angular_limit=1.05))
    assert driver.press('q') == [
        'Linear speed limit reached!',
        'Angular speed limit reached!',
        'currently:\tspeed 0.5\tturn 1.05 ',
    ]
    assert driver.press('c')[0] == 'Linear speed limit reached!'


def test_starting_speed_above_the_limit_is_kept_until_a_speed_key():
    speeds = Speeds(linear=2.0, linear_limit=1.0)
    assert _velocity_after('i', speeds) == Velocity(x=2.0)
    assert _velocity_after('ix', speeds) == Velocity(x=1.0)


def test_banner_is_repeated_after_every_fifteenth_speed_key():
    driver = Driver()
    shown = [BANNER in driver.press('e') for _ in range(2 * BANNER_EVERY)]
    assert [number for number, there in enumerate(shown, 1) if there] == [15, 30]


def test_robot_is_stopped_once_when_no_key_is_pressed():
    driver = Driver()
    driver.press('i')
    assert driver.fall_silent()
    assert driver.velocity() == Velocity()
    assert not driver.fall_silent()


def test_banner_lists_every_key():
    assert all(key in BANNER for key in [*MOVES, *SPEED_STEPS])
    assert BANNER.startswith('\n') and BANNER.endswith('\n')


def test_help_and_readme_document_holding_a_key():
    for text in (BANNER, (ROOT / 'README.md').read_text(encoding='utf-8')):
        assert re.search(r'\bhold a key\b.*\blet go\b', text)
