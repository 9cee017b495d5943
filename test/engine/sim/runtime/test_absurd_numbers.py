"""A diverged model does not affect the others."""

import pytest
from support import box_urdf, urdf_spec

from rosbots_description.sim.core.errors import ModelError
from rosbots_description.sim.core.transforms import Pose, Twist

BOX = urdf_spec(box_urdf('1 1 1', 1.0))
STANDING = Pose((5.0, 0.0, 0.5))


@pytest.mark.parametrize(
    'lose',
    [
        lambda model: model.set_pose(Pose((1e308, 0.0, 0.5))),
        lambda model: model.set_twist(Twist((1e308, 0.0, 0.0), (0.0, 0.0, 0.0))),
    ],
)
def test_diverged_model_deleted_before_its_detection_affects_no_other(world, lose):
    neighbour = world.spawn(BOX, 'neighbour', STANDING)
    diverged = world.spawn(BOX, 'diverged', Pose((0.0, 0.0, 0.5)))
    lose(diverged)
    world.run(3)
    world.delete('diverged')
    world.run(500)
    assert neighbour.state()[0].position == pytest.approx((5.0, 0.0, 0.5), abs=1e-3)


@pytest.mark.parametrize('x', [1e9, -1e308, float('inf'), float('nan')])
def test_spawn_at_an_extreme_position_is_rejected(world, x):
    with pytest.raises(ModelError, match='m away; less than 1e'):
        world.spawn(BOX, 'far', Pose((x, 0.0, 0.5)))
    assert 'far' not in world.models
