"""Images of the simulator's overview camera show the world."""

import numpy as np
import pytest
from support import SPAWN_POSE, box_urdf, empty_world, robot_spec, urdf_spec

from rosbots_description.sim.core.transforms import Pose
from rosbots_description.sim.rendering.camera import EYE, OVERVIEW, TARGET, look_at
from rosbots_description.sim.rendering.gl import Wants
from rosbots_description.sim.rendering.image_capture import ImageCapture

SMALL = OVERVIEW._replace(width=160, height=120)
RED_BOX = box_urdf('1 1 1', 1.0, '<gazebo reference="box"><material>Gazebo/Red</material></gazebo>')


def picture(capture, eye=EYE, target=TARGET, lens=SMALL):
    capture.request([(lens, look_at(eye, target))], 0, Wants())
    (taken,) = capture.receive_image(wait=True)
    return taken.pixels.astype(int)


def red_share(pixels):
    red, green, blue = np.moveaxis(pixels, -1, 0)
    return float(np.mean((red > 80) & (green < red // 2) & (blue < red // 2)))


@pytest.fixture
def world():
    with empty_world() as world:
        yield world


def test_red_box_is_visible_at_its_pose_until_deleted(world):
    capture = ImageCapture(world)
    world.spawn(urdf_spec(RED_BOX), 'box', Pose((0.0, 0.0, 0.5)))
    seen = red_share(picture(capture, (4.0, 0.0, 1.0), (0.0, 0.0, 0.5)))
    away = red_share(picture(capture, (4.0, 0.0, 1.0), (8.0, 0.0, 0.5)))
    world.delete('box')
    gone = red_share(picture(capture, (4.0, 0.0, 1.0), (0.0, 0.0, 0.5)))
    assert seen > 0.05
    assert (away, gone) == (0.0, 0.0)


def test_a_world_without_models_shows_its_background(world):
    assert any(light.cast_shadows for light in world.lights.values())
    for name in list(world.models):
        world.delete(name)
    pixels = picture(ImageCapture(world))
    assert (pixels == pixels[0, 0]).all()


def test_image_follows_motion(world):
    capture = ImageCapture(world)
    box = world.spawn(urdf_spec(RED_BOX), 'box', Pose((0.0, 0.0, 0.5)))
    near = picture(capture, (4.0, 0.0, 1.0), (0.0, 0.0, 0.5))
    box.set_pose(Pose((0.0, 1.0, 0.5)))
    aside = picture(capture, (4.0, 0.0, 1.0), (0.0, 0.0, 0.5))
    # Seen from +x, +y is on the right.
    columns = np.arange(SMALL.width)
    where = [
        np.average(columns, weights=(p[:, :, 0] > 2 * p[:, :, 1].clip(1)).sum(axis=0) + 1e-9)
        for p in (near, aside)
    ]
    assert where[1] > where[0] + 10


def test_rendering_does_not_change_the_motion(world):
    def fall(with_pictures):
        model = world.spawn(robot_spec(), 'rosbots', SPAWN_POSE)
        capture = ImageCapture(world)
        for _ in range(3):
            world.run(200)
            if with_pictures:
                picture(capture)
        pose = model.pose
        world.delete('rosbots')
        return pose

    assert fall(True) == fall(False)


def test_robot_has_its_own_colours(world):
    world.spawn(robot_spec(), 'rosbots', Pose((0.0, 0.0, -0.12)))
    red, _, blue = np.moveaxis(picture(ImageCapture(world), lens=OVERVIEW), -1, 0)
    is_blue = (blue > 100) & (red < 60)
    is_yellow = (red > 120) & (blue < 60)
    assert is_blue.mean() > 0.02
    assert is_yellow.mean() > 0.0005
