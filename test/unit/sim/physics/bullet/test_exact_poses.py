"""Poses that are restored to the last bit."""

import math
from types import SimpleNamespace

import pytest

from rosbots_description.sim.core.transforms import IDENTITY, Pose
from rosbots_description.sim.physics.bullet import exact_poses
from rosbots_description.sim.physics.bullet.body import Part

SAVED = Pose((1.0, 2.0, 3.0))
ROUNDED = Pose((1.0, 2.0, 3.0 + 1e-15))


@pytest.mark.parametrize(
    ('axes', 'links', 'expected'),
    [
        (ROUNDED, [SAVED], ROUNDED),  # the links are as saved already
        (Pose((1.0, 2.0, 3.1)), [IDENTITY], Pose((1.0, 2.0, 3.1))),  # moved, as by an edited file
        (ROUNDED, [IDENTITY], SAVED),
    ],
)
def test_only_rounding_errors_of_a_root_are_undone(monkeypatch, axes, links, expected):
    placed = [axes]
    pybullet = SimpleNamespace(
        getBaseVelocity=lambda *_: ((0.0, 0.0, 0.0), (0.0, 0.0, 0.0)),
        getBasePositionAndOrientation=lambda *_: placed[-1],
        resetBasePositionAndOrientation=lambda _, *pose: placed.append(Pose(*pose[:2])),
        resetBaseVelocity=lambda *_, **__: None,
    )
    monkeypatch.setattr(exact_poses, 'pybullet', pybullet)
    root = exact_poses.ExactPlacement(0, Part(1, -1, IDENTITY, IDENTITY), lambda: links)
    root.match(SAVED, [SAVED])
    assert placed[-1] == expected


def test_orientations_within_three_units_in_the_last_place_are_tried_the_nearest_first():
    q = (0.1, -0.2, 0.3, math.sqrt(0.86))
    tried = list(exact_poses._near(q))
    assert len(set(tried)) == len(tried) == 7**4
    steps = [[round((a - b) / math.ulp(b)) for a, b in zip(one, q, strict=True)] for one in tried]
    assert {x for of_one in steps for x in of_one} == set(range(-3, 4))
    sizes = [sum(map(abs, of_one)) for of_one in steps]
    assert sizes == sorted(sizes)
