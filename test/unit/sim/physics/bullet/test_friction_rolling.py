"""Rolling resistance."""

import pytest

from rosbots_description.sim.description.model_spec import REVOLUTE, Collision, Cylinder, JointSpec
from rosbots_description.sim.physics.bullet.friction_rolling import rolling_arm

TYRE = Collision('tyre', Cylinder(0.1, 0.05))
AXLE = JointSpec('axle', REVOLUTE, 'base', 'wheel')


@pytest.mark.parametrize(('joint', 'arm'), [(None, 5e-4), (AXLE, 0.0)])
def test_free_cylinder_has_rolling_resistance_and_a_wheel_has_none(joint, arm):
    assert rolling_arm([TYRE], joint) == pytest.approx(arm)
