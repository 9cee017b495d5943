"""What the example nodes in scripts/ make of poses, pictures and scans, without ROS running."""

import importlib.util
import itertools
import json
import math
import os
import sys
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from geometry_msgs.msg import Quaternion
from sensor_msgs.msg import Image
from support import ROOT
from support.programs import ran

SCRIPTS = ROOT / 'scripts'
NODES = ('follow_policy', 'go_to_goal', 'line_follower', 'map_while_driving', 'wander')
STEP = 0.1  # [s] of the kinematic robots in these tests


def load(name):
    spec = importlib.util.spec_from_file_location(name, SCRIPTS / f'{name}.py')
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


follow_policy, go_to_goal, line_follower, map_while_driving, wander = map(load, NODES)


def moved(pose, forward, turn):
    """Return the pose (x, y, yaw) of a wheeled robot one step later."""
    x, y, yaw = pose
    return x + STEP * forward * math.cos(yaw), y + STEP * forward * math.sin(yaw), yaw + STEP * turn


@pytest.mark.parametrize('script', SCRIPTS.glob('*.py'), ids=lambda path: path.stem)
def test_a_script_can_be_run_and_read_in_one_sitting(script):
    text = script.read_text(encoding='utf-8')
    assert text.startswith('#!/usr/bin/env python3\n')
    assert script.stat().st_mode & 0o111
    assert text.count('\n') < (90 if script.stem in NODES else 240)


# As rosrun does, but for all scripts at once; test_rosbots_script.py has rosrun itself.
SEARCH = """
folders=$(catkin_find --without-underlays --libexec --share rosbots_description)
mapfile -t folders <<< "$folders"
find -L "${folders[@]}" "$(rospack find rosbots_description)" -name '*.py' -type f -perm /111
"""


@pytest.fixture(scope='module')
def executables():
    """Return the paths of all Python programs that rosrun may find, once each."""
    return {Path(line) for line in ran('bash', '-euc', SEARCH).stdout.splitlines()}


@pytest.mark.parametrize('script', SCRIPTS.glob('*.py'), ids=lambda path: path.stem)
def test_rosrun_finds_a_script_once(script, executables):
    (found,) = (path for path in executables if path.name == script.name)
    assert found.samefile(script)


@pytest.mark.parametrize('script', sorted({*NODES, 'pick_and_place', 'ros_environment'}))
def test_a_node_without_a_master_ends_with_one_sentence(script):
    environment = os.environ | {'ROS_MASTER_URI': 'http://localhost:1'}
    ended = ran(sys.executable, SCRIPTS / f'{script}.py', env=environment, input='')
    assert ended.returncode == 1
    (line,) = ended.stderr.splitlines()
    assert line.startswith(f'{script}: there is no ROS master at http://localhost:1, ')


@pytest.mark.parametrize('yaw', [-3.1, -1.0, 0.0, 0.4, 2.0, 3.1])
def test_a_yaw_comes_back_from_its_quaternion(yaw):
    quaternion = Quaternion(0.0, 0.0, math.sin(yaw / 2), math.cos(yaw / 2))
    assert go_to_goal.yaw_of(quaternion) == pytest.approx(yaw)


@pytest.mark.parametrize('bearing', np.arange(-3.0, 3.3, 0.5))
def test_any_goal_is_reached_within_the_limits(bearing):
    goal = np.array([4 * math.cos(bearing), 4 * math.sin(bearing)])
    pose = 0.0, 0.0, 0.0
    for _ in range(round(20 / STEP)):
        forward, turn = go_to_goal.steer(*(goal - pose[:2]), pose[2], 0.8, 0.6)
        assert 0 <= forward <= 0.8
        assert abs(turn) <= 0.6
        pose = moved(pose, forward, turn)
    assert np.hypot(*(goal - pose[:2])) < 0.05


def test_a_goal_on_the_left_makes_the_robot_turn_left():
    assert go_to_goal.steer(0.0, 1.0, 0.0, 0.8, 0.6) == (pytest.approx(0.0), 0.6)
    assert go_to_goal.steer(1.0, -1.0, -1.5, 0.8, 0.6)[1] > 0


YELLOW, GREY, WHITE, RED = (230, 200, 20), (120, 120, 120), (250, 250, 250), (220, 30, 20)


def picture(colour, columns, encoding='rgb8', padding=0):
    """Return an Image of 80 x 60 with grey ground and a stripe of a colour over all rows."""
    pixels = np.full((60, 80, 3), GREY, np.uint8)
    pixels[:, columns] = colour
    rows = pixels[:, :, :: {'rgb8': 1, 'bgr8': -1}[encoding]].reshape(60, -1)
    rows = np.pad(rows, ((0, 0), (0, padding)))
    return Image(height=60, width=80, step=240 + padding, encoding=encoding, data=rows.tobytes())


@pytest.mark.parametrize(('encoding', 'padding'), [('rgb8', 0), ('bgr8', 0), ('rgb8', 16)])
@pytest.mark.parametrize(('first', 'offset'), [(0, -0.911), (36, 0.0), (72, 0.911)])
def test_the_line_is_where_the_yellow_pixels_are(encoding, padding, first, offset):
    pixels = line_follower.pixels_of(picture(YELLOW, slice(first, first + 8), encoding, padding))
    assert line_follower.line_offset(pixels, 0.5) == pytest.approx(offset, abs=1e-3)


@pytest.mark.parametrize('colour', [GREY, WHITE, RED, (0, 0, 0)])
def test_other_colours_are_not_the_line(colour):
    pixels = line_follower.pixels_of(picture(colour, slice(30, 50)))
    assert line_follower.line_offset(pixels, 0.0) is None


def test_the_upper_part_of_the_picture_does_not_count():
    pixels = line_follower.pixels_of(picture(YELLOW, slice(0, 8))).copy()
    pixels[30:] = GREY
    assert line_follower.line_offset(pixels, 0.5) is None
    assert line_follower.line_offset(pixels, 0.4) < -0.9


def test_a_line_on_the_right_makes_the_robot_turn_right_and_slow_down():
    straight, bend = (line_follower.steer(offset, 0.0, 0.5, 1.2) for offset in (0.0, 0.5))
    assert straight == (0.5, 0.0)
    assert 0 < bend[0] < 0.5
    assert bend[1] / bend[0] == pytest.approx(-0.6)  # the curvature


@pytest.mark.parametrize(('last', 'sign'), [(0.8, -1), (-0.8, 1)])
def test_a_lost_line_is_looked_for_on_its_side(last, sign):
    forward, turn = line_follower.steer(None, last, 0.5, 1.0)
    assert forward == 0
    assert turn * sign > 0


# Walls as segments (x, y, x, y) [m]: a room of 8 m by 6 m, and a box of 1 m in it.
ROOM = np.array(
    [
        (-4, -3, 4, -3),
        (4, -3, 4, 3),
        (4, 3, -4, 3),
        (-4, 3, -4, -3),
        (1, 0, 2, 0),
        (2, 0, 2, 1),
        (2, 1, 1, 1),
        (1, 1, 1, 0),
    ],
    float,
)


def scan(x, y, directions):
    """Return the distances [m] from a point to the walls of ROOM."""
    start, along = ROOM[:, :2] - (x, y), ROOM[:, 2:] - ROOM[:, :2]
    ray = np.stack([np.cos(directions), np.sin(directions)], axis=-1)[:, None]
    cross = ray[..., 0] * along[:, 1] - ray[..., 1] * along[:, 0]
    with np.errstate(divide='ignore', invalid='ignore'):
        distance = (start[:, 0] * along[:, 1] - start[:, 1] * along[:, 0]) / cross
        share = (start[:, 0] * ray[..., 1] - start[:, 1] * ray[..., 0]) / cross
    meets = (distance > 0) & (np.abs(share - 0.5) < 0.5 + 1e-9)  # in a corner, too
    return np.min(np.where(meets, distance, np.inf), axis=1)


def clearance(x, y):
    """Return the distance of a point from the walls of ROOM [m]."""
    start, along = ROOM[:, :2], ROOM[:, 2:] - ROOM[:, :2]
    share = np.clip(((x, y) - start) @ along.T / np.sum(along**2, axis=1), 0, 1).diagonal()
    return np.min(np.hypot(*(start + share[:, None] * along - (x, y)).T))


@pytest.mark.parametrize(
    ('x', 'y', 'way'),
    [(2.0, 0.0, 1.5), (1.0, 0.3, 0.6), (0.3, 0.4, -0.0), (1.0, 0.51, np.inf), (-1.0, 0.0, np.inf)],
)
def test_a_disc_touches_a_point_after_its_free_way(x, y, way):
    assert wander.free_way(np.array([x]), np.array([y]), 0.5) == pytest.approx(way)


@pytest.mark.parametrize('begin', [-math.pi / 2, 0.0])  # half a turn ahead; a whole one from 0
@pytest.mark.parametrize('yaw', [0.0, 1.0, 2.0, -2.5])
def test_a_wandering_disc_goes_far_and_touches_nothing(yaw, begin):
    wanderer = wander.Wanderer(0.5, 0.2, 0.2, 0.5, 0.6)
    angles = np.linspace(begin, begin + (math.pi if begin else 2 * math.pi), 181)
    pose, path = (-2.0, 0.0, yaw), []
    for _ in range(round(60 / STEP)):
        x, y, yaw = pose
        ranges = scan(x + 0.2 * math.cos(yaw), y + 0.2 * math.sin(yaw), yaw + angles)
        pose = moved(pose, *wanderer.command(ranges, angles))
        path.append(pose)
    assert min(clearance(x, y) for x, y, _ in path) > 0.5
    assert np.sum(np.hypot(*np.diff(np.array(path)[:, :2], axis=0).T)) > 10


@pytest.mark.parametrize(('blocked', 'turn'), [(1.0, -0.6), (2 * math.pi - 1.0, 0.6)])
def test_wandering_turns_to_the_free_side_of_a_scan_that_begins_ahead(blocked, turn):
    angles = np.linspace(0.0, 2 * math.pi, 361)
    ranges = np.where(np.abs(angles - blocked) < 1.0, 0.6, 3.0)
    ranges[[0, -1]] = 0.4
    assert wander.Wanderer(0.5, 0.2, 0.2, 0.5, 0.6).command(ranges, angles) == (0.0, turn)


def test_the_map_of_a_room_has_its_walls_and_its_floor():
    grid, cell = np.zeros((100, 100)), 0.1
    directions = np.linspace(-math.pi, math.pi, 721)
    for x, y in ((-2.0, 0.0), (3.0, -2.0), (3.0, 2.0)):
        ranges = scan(x, y, directions) / cell
        ranges[:5] = np.inf, np.nan, np.inf, np.nan, np.inf  # neither may do harm
        grid = map_while_driving.add_scan(grid, x / cell, y / cell, directions, ranges, 100.0)
    y, x = (np.indices(grid.shape) + 0.5) * cell - 5
    wall_distance = np.vectorize(clearance)(x, y)
    assert wall_distance[grid > 0].max() < cell
    assert np.count_nonzero(grid > 0) > 250  # of 320 cells along the walls
    inside = (np.abs(x) < 3.9) & (np.abs(y) < 2.9) & ~((abs(x - 1.5) < 0.7) & (abs(y - 0.5) < 0.7))
    assert np.mean(grid[inside] < 0) > 0.95
    behind = (x > 4.2) | (abs(y) > 3.2)
    assert not grid[behind].any()


def test_points_outside_the_map_do_not_count():
    grid = np.zeros((4, 4))
    assert map_while_driving.mask(grid, [-2.5, 0.5, 2.0, 1.9], [0.0, 0.5, 0.0, -2.0]).tolist() == [
        [False, False, False, True],
        [False] * 4,
        [False, False, True, False],
        [False] * 4,
    ]


def test_a_cell_can_change_its_mind():
    grid = np.zeros((20, 20))
    for reach in (5.0, 20.0):
        for _ in range(30):
            grid = map_while_driving.add_scan(
                grid, 0.5, 0.5, np.array([0.0]), np.array([reach]), 10.0
            )
        assert (grid[10, 15] > 0) == (reach == 5.0)


def test_a_policy_sees_what_is_near_and_where_the_goal_is():
    ranges = np.full(361, 10.0)
    ranges[0], ranges[180] = 0.0, 1.0  # on the right, and straight ahead
    seen = follow_policy.inputs(ranges, 4.0, 0.6, -0.8)
    assert seen[0] == 1.0
    assert seen[follow_policy.SECTORS // 2] == pytest.approx(math.exp(-1.0))
    assert np.count_nonzero(seen[: follow_policy.SECTORS] > 0.01) == 2
    assert seen[follow_policy.SECTORS :].tolist() == [1.0, 0.6, -0.8]


def test_the_layers_of_a_policy_are_applied_in_turn():
    values = follow_policy.outputs(
        [[[1.0, 0.0, 0.5]], [[2.0, 0.0], [0.0, -1.0]]], np.array([0.1, 9.0])
    )
    forward, turn = np.tanh([2.0 * math.tanh(0.6), -1.0])
    assert values == pytest.approx([(1.0 + forward) / 2.0, turn])  # never backwards


def test_the_learned_policy_has_an_input_for_each_value_and_turns_to_the_goal():
    path = SCRIPTS.parent / 'config' / 'go_to_goal_policy.json'
    layers = json.loads(path.read_text(encoding='utf-8'))['layers']
    free = np.full(361, 5.0)
    turns = [
        follow_policy.outputs(
            layers, follow_policy.inputs(free, 3.0, math.cos(bearing), math.sin(bearing))
        )[1]
        for bearing in (-1.0, 1.0)
    ]
    assert turns[0] < 0.0 < turns[1]


def test_learning_finds_what_is_rewarded(monkeypatch, capsys):
    monkeypatch.syspath_prepend(str(SCRIPTS))
    learn_by_cma = load('learn_by_cma')
    sizes = [rows * columns for rows, columns in learn_by_cma.SHAPES]
    wanted = np.linspace(-1.0, 1.0, sum(sizes))
    monkeypatch.setattr(
        learn_by_cma, 'episode', lambda weights, _seed: (-np.sum((weights - wanted) ** 2), False)
    )
    pool = SimpleNamespace(starmap=lambda call, given, chunksize: [*itertools.starmap(call, given)])
    weights, curve = learn_by_cma.learn(pool, 60, seed=1)
    assert len(curve) == 60
    assert np.sum((weights - wanted) ** 2) < 0.3 * np.sum(wanted**2)
    assert [layer.shape for layer in learn_by_cma.layers_of(weights)] == [*learn_by_cma.SHAPES]
    assert capsys.readouterr().out.count('\n') == 60
