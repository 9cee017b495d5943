"""Pictures for people show the goal, a grid on the ground, and shadows that are not black."""

from contextlib import closing

import gymnasium
import numpy as np
import pytest

import rosbots_description.gym  # noqa: F401  registers the tasks
from rosbots_description.sim import Pose, World
from rosbots_description.sim.description import Cylinder, Material, Visual
from rosbots_description.sim.rendering import Figure, Illustrator, look_at

BLOCK = """<robot name="block"><link name="l"><inertial><mass value="1"/>
<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
<visual><geometry><box size="1 1 1"/></geometry></visual></link></robot>"""
ABOVE = look_at((-0.01, 0.0, 9.0), (0.0, 0.0, 0.0))
SCALE = 640 / (2.0 * 9.0 * np.tan(1.01 / 2.0))  # [pixels/m] of the ground, from there


@pytest.fixture
def world():
    with World.empty() as opened:
        yield opened


def is_green(picture):
    """Tell which pixels are green, but not as dark as circuit boards."""
    red, high, blue = picture.astype(int).transpose(2, 0, 1)
    return (high > red + 50) & (high > blue + 50) & (red + blue > 150)


def green(picture):
    """Return the middle of the green pixels, from the left and from above."""
    found = np.argwhere(is_green(picture))
    assert len(found) > 50
    return found.mean(axis=0)[::-1]


def test_ground_has_lines_one_metre_apart(world):
    row = Illustrator(world).take(ABOVE, (0.2, 0.0, 0.0), ())[200].mean(axis=1)
    dark = np.flatnonzero(row < np.median(row) - 10.0)
    lines = np.array(
        [part.mean() for part in np.split(dark, np.flatnonzero(np.diff(dark) > 5) + 1)]
    )
    assert len(lines) >= 6
    metres = (lines - 319.5) / SCALE
    assert metres == pytest.approx(np.round(metres), abs=0.03)
    assert np.diff(np.round(metres)) == pytest.approx(1.0)


def test_world_without_a_ground_has_no_grid():
    with World() as empty:
        assert np.ptp(Illustrator(empty).take(ABOVE, (0.0, 0.0, 0.0), ())) == 0


def test_shadow_is_about_two_thirds_as_bright_as_the_ground(world):
    world.spawn(BLOCK, x=0.9, y=0.5, z=0.6)  # its lower face is 0.1 m above the ground
    grey = Illustrator(world).take(ABOVE, (0.0, 0.0, 0.0), ()).mean(axis=2)
    x, y = 0.4 - 0.3, 0.5 + 0.2  # in its shadow, which leads 0.5 m to the back
    row, column = round(239.5 - x * SCALE), round(319.5 - y * SCALE)
    assert 0.55 < grey[row, column] / np.median(grey) < 0.75


def test_edge_of_a_shadow_is_blurred_by_some_centimetres(world):
    world.spawn(BLOCK, x=0.9, y=0.0, z=0.6)
    # The shadow of its lower edge at x = 0.4 begins at x = 0.34, that of the upper one at -0.21.
    eye = look_at((-0.22, 0.3, 1.0), (-0.21, 0.3, 0.0))
    row = Illustrator(world).take(eye, (0.0, 0.0, 0.0), ())[150:330, 320].mean(axis=1)
    metre = 640 / (2.0 * np.tan(1.01 / 2.0))  # [pixels]
    low, high = row.min(), row.max()
    between = (row > low + 0.1 * (high - low)) & (row < high - 0.1 * (high - low))
    assert low < 0.75 * high
    assert 0.01 < between.sum() / metre < 0.06


def test_figure_is_shown_where_it_is_posed(world):
    illustrator = Illustrator(world)
    disc = Visual('disc', Cylinder(0.2, 0.01), material=Material.plain((0.1, 0.8, 0.1, 0.5)))
    for x, y in ((1.0, 0.5), (-1.5, 1.0)):
        figures = (Figure(disc, Pose((x, y, 0.01))),)
        left, top = green(illustrator.take(ABOVE, (0.0, 0.0, 0.0), figures))
        assert (left - 319.5, top - 239.5) == pytest.approx((-y * SCALE, -x * SCALE), abs=4.0)
    assert not is_green(illustrator.take(ABOVE, (0.0, 0.0, 0.0), ())).any()


def test_goal_is_in_the_picture_wherever_it_is():
    with closing(gymnasium.make('rosbots/GoToGoal-v0', render_mode='rgb_array')) as env:
        for goal in ((2.2, 1.3), (-2.2, -1.3), (0.0, 0.5)):
            env.reset(seed=1, options={'start': (-1.5, 0.5, 0.0), 'goal': goal})
            left, top = green(env.render())
            assert 30 < left < 610
            assert 30 < top < 450


def test_way_out_of_the_maze_is_in_the_picture():
    with closing(gymnasium.make('rosbots/Maze-v0', render_mode='rgb_array')) as env:
        env.reset(seed=1)
        left, top = green(env.render())
        assert 30 < left < 610
        assert 30 < top < 450


def test_squares_that_were_visited_are_blue_on_the_ground():
    with closing(gymnasium.make('rosbots/Wander-v0', render_mode='rgb_array')) as env:
        env.reset(seed=1, options={'start': (0.0, 0.0, 0.0)})
        visited = {figure.pose.position[:2] for figure in env.unwrapped.figures()}
        assert visited == {(0.0, 0.0)}
        for _ in range(20):
            env.step(np.array([1.0, 0.0], np.float32))
        visited = {figure.pose.position[:2] for figure in env.unwrapped.figures()}
        assert {(0.0, 0.0), (0.5, 0.0), (1.0, 0.0)} <= visited
        red, _, blue = env.render().astype(int).transpose(2, 0, 1)
        assert ((blue - red > 20) & (blue - red < 90)).sum() > 1000


def test_no_figures_before_the_first_reset():
    with closing(gymnasium.make('rosbots/GoToGoal-v0', render_mode='rgb_array')) as env:
        assert env.unwrapped.render().shape == (480, 640, 3)
