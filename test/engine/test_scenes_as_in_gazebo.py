"""Bodies that nobody drives fall, slide, roll, bounce and swing as they do in the real Gazebo."""

import pytest
from support.passive import SCENES, compare_scene
from support.recorded import exceeded

# What is further from Gazebo than the tolerances of support/passive.py: how far, and why.
CORNER = 'of a box above a plane PyBullet finds one corner in a step, so it rocks by 0.015 rad'
KNOWN = (
    ('slope', 'b6', 160.0, 'of two surfaces below 1 PyBullet takes the product'),
    ('mu_pairs', 'f5', 70.0, 'mu 10 is as good as 1'),
    ('roll', 'c::', 30.0, 'loose cylinders have a rolling resistance of 0.005'),
    ('roll', 'c_upright', 1.4, CORNER),
    ('bounce_plate', 'r0.8_on0.8::link velocity', 30.0, 'compared beside an impact'),
    ('bounce_plate', 'r0.8_on0.8::link place', 2.2, 'it comes up to 0.656, not 0.639'),
    ('mu_pairs', '', 2.6, CORNER),
    ('mu_pairs_diag', '', 5.6, CORNER),
    ('push', '', 3.0, CORNER),
)  # fmt: skip


@pytest.mark.parametrize('scene', SCENES)
def test_a_passive_scene_is_gazebos_in_each_quantity(scene):
    assert exceeded(compare_scene(scene), KNOWN) == []
