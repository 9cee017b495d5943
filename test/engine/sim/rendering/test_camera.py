"""Images of the simulator's overview camera show the world."""

import numpy as np
import pytest
from support import SPAWN_POSE, box_urdf, empty_world, robot_spec, urdf_spec

from rosbots_description.sim.core.transforms import Pose
from rosbots_description.sim.rendering.camera import View

SMALL = (160, 120)  # pixels
RED_BOX = box_urdf('1 1 1', 1.0, '<gazebo reference="box"><material>Gazebo/Red</material></gazebo>')


def red_share(picture):
    red, green, blue = np.moveaxis(picture.astype(int), -1, 0)
    return float(np.mean((red > 80) & (green < red // 2) & (blue < red // 2)))


@pytest.fixture
def world():
    with empty_world() as world:
        yield world


def test_red_box_is_visible_at_its_pose_until_deleted(world):
    view = View(world)
    world.spawn(urdf_spec(RED_BOX), 'box', Pose((0.0, 0.0, 0.5)))
    seen = red_share(view.picture((4.0, 0.0, 1.0), (0.0, 0.0, 0.5), SMALL))
    away = red_share(view.picture((4.0, 0.0, 1.0), (8.0, 0.0, 0.5), SMALL))
    world.delete('box')
    gone = red_share(view.picture((4.0, 0.0, 1.0), (0.0, 0.0, 0.5), SMALL))
    view.close()
    assert seen > 0.05
    assert (away, gone) == (0.0, 0.0)


def test_image_follows_motion(world):
    view = View(world)
    box = world.spawn(urdf_spec(RED_BOX), 'box', Pose((0.0, 0.0, 0.5)))
    look = (4.0, 0.0, 1.0), (0.0, 0.0, 0.5), SMALL
    near = view.picture(*look).astype(int)
    box.set_pose(Pose((0.0, 1.0, 0.5)))
    aside = view.picture(*look).astype(int)
    view.close()
    # Seen from +x, +y is on the right.
    columns = np.arange(SMALL[0])
    where = [
        np.average(columns, weights=(p[:, :, 0] > 2 * p[:, :, 1].clip(1)).sum(axis=0) + 1e-9)
        for p in (near, aside)
    ]
    assert where[1] > where[0] + 10


def test_rendering_does_not_change_the_motion(world):
    def fall(with_pictures):
        model = world.spawn(robot_spec(), 'rosbots', SPAWN_POSE)
        view = View(world)
        for _ in range(3):
            world.run(200)
            if with_pictures:
                view.picture(size=SMALL)
        pose = model.pose
        view.close()
        world.delete('rosbots')
        return pose

    assert fall(True) == fall(False)


def test_robot_has_its_own_colours(world):
    world.spawn(robot_spec(), 'rosbots', Pose((0.0, 0.0, -0.12)))
    view = View(world)
    picture = view.picture().astype(int)
    view.close()
    blue = (picture[:, :, 2] > 100) & (picture[:, :, 0] < 60)
    yellow = (picture[:, :, 0] > 120) & (picture[:, :, 2] < 60)
    assert blue.mean() > 0.02
    assert yellow.mean() > 0.0005
