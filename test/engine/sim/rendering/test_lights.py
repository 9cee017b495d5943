"""Each light adds its own share to a picture, whatever lights come before and after it."""

from itertools import permutations

import numpy as np
import pytest
from support import box_urdf, empty_world, urdf_spec

from rosbots_description.sim.core.transforms import Pose
from rosbots_description.sim.description import DIRECTIONAL, POINT, SPOT, LightSpec
from rosbots_description.sim.rendering import OVERVIEW, ImageCapture, Wants, look_at

LENS = OVERVIEW._replace(width=80, height=60)
FLOOR = box_urdf(
    '8 8 0.2', 1.0, '<gazebo reference="box"><material>Gazebo/Grey</material></gazebo>'
)
DIM = (0.25, 0.25, 0.25, 1.0)
SPECULAR = (0.1, 0.1, 0.1, 1.0)
LIGHTS = [
    LightSpec('sun', DIRECTIONAL, diffuse=DIM, specular=SPECULAR),
    LightSpec('bulb', POINT, Pose((1.0, 1.0, 2.0)), (1.0, 1.0, 1.0, 1.0), SPECULAR),
    LightSpec(
        'torch',
        SPOT,
        Pose((-1.0, 0.0, 2.0)),
        (1.0, 1.0, 1.0, 1.0),
        SPECULAR,
        spot_inner_angle=0.5,
        spot_outer_angle=1.2,
        spot_falloff=1.0,
    ),
]


def picture(world, *lights):
    world.lights.clear()
    world.lights.update({light.name: light for light in lights})
    capture = ImageCapture(world)
    capture.request([(LENS, look_at((0.0, 0.0, 6.0), (0.0, 0.1, 0.0)))], 0, Wants())
    (taken,) = capture.receive_image(wait=True)
    return taken.pixels.astype(int)


@pytest.fixture(scope='module')
def world():
    with empty_world() as world:
        world.spawn(urdf_spec(FLOOR), 'floor', Pose((0.0, 0.0, 0.2)))
        yield world


@pytest.fixture(scope='module')
def shares(world):
    dark = picture(world)
    return dark, {light.name: picture(world, light) - dark for light in LIGHTS}


@pytest.mark.parametrize('count', [2, 3])
def test_lights_add_up_in_every_order(world, shares, count):
    dark, share = shares
    assert all(one.max() > 20 for one in share.values())
    for lights in permutations(LIGHTS, count):
        expected = (dark + sum(share[light.name] for light in lights)).clip(0, 255)
        off = np.abs(picture(world, *lights) - expected)
        assert off.max() <= count, [light.name for light in lights]
