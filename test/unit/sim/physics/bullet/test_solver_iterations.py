"""The solver runs more iterations while an unsaturated motor misses its target."""

import pytest

from rosbots_description.sim.physics.bullet.solver_iterations import SolverEffort

LOOKS = 100


def iterations_after(*motors, looks=LOOKS):
    """Return all iteration counts that were set with these motors."""
    set_counts = []
    effort = SolverEffort(set_counts.append)
    effort.start(11)
    for _ in range(looks):
        effort.update(motors)
    return set_counts


@pytest.mark.parametrize('motor', [
    (0.9, 1.0, 0.5, 1.0),  # misses its target by 10 %
    (-0.02, 0.0, 0.5, 1.0),  # the target is zero
    (1e-3, 0.0, 0.5, 1.0),  # creeps at target zero
])
def test_motor_that_misses_its_target_raises_the_iterations(motor):
    assert iterations_after(motor) == [11, 44, 176]


@pytest.mark.parametrize('motor', [
    (0.99, 1.0, 0.5, 1.0),  # within the tolerance
    (0.1, 1.0, -1.0, 1.0),  # saturated
    (1e-3, 1e-3, 0.5, 1.0),
    (5e-5, 0.0, 0.5, 1.0),
])
def test_saturated_motor_does_not_raise_the_iterations(motor):
    assert iterations_after(motor) == [11]


def test_one_sample_changes_nothing():
    assert iterations_after((0.9, 1.0, 0.5, 1.0), looks=1) == [11]


def test_iterations_are_lowered_when_all_motors_reach_their_targets():
    set_counts = []
    effort = SolverEffort(set_counts.append)
    effort.start(11)
    for missed in (0.5, 0.0):
        for _ in range(LOOKS):
            effort.update([(1.0 - missed, 1.0, 0.1, 1.0)])
    assert set_counts == [11, 44, 176, 44, 11]


def test_iterations_are_raised_until_the_error_is_small():
    set_counts = []
    effort = SolverEffort(set_counts.append)
    effort.start(11)
    for missed in (0.03, 0.1, 0.03):
        for _ in range(LOOKS):
            effort.update([(1.0 - (missed if set_counts[-1] < 176 else 0.01), 1.0, 0.1, 1.0)])
    assert set_counts == [11, 44, 176]


def tries(effort, set_counts, looks, target=1.0):
    """Return how often fewer iterations are tried for a motor that needs 44."""
    before = set_counts.count(11)
    for _ in range(looks):
        effort.update([(0.9 * target if set_counts[-1] < 44 else target, target, 0.1, 1.0)])
    return set_counts.count(11) - before


def test_attempts_with_fewer_iterations_become_rarer_until_a_target_changes():
    set_counts = []
    effort = SolverEffort(set_counts.append)
    effort.start(11)
    first, second, third = (tries(effort, set_counts, 400) for _ in range(3))
    assert first > second >= third
    assert second <= 2
    assert tries(effort, set_counts, 400, 2.0) >= first - 1
