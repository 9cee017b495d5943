"""Joint positions from the link poses of a saved world."""

import pytest

from rosbots_description.sim.core import Pose, compose, from_rpy
from rosbots_description.sim.description import (
    PRISMATIC,
    REVOLUTE,
    JointSpec,
    LinkSpec,
    ModelSpec,
    ModelState,
)
from rosbots_description.sim.runtime.world_file_state import joint_positions


@pytest.mark.parametrize(
    'kind, axis, moved, position',
    [
        (REVOLUTE, (0.0, 0.0, 1.0), Pose(orientation=from_rpy(0.0, 0.0, 0.7)), 0.7),
        (REVOLUTE, (0.0, -1.0, 0.0), Pose(orientation=from_rpy(0.0, 0.4, 0.0)), -0.4),
        (PRISMATIC, (1.0, 0.0, 0.0), Pose((0.3, 0.0, 0.0)), 0.3),
    ],
)
def test_joint_positions_follow_from_link_poses(kind, axis, moved, position):
    frame = Pose((0.0, 0.5, 0.0), from_rpy(0.1, 0.2, 0.3))  # of the joint in the child
    child = Pose((1.0, 2.0, 3.0), from_rpy(0.3, 0.2, 0.1))  # at position zero
    spec = ModelSpec(
        'm', (LinkSpec('a'), LinkSpec('b', child)), (JointSpec('j', kind, 'a', 'b', frame, axis),)
    )
    world = Pose((5.0, 5.0, 0.0), from_rpy(0.0, 0.0, 1.0))
    # The child moves about the joint's frame, not about its own origin.
    joint = compose(compose(child, frame), moved)
    back = Pose((0.0, -0.5, 0.0))
    turned = compose(joint, Pose(orientation=_inverse(frame.orientation)))
    placed = compose(turned, back)
    state = ModelState('m', world, {'a': world, 'b': compose(world, placed)})
    assert joint_positions(spec, state) == {'j': pytest.approx(position)}


def _inverse(q):
    return (-q[0], -q[1], -q[2], q[3])
