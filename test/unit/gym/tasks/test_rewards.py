"""Where the tasks place the robot, and what they reward, on a stage without physics."""

import math
from types import SimpleNamespace

import numpy as np
import pytest
from lxml import etree
from support import LIBRARY

from rosbots_description.gym.tasks.follow_line import FollowLine
from rosbots_description.gym.tasks.go_to_goal import GoToGoal
from rosbots_description.gym.tasks.maze import Maze
from rosbots_description.gym.tasks.wander import Wander
from rosbots_description.sim import Pose, from_rpy
from rosbots_description.sim.description import Box


class Stage:
    """A robot that is where it is placed, and touches what it is told to."""

    time = 0.0

    def __init__(self):
        self.pose, self.touches, self.free = (0.0, 0.0, 0.0), False, []

    def place(self, pose):
        self.pose = pose

    def place_freely(self, _random, *ranges):
        self.ranges = ranges
        self.place(self.free.pop(0))
        return self.pose

    def bumps(self):
        return self.touches


def stands(task, x, y, yaw=0.0):
    """Return reward and end of an episode's step that leads there."""
    task._stage.place((x, y, yaw))
    return task.score({}, None)


def made(kind):
    task = object.__new__(kind)
    task._stage = Stage()
    task._np_random = np.random.default_rng(0)
    return task


def piece(x, y, yaw, length):
    return SimpleNamespace(
        pose=Pose((x, y, 0.0), from_rpy(0.0, 0.0, yaw)), geometry=Box((length, 0.05, 0.001))
    )


# From the origin 2 m along x, then 3 m along y.
LINE = [piece(1.0, 0.0, 0.0, 2.0), piece(2.0, 1.5, math.pi / 2.0, 3.0)]


def made_with(kind, link):
    """Return the task in a world with a model of this link."""
    model = SimpleNamespace(link=lambda _: link)
    task = made(kind)
    task._stage.world = SimpleNamespace(model=lambda _: model)
    return task


def follow(*pieces):
    """Return the task with a line of these pieces."""
    return made_with(FollowLine, SimpleNamespace(spec=SimpleNamespace(visuals=pieces)))


@pytest.fixture
def follow_line():
    """Return the task with a square of 4 m for a line, which begins at the origin along x."""
    return follow(
        piece(2.0, 0.0, 0.0, 4.0),
        piece(4.0, 2.0, math.pi / 2.0, 4.0),
        piece(2.0, 4.0, math.pi, 4.0),
        piece(0.0, 2.0, -math.pi / 2.0, 4.0),
    )


@pytest.mark.parametrize(
    ('x', 'y', 'way', 'apart'),
    [
        (0.5, 0.0, 0.5, 0.0),
        (0.5, 0.3, 0.5, 0.3),
        (0.5, -0.3, 0.5, 0.3),
        (1.9, 0.0, 1.9, 0.0),
        (-1.0, 0.0, 0.0, 1.0),
        (2.0, 2.9, 4.9, 0.0),
        (1.6, 1.0, 3.0, 0.4),
        (2.3, 2.0, 4.0, 0.3),
        (2.0, 4.0, 5.0, 1.0),
        (2.0, -0.5, 2.0, 0.5),
        (3.0, 4.0, 5.0, math.sqrt(2.0)),
    ],
)
def test_nearest_point_is_on_the_nearest_piece_not_beyond_its_end(x, y, way, apart):
    assert follow(*LINE)._line.nearest(x, y) == pytest.approx((way, apart))


def test_line_is_as_long_as_its_pieces_and_has_their_places():
    line = follow(*LINE)._line
    assert (line.length, line.pieces) == (5.0, 2)
    assert line.place(1) == pytest.approx((2.0, 1.5, math.pi / 2.0))


def test_way_along_a_closed_line_is_rewarded_across_its_end_and_costs_backwards(follow_line):
    follow_line.begin({'start': (0.0, 0.5, 0.0)})
    for (x, y), ahead in (
        ((0.0, 0.2), 0.3),
        ((0.3, 0.0), 0.5),
        ((1.0, 0.0), 0.7),
        ((0.5, 0.0), -0.5),
        ((0.0, 0.1), -0.6),
        ((2.0, 4.0), -5.9),
    ):
        assert stands(follow_line, x, y) == (pytest.approx(ahead), False)
    assert follow_line.truth()['driven'] == pytest.approx(-5.5)
    assert follow_line.truth()['line_distance'] == pytest.approx(0.0)


def test_reward_falls_to_half_beside_the_line_which_is_lost_at_half_a_metre(follow_line):
    for aside, share in ((0.0, 1.0), (0.25, 0.75), (-0.499, 0.501)):
        follow_line.begin({'start': (1.0, 0.0, 0.0)})
        assert stands(follow_line, 1.5, aside) == (pytest.approx(0.5 * share), False)
        assert follow_line.truth()['line_distance'] == pytest.approx(abs(aside))
    assert stands(follow_line, 1.6, -0.501) == (-1.0, True)


@pytest.mark.parametrize(('shift', 'turn'), [(1.0, -1.0), (-0.5, 0.5)])
def test_start_is_up_to_15_cm_beside_a_piece_and_03_rad_askew(shift, turn):
    task = follow(piece(0.0, 0.0, 0.0, 4.0), piece(2.0, 1.0, 0.5, 4.0))
    task._np_random = SimpleNamespace(
        uniform=lambda least, most, count: (
            least + (most - least) / 2.0 * (1.0 + np.array((shift, turn)))
        ),
        integers=lambda count: count - 1,
    )
    task.begin({})
    assert task.pose == pytest.approx(
        (2.0 - 0.15 * shift * math.sin(0.5), 1.0 + 0.15 * shift * math.cos(0.5), 0.5 + 0.3 * turn)
    )


def test_the_way_towards_the_goal_is_rewarded_and_1_there():
    task = made(GoToGoal)
    task.begin({'start': (0.0, 0.0, 0.5), 'goal': (3.0, 4.0)})
    assert stands(task, 0.6, 0.8) == (pytest.approx(1.0), False)
    assert not task.truth()['is_success']
    assert stands(task, 3.0, 4.41) == (pytest.approx(4.0 - 0.41), False)
    assert stands(task, 3.0, 4.39) == (pytest.approx(0.02 + 1.0), True)
    assert task.truth()['is_success']
    task._stage.touches = True
    assert stands(task, 3.0, 4.0) == (-1.0, True)


def test_a_random_goal_is_a_metre_away_or_more():
    task = made(GoToGoal)
    near, far = [(0.0, 0.0, 0.0), (0.99, 0.0, 0.1)], [(0.0, 0.5, 0.0), (1.01, 0.5, 0.2)]
    task._stage.free = [*near, *far]
    task.begin({})
    assert (task.goal, task.pose) == ((0.0, 0.5), (1.01, 0.5, 0.2))
    assert task._stage.free == []
    task._stage.free = [(-1.0, 0.0, 0.0)]
    task.begin({'start': (1.0, 0.0, 0.3)})
    assert (task.goal, task.pose) == ((-1.0, 0.0), (1.0, 0.0, 0.3))
    task.begin({'start': (0.0, 0.0, 0.0), 'goal': (0.1, 0.0)})  # as asked for
    assert task.goal == (0.1, 0.0)


def test_each_square_of_half_a_metre_is_rewarded_once():
    task = made(Wander)
    task._stage.free = [(0.0, 0.0, 0.0)]
    task.begin({})
    for x, y, reward in (
        (0.24, 0.0, 0.0),
        (0.26, 0.0, 1.0),
        (0.74, 0.24, 0.0),
        (0.76, 0.0, 1.0),
        (0.5, -0.26, 1.0),
        (0.0, 0.0, 0.0),
    ):
        assert stands(task, x, y) == (reward, False)
    assert task.truth()['visited'] == 4 * 0.25
    shown = {figure.pose.position[:2] for figure in task.figures()}
    assert shown == {(0.0, 0.0), (0.5, 0.0), (1.0, 0.0), (0.5, -0.5)}
    task._stage.touches = True
    assert stands(task, 5.0, 5.0) == (-1.0, True)


def test_wandering_starts_anywhere_between_the_outer_walls():
    task = made(Wander)
    task._stage.free = [(0.0, 0.0, 0.0)]
    task.begin({})
    rooms = etree.parse(LIBRARY / 'worlds' / 'rooms.world')
    poses = rooms.iterfind('.//model[@name="walls"]//pose')
    x, y = zip(*(map(float, pose.text.split()[:2]) for pose in poses), strict=True)
    half = 0.075  # [m] of the walls' thickness
    faces = ((min(x) + half, max(x) - half), (min(y) + half, max(y) - half))
    assert np.array(task._stage.ranges) == pytest.approx(np.array(faces))


def test_maze_rewards_what_the_way_has_become_shorter_and_10_outside():
    task = made_with(Maze, SimpleNamespace(collisions={}))
    task.begin({})
    assert task.pose[:2] == (0.0, 0.0)
    assert -math.pi <= task.pose[2] < math.pi
    assert task.truth()['left'] == 14.0
    assert stands(task, 4.0, 4.0) == (8.0, False)
    assert stands(task, 2.0, 4.0) == (-2.0, False)
    assert stands(task, 8.0, 5.29) == (pytest.approx(8.0 - 0.71), False)
    assert not task.truth()['is_success']
    assert stands(task, 8.0, 5.31) == (pytest.approx(10.02), True)
    assert task.truth()['is_success']
    task._stage.touches = True
    assert stands(task, 8.0, 6.0) == (-1.0, True)
