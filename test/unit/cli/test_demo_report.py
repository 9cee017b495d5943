"""The demo's evaluation of drives with known results."""

import math

import pytest

from rosbots_description.cli.demo_report import (
    DRIVE,
    SETTLING,
    MeanMotion,
    Row,
    Segment,
    complaint,
    expected_motion,
    real_time_factor,
    steady_motion,
    table,
)
from rosbots_description.ros_api.clients.planar_sample import PlanarSample


def circle(speed, turn_rate, duration=3.0, step=0.05, heading=3.0):
    """Return samples of a drive along an exact circle, twice as fast as real time."""
    samples = []
    for i in range(round(duration / step) + 1):
        t = i * step
        yaw = heading + turn_rate * t
        radius = speed / turn_rate
        samples.append(
            PlanarSample(
                100.0 + t,
                7.0 + t / 2,
                radius * (math.sin(yaw) - math.sin(heading)),
                radius * (math.cos(heading) - math.cos(yaw)),
                math.remainder(yaw, math.tau),
            )
        )
    return samples


def test_steady_motion_on_a_circle_is_exact_where_yaw_wraps():
    motion = steady_motion(circle(0.5, 0.8))
    # the chord is shorter than the arc by (step angle)^2 / 24
    assert motion.speed == pytest.approx(0.5, rel=1e-4)
    assert motion.turn_rate == pytest.approx(0.8, rel=1e-9)


def test_backward_speed_and_clockwise_rate_are_negative():
    motion = steady_motion(circle(-0.3, -0.6))
    assert motion.speed == pytest.approx(-0.3, rel=1e-4)
    assert motion.turn_rate == pytest.approx(-0.6, rel=1e-9)


def test_steady_motion_leaves_out_the_ramp():
    still = [PlanarSample(t, t, 0.0, 0.0, 0.0) for t in (0.0, 0.5, SETTLING - 0.01)]
    moving = [PlanarSample(SETTLING + t, SETTLING + t, 0.4 * t, 0.0, 0.0) for t in (0.0, 1.0, 2.0)]
    assert steady_motion(still + moving).speed == pytest.approx(0.4)


def test_steady_motion_of_too_few_samples_is_an_error():
    with pytest.raises(ValueError, match='1 of 2 samples'):
        steady_motion([PlanarSample(t, t, t, 0.0, 0.0) for t in (0.0, 5.0)])


def test_real_time_factor_is_simulated_by_wall_time():
    assert real_time_factor(circle(0.5, 0.5)) == pytest.approx(2.0)


def test_expected_motion_comes_from_the_true_geometry():
    expected = expected_motion(Segment('arc', 0.5, -1.0, 2.0))
    assert expected.speed == pytest.approx(0.4423, abs=1e-4)
    assert expected.turn_rate == pytest.approx(-1.1058, abs=1e-4)


@pytest.mark.parametrize(
    ('name', 'speed', 'turn_rate'),
    [
        ('straight', 0.4373, -0.0053),
        ('arc', 0.4177, 0.5313),
        ('turn', -0.0311, 1.0711),
        ('stop', 0.0, 0.0),
    ],
)
def test_motion_measured_in_gazebo_gives_no_warning(name, speed, turn_rate):
    segment = next(segment for segment in DRIVE if segment.name == name)
    motion = MeanMotion(speed, turn_rate)
    assert complaint(Row(segment, motion, motion, 1.0)) is None


@pytest.mark.parametrize(
    'truth',
    [
        MeanMotion(0.0, 0.0),
        MeanMotion(-0.44, 0.55),
        MeanMotion(0.44, -0.55),
    ],
)
def test_standing_still_and_wrong_signs_are_reported(truth):
    segment = Segment('arc', 0.5, 0.5, 4.0)
    assert 'part "arc"' in complaint(Row(segment, truth, truth, 1.0))


def test_table_has_a_line_for_each_segment_with_its_numbers_in_order():
    rows = [Row(DRIVE[0], MeanMotion(0.4401, -0.0002), MeanMotion(0.4312, 0.0123), 0.9987)]
    lines = table(rows).splitlines()
    assert len(lines) == 3
    assert lines[2].split() == [
        'straight',
        '3.0',
        's',
        '0.50',
        '0.00',
        '0.440',
        '0.000',
        '0.431',
        '0.012',
        '0.999',
    ]
    assert len({len(line) for line in lines}) == 1
