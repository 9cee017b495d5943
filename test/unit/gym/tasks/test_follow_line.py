"""The nearest point of a line of pieces: its way along the line, and how far it is."""

import math
from types import SimpleNamespace

import pytest

from rosbots_description.gym.tasks.follow_line import Line
from rosbots_description.sim import Pose, from_rpy
from rosbots_description.sim.description import Box


def piece(x, y, yaw, length):
    return SimpleNamespace(
        pose=Pose((x, y, 0.0), from_rpy(0.0, 0.0, yaw)), geometry=Box((length, 0.05, 0.001))
    )


# From the origin 2 m along x, then 3 m along y.
LINE = [piece(1.0, 0.0, 0.0, 2.0), piece(2.0, 1.5, math.pi / 2.0, 3.0)]


def line(pieces):
    link = SimpleNamespace(spec=SimpleNamespace(visuals=pieces))
    model = SimpleNamespace(link=lambda _: link)
    return Line(SimpleNamespace(model=lambda _: model))


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
    assert line(LINE).nearest(x, y) == pytest.approx((way, apart))


def test_line_is_as_long_as_its_pieces_and_has_their_places():
    made = line(LINE)
    assert (made.length, made.pieces) == (5.0, 2)
    assert made.place(1) == pytest.approx((2.0, 1.5, math.pi / 2.0))
