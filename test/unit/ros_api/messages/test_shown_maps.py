"""Maps, paths, poses and goals, as a window shows them."""

import math

import numpy as np
import pytest
from geometry_msgs.msg import Point, Pose, PoseArray, PoseStamped, Quaternion
from nav_msgs.msg import OccupancyGrid, Path

from rosbots_description.ros_api.messages import MAP_TYPES, map_cells, shown_reading
from rosbots_description.ros_api.messages.shown_maps import LIFT, MOST_POSES, WIDEST
from rosbots_description.sim.core import Pose as PlainPose
from rosbots_description.sim.core import SimError

NAN = math.nan


def pose(x=0.0, y=0.0, z=0.0, turn=(0.0, 0.0, 0.0, 1.0)):
    return Pose(Point(x, y, z), Quaternion(*turn))


def grid(rows, resolution=0.05, origin=None, width=None):
    message = OccupancyGrid()
    message.header.frame_id = 'map'
    rows = np.asarray(rows, np.int8)
    message.info.height, message.info.width = rows.shape
    if width is not None:
        message.info.width = width
    message.info.resolution = resolution
    message.info.origin = origin or pose(turn=(0.0, 0.0, 0.0, 1.0))
    message.data = rows.ravel().tolist()
    return message


def test_cells_are_white_when_free_black_when_occupied_and_clear_when_unknown():
    (top, bottom) = map_cells(np.array([[0, 100, -1], [50, 101, -2]], np.int8))
    assert bottom[0, :3].tolist() == [255] * 3
    assert bottom[1, :3].tolist() == [0] * 3
    assert bottom[2, 3] == 0
    assert bottom[1, 3] > bottom[0, 3] > 0
    assert top[0, :3].tolist() == [128] * 3
    assert top[1:, :3].tolist() == [[255, 0, 0]] * 2  # values that the message does not define
    assert top[1:, 3].all()


def test_a_map_has_its_frame_place_and_size():
    reading = shown_reading(grid([[0, 100]], origin=pose(1.0, -2.0)))
    assert reading.frame == 'map'
    assert reading.words == '2 x 1 cells of 0.05 m'
    assert reading.grid.origin == PlainPose((1.0, -2.0, 0.0))
    assert reading.grid.cell == 0.05
    assert reading.grid.cells.shape == (1, 2, 4)


def test_of_a_large_map_cells_are_merged_and_none_that_is_occupied_is_lost():
    rows = np.full((2, WIDEST + 1), -1)
    rows[1, 0], rows[0, WIDEST] = 0, 100
    shown = shown_reading(grid(rows)).grid
    assert shown.cell == 0.1
    assert shown.cells.shape == (1, WIDEST // 2 + 1, 4)
    assert shown.cells[0, 0, :3].tolist() == [255] * 3
    assert shown.cells[0, -1, :3].tolist() == [0] * 3
    assert not shown.cells[0, 1:-1, 3].any()


@pytest.mark.parametrize(
    ('message', 'sentence'),
    [
        (grid([[0, 100]], width=3), 'it has 2 cells instead of 3 x 1'),
        (grid([[0]], resolution=0.0), 'its resolution is 0 m'),
        (grid([[0]], resolution=NAN), 'its resolution is nan m'),
        (grid([[0]], origin=pose(NAN)), 'its origin is nowhere'),
    ],
)
def test_what_is_no_map_is_refused(message, sentence):
    with pytest.raises(SimError, match=sentence):
        shown_reading(message)


def test_a_map_without_cells_shows_none():
    assert shown_reading(OccupancyGrid(info=grid([[0]], width=0).info)).grid is None


def path(*poses):
    return Path(poses=[PoseStamped(pose=one) for one in poses])


def test_a_path_leads_from_pose_to_pose():
    reading = shown_reading(path(pose(), pose(1.0), pose(1.0, 2.0)))
    assert reading.lines[..., :2].tolist() == [[[0.0, 0.0], [1.0, 0.0]], [[1.0, 0.0], [1.0, 2.0]]]
    assert reading.lines[..., 2] == pytest.approx(LIFT)
    assert reading.words == '3 poses'
    assert len(shown_reading(path()).lines) == 0
    assert len(shown_reading(path(pose(), pose(NAN), pose(1.0))).lines) == 1


def test_of_a_long_path_some_poses_are_shown():
    reading = shown_reading(path(*[pose(float(n)) for n in range(2 * MOST_POSES)]))
    assert len(reading.lines) == MOST_POSES - 1
    assert reading.words == f'{2 * MOST_POSES} poses'


@pytest.mark.parametrize(
    ('turn', 'along'),
    [
        ((0.0, 0.0, 0.0, 1.0), (1.0, 0.0, 0.0)),
        ((0.0, 0.0, 2.0, 2.0), (0.0, 1.0, 0.0)),  # not of length 1, as messages may be
        ((0.0, -math.sqrt(0.5), 0.0, math.sqrt(0.5)), (0.0, 0.0, 1.0)),
        ((0.0, 0.0, 0.0, 0.0), (1.0, 0.0, 0.0)),
    ],
)
def test_poses_are_arrows_along_their_x_axes(turn, along):
    lines = shown_reading(PoseArray(poses=[pose(1.0, turn=turn)])).lines
    (tip, tail), *barbs = lines
    assert tail == pytest.approx([1.0, 0.0, LIFT])
    shaft = tip - tail
    assert shaft / np.linalg.norm(shaft) == pytest.approx(along, abs=1e-6)
    for start, end in barbs:
        assert start == pytest.approx(tip)
        assert (end - start) @ shaft < 0.0
    (_, left), (_, right) = barbs
    assert left + right == pytest.approx(2.0 * (tip - 0.3 * shaft))


def test_poses_that_are_none_are_left_out():
    poses = [pose(NAN), pose(turn=(NAN, 0.0, 0.0, 1.0)), pose()]
    assert len(shown_reading(PoseArray(poses=poses)).lines) == 3


def test_a_goal_is_one_arrow_longer_than_those_of_particles():
    goal = shown_reading(PoseStamped(pose=pose(1.0, 2.0)))
    particle = shown_reading(PoseArray(poses=[pose(1.0, 2.0)]))
    assert goal.words == 'x 1.000, y 2.000 m'
    assert np.linalg.norm(goal.lines[0, 0] - goal.lines[0, 1]) > np.linalg.norm(
        particle.lines[0, 0] - particle.lines[0, 1]
    )


def test_each_type_can_be_shown_when_it_is_empty():
    for kind in MAP_TYPES.values():
        if kind is not OccupancyGrid:  # without a resolution
            assert shown_reading(kind()).lines is not None
