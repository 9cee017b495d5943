"""The scene comes in the order in which it was sent, though by two topics."""

from rosbots_description.ros_api.window.view import EARLY, InOrder
from rosbots_description.sim.core import Pose
from rosbots_description.sim.description import SceneChange, ShownLink, ShownModel, ShownMotion


def change(*numbers, reset=False):
    links = tuple(ShownLink(number, f'link{number}', Pose()) for number in numbers)
    return SceneChange(reset, (ShownModel('a', links),) if links else ())


def motion(time, *numbers):
    return ShownMotion(time, time, 0, True, dict.fromkeys(numbers, Pose((time, 0.0, 0.0))))


class Shown(list):
    def __init__(self):
        super().__init__()
        self.order = InOrder(self.append, self.append)
        self.order.change(change(reset=True))
        self.clear()


def test_changes_for_others_before_the_whole_scene_are_left_out():
    shown = []
    order = InOrder(shown.append, shown.append)
    order.change(change(7))
    assert shown == []
    order.change(whole := change(8, reset=True))
    order.change(further := change(9))
    assert shown == [whole, further]


def test_motion_waits_for_the_change_that_brings_its_links():
    shown = Shown()
    first, early, clock, second = change(0, 1), motion(1.0, 2), motion(2.0), change(2)
    for one in (first, second):
        shown.order.change(one)
        if one is first:
            shown.order.motion(early)
            shown.order.motion(clock)
            assert shown == [first]
    assert shown == [first, second, clock.after(early)]
    shown.order.motion(late := motion(3.0, 0, 2))
    assert shown[-1] == late


def test_motion_waits_for_the_right_one_of_two_changes():
    shown = Shown()
    shown.order.motion(early := motion(1.0, 5))
    shown.order.change(change(0, 1))
    assert early not in shown
    shown.order.change(change(5))
    assert shown[-1] is early


def test_removal_and_clock_wait_for_nothing():
    shown = Shown()
    shown.order.change(change())
    shown.order.motion(clock := motion(1.0))
    assert shown == [change(), clock]


def test_restarted_simulator_numbers_its_links_anew():
    shown = Shown()
    shown.order.change(change(7, reset=True))
    shown.order.change(change(0, reset=True))
    shown.order.motion(early := motion(1.0, 1))
    assert early not in shown
    shown.order.change(change(reset=True))
    shown.order.motion(motion(2.0))
    assert early not in shown


def test_motions_that_wait_become_one_for_each_change():
    shown = Shown()
    for time in range(3):
        shown.order.motion(motion(float(time), 0))
    shown.order.motion(motion(3.0, 0, 1))
    shown.order.motion(motion(4.0, 0))
    shown.order.change(change(0))
    assert shown[1:] == [motion(2.0, 0)]
    shown.order.change(change(1))
    assert shown[3].time == 4.0
    assert [pose.position[0] for pose in shown[3].poses.values()] == [4.0, 3.0]


def test_simulator_that_sends_no_scene_fills_no_memory():
    shown = Shown()
    for number in range(2 * EARLY):
        shown.order.motion(motion(float(number), number))
    shown.order.change(change(*range(2 * EARLY)))
    assert len(shown) == 1 + EARLY
    assert len(shown[-1].poses) == 1 + EARLY
