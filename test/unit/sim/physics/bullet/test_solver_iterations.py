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


@pytest.mark.parametrize(
    'motor',
    [
        (0.9, 1.0, 0.5, 1.0),  # misses its target by 10 %
        (-0.02, 0.0, 0.5, 1.0),  # the target is zero
        (1e-3, 0.0, 0.5, 1.0),  # creeps at target zero
    ],
)
def test_motor_that_misses_its_target_raises_the_iterations(motor):
    assert iterations_after(motor) == [11, 44, 176]


@pytest.mark.parametrize(
    'motor',
    [
        (0.99, 1.0, 0.5, 1.0),  # within the tolerance
        (0.1, 1.0, -1.0, 1.0),  # saturated
        (1e-3, 1e-3, 0.5, 1.0),
        (5e-5, 0.0, 0.5, 1.0),
    ],
)
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


def started(least=11):
    """Return an effort with that least number of iterations, and the list of those it sets."""
    set_counts = []
    effort = SolverEffort(set_counts.append)
    effort.start(least)
    return effort, set_counts


def changed_after(effort, set_counts, motor):
    """Return how many checks of a motor it takes until the iterations change."""
    before = len(set_counts)
    for check in range(1, 1000):
        effort.update([motor])
        if len(set_counts) > before:
            return check
    raise AssertionError('the iterations do not change')


def settled(errors, looks=200):
    """Return the iterations set for a motor whose relative error depends on them."""
    effort, set_counts = started()
    for _ in range(looks):
        effort.update([(1.0 - errors[set_counts[-1]], 1.0, 0.1, 1.0)])
    return set_counts


@pytest.mark.parametrize(
    ('errors', 'expected'),
    [
        ({11: 0.039}, [11]),
        ({11: 0.041, 44: 0.0145}, [11, 44]),  # 4 %
        ({11: 0.041, 44: 0.0155, 176: 0.0155}, [11, 44, 176]),  # 1.5 %
        ({11: 0.1, 44: 0.0095}, [11, 44]),
        ({11: 0.03, 44: 0.0085}, [11]),
    ],
)
def test_iterations_are_raised_above_4_and_15_and_lowered_below_09_percent(errors, expected):
    assert settled(errors) == expected


def test_iterations_are_lowered_within_09_percent():
    effort, set_counts = started()
    for error in (0.1, 0.0085):
        for _ in range(20):
            effort.update([(1.0 - (error if set_counts[-1] < 176 else 0.0), 1.0, 0.1, 1.0)])
    assert set_counts[-1] == 11


@pytest.mark.parametrize(
    ('velocity', 'target', 'is_missed'),
    [
        # Targets below 0.05 rad/s count as 0.05 rad/s, and 0 as 0.0025 rad/s.
        (0.02 - 0.039 * 0.05, 0.02, False),
        (0.02 - 0.041 * 0.05, 0.02, True),
        (-0.02 + 0.041 * 0.05, -0.02, True),
        (0.1 - 0.039 * 0.1, 0.1, False),
        (0.039 * 0.0025, 0.0, False),
        (-0.041 * 0.0025, 0.0, True),
    ],
)
def test_errors_are_relative_to_the_target(velocity, target, is_missed):
    assert (len(iterations_after((velocity, target, 0.1, 1.0))) > 1) == is_missed


@pytest.mark.parametrize('sign', [1.0, -1.0])
@pytest.mark.parametrize(('share', 'is_missed'), [(0.989, True), (0.991, False), (1.0, False)])
def test_a_motor_within_one_percent_of_its_limit_is_saturated(share, is_missed, sign):
    motor = (0.5, 1.0, sign * share * 20.0, 20.0)
    assert (len(iterations_after(motor)) > 1) == is_missed


def test_the_motor_with_the_greatest_error_decides():
    assert iterations_after((1.0, 1.0, 0.1, 1.0), (0.9, 1.0, 0.1, 1.0)) == [11, 44, 176]
    assert iterations_after() == [11]


@pytest.mark.parametrize(('error', 'looks'), [(0.21, 1), (0.19, 2), (0.105, 3)])
def test_a_sample_counts_a_fifth_in_the_mean(error, looks):
    motor = (1.0 - error, 1.0, 0.1, 1.0)
    assert iterations_after(motor, looks=looks - 1) == [11]
    assert iterations_after(motor, looks=looks) == [11, 44]


def test_a_jammed_motor_counts_no_more_than_one_that_stands():
    def looks_until_lowered(velocity):
        effort, set_counts = started()
        for _ in range(LOOKS):
            effort.update([(velocity, 1.0, 0.1, 1.0)])
        return changed_after(effort, set_counts, (1.0, 1.0, 0.1, 1.0))

    assert looks_until_lowered(-99.0) == looks_until_lowered(0.0)


def waits(effort, set_counts, tries, target=1.0):
    """Return the checks from each raise to the next attempt, of a motor that needs 44."""
    found = []
    while len(found) < tries:
        before = set_counts[-1]
        needed = changed_after(
            effort, set_counts, (0.9 * target if before < 44 else target, target, 0.1, 1.0)
        )
        assert set_counts[-1] in (11, 44)
        if before == 44:
            found.append(needed)
    return found


def test_the_wait_doubles_up_to_256_checks_and_starts_anew_with_another_target():
    effort, set_counts = started()
    assert waits(effort, set_counts, 8) == [5, 9, 17, 33, 65, 129, 257, 257]
    effort.update([(0.9, 1.0, 0.1, 1.0)] * 2)
    assert waits(effort, set_counts, 3, 2.0)[1:] == [9, 17]


def test_another_target_ends_a_long_wait():
    effort, set_counts = started()
    waits(effort, set_counts, 7)
    changed_after(effort, set_counts, (0.9, 1.0, 0.1, 1.0))
    assert waits(effort, set_counts, 1, 2.0) == [5]


def test_a_start_forgets_level_error_and_wait():
    effort, set_counts = started()
    waits(effort, set_counts, 4)
    effort.start(20)
    assert set_counts[-1] == 20
    effort.update([(0.81, 1.0, 0.1, 1.0)])
    assert set_counts[-1] == 20
    set_counts.clear()
    effort.start(11)
    assert waits(effort, set_counts, 2) == [5, 9]


def test_a_restored_state_goes_on_as_the_saved_one():
    effort, set_counts = started()
    waits(effort, set_counts, 3)
    changed_after(effort, set_counts, (0.9, 1.0, 0.1, 1.0))
    saved = effort.save_state()
    expected = waits(effort, set_counts, 2)
    other, other_counts = started(5)
    other.restore_state(saved)
    assert other_counts == [5, 44]
    assert waits(other, other_counts, 2) == expected
