"""The solver makes more iterations while a motor misses its target though it could do more."""

import pytest

from rosbots_description.sim.physics.bullet.solver_iterations import SolverEffort

LOOKS = 100


def iterations_after(*motors, looks=LOOKS):
    """Return all numbers of iterations that were set while motors did this."""
    told = []
    effort = SolverEffort(told.append)
    effort.start(11)
    for _ in range(looks):
        effort.update(motors)
    return told


@pytest.mark.parametrize('motor', [
    (0.9, 1.0, 0.5, 1.0),  # it misses its target by a tenth
    (-0.02, 0.0, 0.5, 1.0),  # it is to stand
    (1e-3, 0.0, 0.5, 1.0),  # it creeps
])
def test_a_motor_that_misses_its_target_gets_more_iterations(motor):
    assert iterations_after(motor) == [11, 44, 176]


@pytest.mark.parametrize('motor', [
    (0.99, 1.0, 0.5, 1.0),  # near enough
    (0.1, 1.0, -1.0, 1.0),  # it does what it can
    (1e-3, 1e-3, 0.5, 1.0),
    (5e-5, 0.0, 0.5, 1.0),
])
def test_a_motor_that_does_what_it_can_gets_no_more(motor):
    assert iterations_after(motor) == [11]


def test_one_look_changes_nothing():
    assert iterations_after((0.9, 1.0, 0.5, 1.0), looks=1) == [11]


def test_when_all_motors_reach_their_targets_fewer_do():
    told = []
    effort = SolverEffort(told.append)
    effort.start(11)
    for missed in (0.5, 0.0):
        for _ in range(LOOKS):
            effort.update([(1.0 - missed, 1.0, 0.1, 1.0)])
    assert told == [11, 44, 176, 44, 11]


def test_who_needs_more_iterations_gets_enough_to_miss_by_less():
    told = []
    effort = SolverEffort(told.append)
    effort.start(11)
    for missed in (0.03, 0.1, 0.03):
        for _ in range(LOOKS):
            effort.update([(1.0 - (missed if told[-1] < 176 else 0.01), 1.0, 0.1, 1.0)])
    assert told == [11, 44, 176]


def tries(effort, told, looks, target=1.0):
    """Return how often fewer iterations are tried by a motor that needs 44."""
    before = told.count(11)
    for _ in range(looks):
        effort.update([(0.9 * target if told[-1] < 44 else target, target, 0.1, 1.0)])
    return told.count(11) - before


def test_fewer_iterations_are_tried_ever_more_rarely_until_a_target_changes():
    told = []
    effort = SolverEffort(told.append)
    effort.start(11)
    first, second, third = (tries(effort, told, 400) for _ in range(3))
    assert first > second >= third
    assert second <= 2
    assert tries(effort, told, 400, 2.0) >= first - 1
