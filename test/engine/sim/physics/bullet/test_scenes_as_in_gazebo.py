"""Passive bodies fall, slide, roll, bounce and swing as in Gazebo, or else as mechanics says."""

import math
import re

import pytest
from support.mechanics import MOTIONS, REBOUNDS
from support.passive import SCENES, compare_scene
from support.recorded import Known, exceeded

# Differences above the tolerances of support/passive.py: permitted share, and reason.
KNOWN = (
    Known('roll', 'c_upright::link velocity', 1.2,
          'it rocks as it slides, which brakes it by 3 % more, to a way 3 % shorter'),
    Known('bounce', 'bx0.6::link orientation', math.inf,
          'on which of 24 sides a tilted cube comes to lie has no closed form; its height has'),
    Known('push', 'b_mu1::link orientation', math.inf,
          'on which of 24 sides a tipped cube comes to lie has no closed form; its height has'),
)  # fmt: skip


@pytest.mark.parametrize('scene', SCENES)
def test_each_quantity_of_a_passive_scene_agrees_with_gazebo_or_mechanics(scene):
    assert exceeded(compare_scene(scene), KNOWN) == []


def test_each_exception_names_a_recorded_scene_and_has_a_number():
    for one in (*KNOWN, *MOTIONS, *REBOUNDS):
        assert one.scene in SCENES
        assert re.search(r'\d', one.reason), one
