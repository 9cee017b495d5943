"""Which joints are at a stop."""

import math
from types import SimpleNamespace

import pytest

from rosbots_description.sim.physics.bullet import stop_reaction


@pytest.mark.parametrize(
    ('limits', 'position', 'expected'),
    [
        ((-1.0, 2.0), -1.0, True),
        ((-1.0, 2.0), 2.0, True),
        ((-1.0, 2.0), -1.01, True),  # pressed into the stop
        ((-1.0, 2.0), -0.99, False),
        ((-1.0, 2.0), 1.99, False),
        ((0.0, 0.0), 0.0, True),  # cannot move at all
        ((0.0, -1.0), 0.0, False),  # without limits, as PyBullet reports them
        ((-math.inf, math.inf), 9.0, False),
    ],
)
def test_a_joint_is_at_its_stop_at_or_beyond_a_limit(monkeypatch, limits, position, expected):
    joint = SimpleNamespace(
        getJointInfo=lambda *_: (*[None] * 8, *limits), getJointState=lambda *_: (position,)
    )
    monkeypatch.setattr(stop_reaction, 'pybullet', joint)
    assert stop_reaction.is_at_stop(0, 1, 2) is expected
