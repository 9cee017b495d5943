"""Comparisons with recordings fail: on a difference, and on an exception that is not needed."""

import pytest
from support.recorded import Difference, Known, exceeded

OFF = Difference('slope', 'b::link place', 'm', 1.0, 1.3, 0.1)  # three times the tolerance
NEAR = Difference('slope', 'b::link place', 'm', 1.0, 1.05, 0.1)
STILL = NEAR._replace(reference='mechanics')
SLIPS = STILL._replace(ours=2.0)


def known(limit):
    return Known('slope', 'b::link place', limit, 'it slips by 0.3 m')


@pytest.mark.parametrize(('differences', 'exceptions', 'said'), [
    ([NEAR], [], ''),
    ([OFF], [], '   3.00  slope'),
    ([OFF], [known(3.1)], ''),
    ([OFF], [known(2.9)], '   3.00  slope'),
    ([OFF], [known(30.0)], 'a limit of 30 is too wide'),
    ([OFF], [known(float('inf'))], ''),
    ([NEAR], [known(1.1)], 'met without an exception'),
    ([NEAR], [known(float('inf'))], 'met without an exception'),
    ([OFF, STILL], [], ''),
    ([NEAR, STILL], [], 'met without an exception'),
    ([OFF, SLIPS], [], '  10.00  slope'),
    ([OFF._replace(quantity='b::link spin')], [known(3.1)], '   3.00  slope'),
    ([NEAR._replace(quantity='b::link spin')], [known(3.1)], 'no such quantity'),
    ([NEAR._replace(scene='push')], [known(3.1)], ''),
])  # fmt: skip
def test_differences_and_needless_exceptions_are_reported(differences, exceptions, said):
    lines = exceeded(differences, exceptions)
    assert bool(lines) == bool(said)
    assert ''.join(lines).startswith(said)


def test_rebounds_replace_place_and_velocity():
    rebound = STILL._replace(quantity='b::link rebound')
    assert rebound.replaces == ('b::link place', 'b::link velocity')
    assert exceeded([OFF, OFF._replace(quantity='b::link velocity'), rebound]) == []


@pytest.mark.parametrize(
    ('gazebo', 'mechanics', 'ours', 'off'),
    [
        (1.0, 1.1, 1.05, 0.0),
        (1.1, 1.0, 1.0, 0.0),
        (1.0, 1.1, 1.13, 0.03),
        (1.1, 1.0, 0.98, -0.02),
        (-1.0, -1.1, -1.13, -0.03),
        (1.0, None, 1.02, 0.02),
        (1.0, None, 0.9, -0.1),
    ],
)
def test_a_speed_is_compared_with_the_interval_between_gazebo_and_mechanics(
    gazebo, mechanics, ours, off
):
    one = Difference('drive', 'v', 'm/s', gazebo, ours, 0.03, mechanics=mechanics)
    assert one.off == pytest.approx(off, abs=1e-12)
    assert one.share == pytest.approx(abs(off) / 0.03, abs=1e-9)
