"""Motions are shown halfway too; nothing is lost or smeared, and a slow page gets no more work."""

import threading
from itertools import count
from types import SimpleNamespace

import pytest
from support.patience import wait_until
from support.window import clock

from rosbots_description.sim.core import Pose, from_rpy
from rosbots_description.web import interpolation
from rosbots_description.web.interpolation import Interpolation, halfway


class Shown(list):
    """The motions that were shown, by a page that is as fast as the test says."""

    def __init__(self):
        super().__init__()
        self.lock = threading.RLock()
        self.by = Interpolation(self.lock, self.append)

    def wait(self, number):
        wait_until(lambda: len(self) >= number, f'{number} motions')


@pytest.fixture
def shown():
    made = Shown()
    made.by.open()
    yield made
    made.by.close()


def at(x=0.0, yaw=0.0):
    return Pose((x, 0.0, 0.0), from_rpy(0.0, 0.0, yaw))


def with_clock(monkeypatch, ticks):
    """Let the page believe in another clock."""
    monkeypatch.setattr(interpolation, 'time', SimpleNamespace(monotonic=lambda: next(ticks)))


def test_halfway_is_in_the_middle_of_places_angles_and_clocks():
    half = halfway(clock(1.0, 5.0, _1=at(1.0, 0.2)), clock(1.04, 5.1, _1=at(1.2, 0.8)))
    assert (half.time, half.real_time, half.iterations) == pytest.approx((1.02, 5.05, 1020))
    assert half.poses[1].position == pytest.approx((1.1, 0.0, 0.0))
    assert half.poses[1].orientation == pytest.approx(from_rpy(0.0, 0.0, 0.5))


def test_both_signs_of_a_quaternion_are_the_same_orientation():
    turned = Pose((0.0, 0.0, 0.0), tuple(-part for part in from_rpy(0.0, 0.0, 0.6)))
    half = halfway(clock(1.0, _1=at()), clock(1.03, _1=turned))
    assert half.poses[1].orientation == pytest.approx(from_rpy(0.0, 0.0, 0.3))


@pytest.mark.parametrize(
    ('to', 'is_jump'),
    [
        (at(0.3), False),
        (at(0.5), True),
        (at(0.0, 1.5), False),
        (at(0.0, 1.6), True),
    ],
)
def test_a_jump_is_not_smeared(to, is_jump):
    half = halfway(clock(1.0, _1=at(), _2=at()), clock(1.04, _1=to, _2=at(0.1)))
    assert half.poses.keys() == ({2} if is_jump else {1, 2})


@pytest.mark.parametrize(
    'last', [None, clock(2.0, _1=at()), clock(1.0, _1=at()), clock(0.9), clock(0.9, _2=at())]
)
def test_there_is_no_halfway_from_nowhere_nor_without_time(last):
    assert halfway(last, clock(1.0, _1=at(0.01))) is None


def test_motions_are_shown_halfway_and_then_as_they_came(shown, monkeypatch):
    with_clock(monkeypatch, iter(lambda: 0.0, None))
    shown.by.take(first := clock(1.0, _1=at()))
    shown.wait(1)
    shown.by.take(second := clock(1.04, _1=at(0.2)))
    shown.wait(3)
    assert shown == [first, halfway(first, second), second]


def test_a_slow_page_is_shown_the_newest_pose_of_each_link_and_none_halfway(shown, monkeypatch):
    with_clock(monkeypatch, count())
    shown.by.take(clock(1.0, _1=at(), _2=at()))
    shown.wait(1)
    with shown.lock:  # the page is at work
        shown.by.take(clock(1.03, _1=at(0.1), _2=at(0.1)))
        shown.by.take(clock(1.06, _1=at(0.2)))
    shown.wait(2)
    assert shown[1:] == [clock(1.06, _1=at(0.2), _2=at(0.1))]


def test_what_was_forgotten_is_not_shown(shown):
    with shown.lock:
        shown.by.take(clock(1.0, _1=at()))
        shown.by.forget()
        shown.by.take(newest := clock(0.0, _1=at(3.0)))
    shown.wait(1)
    assert shown == [newest]


def test_the_thread_ends_and_shows_nothing_more(shown):
    thread = shown.by._thread
    with shown.lock:
        shown.by.take(clock(1.0))
        shown.by.close()
    thread.join(60.0)
    assert not thread.is_alive()
    assert shown == []


def test_a_motion_that_fails_is_reported_and_the_next_one_shown(caplog):
    shown = Shown()

    def show(motion):
        shown.append(motion)
        if len(shown) == 1:
            raise RuntimeError('it broke')

    shown.by = Interpolation(shown.lock, show)
    shown.by.open()
    for number in (1, 2):
        shown.by.take(clock(float(number)))
        shown.wait(number)
    shown.by.close()
    assert 'it broke' in caplog.text
