"""The shortest way out of a maze, past walls that are there and through gaps between them."""

from types import SimpleNamespace

import pytest

from rosbots_description.gym.tasks.maze import GOAL, Distances
from rosbots_description.sim import Pose
from rosbots_description.sim.description import Box

TO_GOAL = 8.0 + 6.0  # [m] from the middle along x and y, without walls


def wall(x, y, length_x, length_y):
    return SimpleNamespace(
        spec=SimpleNamespace(geometry=Box((length_x, length_y, 1.0))), pose=Pose((x, y, 0.5))
    )


def distances(*walls):
    link = SimpleNamespace(collisions=dict(enumerate(walls)))
    maze = SimpleNamespace(link=lambda _: link)
    return Distances(SimpleNamespace(model=lambda _: maze))


@pytest.mark.parametrize(
    ('walls', 'left'),
    [
        ((), TO_GOAL),
        ((wall(7.0, 0.0, 0.2, 20.0),), float('inf')),  # from end to end
        ((wall(7.0, 2.0, 0.2, 15.0),), TO_GOAL + 2 * 6.0),  # down to the gap at y = -6 and back
        ((wall(7.0, 1.0, 0.2, 13.0),), TO_GOAL + 2 * 2.0),  # up to the gap at y = 8 and back
        ((wall(7.0, -1.0, 0.2, 13.0),), TO_GOAL),  # the gap is at y = 6
        ((wall(1.0, 0.0, 0.2, 1.0),), TO_GOAL),  # there are other ways as short
        ((wall(1.0, 0.0, 0.2, 20.0), wall(-6.0, -7.0, 0.2, 0.2)), float('inf')),
    ],
)
def test_way_leads_past_walls(walls, left):
    assert distances(*walls).of(0.0, 0.0) == left


@pytest.mark.parametrize(
    ('x', 'y', 'left'),
    [
        (*GOAL, 0.0),
        (6.0, 6.0, 2.0),
        (8.0, 4.0, 2.0),
        (8.0, 8.0, 2.0),
        (8.0, 5.5, 0.5),
        (-6.0, -6.0, 26.0),
        (6.5, 6.0, 1.5),
        (20.0, 20.0, float('inf')),
    ],
)
def test_way_is_as_long_as_its_cells_and_the_rest_within_one(x, y, left):
    assert distances().of(x, y) == pytest.approx(left)
