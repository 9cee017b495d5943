"""The integral action of motors on a plant of first order, as the solver makes it."""

import pytest

from rosbots_description.sim.physics.bullet.integral_action import AT_REST, Integral, integral

LOOKS = 1000


def speeds(lag, loads, before=AT_REST, target=1.0):
    """Return the velocity at each look.

    Args:
        lag: share of an error that remains after the time between two looks.
        loads: velocity error without integral action, at each look.
    """
    found, velocity = [], 0.0
    for load in loads:
        velocity = lag * velocity + (1.0 - lag) * (target + before.offset - load)
        before = integral(before, target, velocity, 0.5)
        found.append(velocity)
    return found


@pytest.mark.parametrize('lag', [0.0, 0.1, 0.3, 0.5, 0.7, 0.8, 0.9, 0.95, 0.97])
@pytest.mark.parametrize('load', [0.0, 0.05, 0.1, 0.14])
@pytest.mark.parametrize('target', [1.0, -2.0])
def test_a_step_is_followed_without_overshoot_and_ringing(lag, load, target):
    found = [one / target for one in speeds(lag, [load * target] * LOOKS, target=target)]
    assert max(found) < 1.03
    peak = max(range(LOOKS), key=found.__getitem__)
    assert 1.0 - min(found[peak:]) < max(max(found) - 1.0, 0.001)
    assert all(abs(one - 1.0) < 0.005 for one in found[LOOKS // 2 :])


def test_each_look_halves_the_error_of_a_quick_plant():
    found = speeds(0.0, [0.02] * 6)
    errors = [1.0 - velocity for velocity in found[1:]]
    assert errors == pytest.approx([0.02 / 2**k for k in range(5)])


def test_an_offset_goes_with_its_load():
    found = speeds(0.0, [0.1] * 20 + [0.0] * 5)
    assert found[20] == pytest.approx(1.1, abs=0.001)
    assert found[21:] == pytest.approx([1.0] * 4)


SEEN = Integral(1.0, 0.02, 0.1)  # an error of 0.02 has lasted for a look


@pytest.mark.parametrize(
    ('before', 'target', 'velocity', 'load', 'offset'),
    [
        (SEEN, 1.0, 0.98, 0.5, 0.11),
        (SEEN, 1.1, 1.08, 0.5, 0.1),  # the target has changed
        (SEEN, 1.0, 0.98, 0.991, 0.1),  # saturated
        (SEEN, 1.0, 0.98, -0.991, 0.1),
        (SEEN, 1.0, 0.98, 0.989, 0.11),
        (SEEN, 1.0, 0.9996, 0.5, 0.1),  # as good as none
        (SEEN, 1.0, 0.9994, 0.5, 0.1003),
        (Integral(1.0, 0.001, 0.1), 1.0, 0.5, 0.5, 0.1005),  # an impact
        (Integral(1.0, -0.001, 0.1), 1.0, 0.98, 0.5, 0.1),  # of the other sign before
        (Integral(1.0, 0.2, 0.1), 1.0, 0.81, 0.5, 0.1),  # the error shrinks by itself
        (Integral(1.0, 0.2, 0.1), 1.0, 0.803, 0.5, 0.1985),  # hardly
        (SEEN, 1.0, 1.049, 0.5, 0.1),  # too fast, by less than half of the offset
        (SEEN, 1.0, 1.051, 0.5, 0.0),  # by more: its load is gone
        (Integral(1.0, 0.9, 1.1), 1.0, 0.1, 0.5, 1.15),  # its limit
        (Integral(-1.0, -0.9, -1.1), -1.0, -0.1, 0.5, -1.15),
        (Integral(4.0, 0.1, 1.55), 1.0, 0.9, 0.5, 1.15),  # of the new target
    ],
)
def test_what_a_look_changes(before, target, velocity, load, offset):
    now = integral(before, target, velocity, load)
    assert now == pytest.approx((target, target - velocity, offset))
