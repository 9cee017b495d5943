"""The solver makes more iterations while a motor misses its target though it could do more."""

import pytest

from rosbots_description.sim.solver_effort import SolverEffort

LOOKS = 100


def iterations_after(*motors, looks=LOOKS):
    """Return all numbers of iterations that were set while motors did this."""
    told = []
    effort = SolverEffort(told.append)
    effort.start(11)
    for _ in range(looks):
        effort.look(motors)
    return told


@pytest.mark.parametrize('motor', [
    (0.9, 1.0, 0.5, 1.0),  # it misses its target by a tenth
    (-0.02, 0.0, 0.5, 1.0),  # it is to stand
])
def test_a_motor_that_misses_its_target_gets_more_iterations(motor):
    assert iterations_after(motor) == [11, 44, 176]


@pytest.mark.parametrize('motor', [
    (0.99, 1.0, 0.5, 1.0),  # near enough
    (0.1, 1.0, -1.0, 1.0),  # it does what it can
    (1e-4, 0.0, 0.5, 1.0),
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
            effort.look([(1.0 - missed, 1.0, 0.1, 1.0)])
    assert told == [11, 44, 176, 44, 11]
