"""Rolling resistance."""

import pytest

from rosbots_description.sim.description.model_spec import (
    REVOLUTE,
    Box,
    Collision,
    Cylinder,
    JointSpec,
)
from rosbots_description.sim.physics.bullet.friction_rolling import rolling_arm

TYRE = Collision('tyre', Cylinder(0.1, 0.05))
AXLE = JointSpec('axle', REVOLUTE, 'base', 'wheel')


@pytest.mark.parametrize(('joint', 'arm'), [(None, 5e-4), (AXLE, 0.0)])
def test_free_cylinder_has_rolling_resistance_and_a_wheel_has_none(joint, arm):
    assert rolling_arm([TYRE], joint) == pytest.approx(arm)


def test_only_parts_of_cylinders_alone_have_it_and_the_widest_counts():
    rim, block = Collision('rim', Cylinder(0.3, 0.01)), Collision('block', Box((1.0, 1.0, 1.0)))
    assert rolling_arm([TYRE, rim, TYRE], None) == pytest.approx(0.005 * 0.3)
    assert rolling_arm([TYRE, block], None) == 0.0
    assert rolling_arm([block], None) == 0.0
