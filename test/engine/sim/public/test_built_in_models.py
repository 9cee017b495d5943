"""Built-in models come to rest where a world puts them, and their mesh files are solid."""

import pytest

from rosbots_description.sim import World
from rosbots_description.sim.core import rotate

NAMES = (
    'beer',
    'cardboard_box',
    'cinder_block',
    'coke_can',
    'construction_barrel',
    'construction_cone',
    'dumpster',
    'first_2015_trash_can',
    'mailbox',
    'person_standing',
    'person_walking',
)
STILL = 0.005  # [m]
UPRIGHT = 0.9999  # cosine of the tilt


def opened(folder, models):
    """Return a world of models on the ground, from a file."""
    path = folder / 'w.world'
    path.write_text(
        '<sdf version="1.6"><world name="w"><include><uri>model://ground_plane</uri>'
        f'</include>{models}</world></sdf>',
        encoding='utf-8',
    )
    return World.from_file(path)


def test_they_stand(tmp_path):
    included = ''.join(
        f'<include><uri>model://{name}</uri><name>{name}</name><pose>{4 * i} 0 '
        f'{0.15 if name == "cardboard_box" else 0} 0 0 0</pose></include>'
        for i, name in enumerate(NAMES)
    )
    with opened(tmp_path, included) as world:
        world.run(seconds=1.0)
        for i, name in enumerate(NAMES):
            pose = world.model(name).pose
            assert pose.position[:2] == pytest.approx((4.0 * i, 0.0), abs=STILL), name
            assert rotate(pose.orientation, (0.0, 0.0, 1.0))[2] > UPRIGHT, name


def test_the_mesh_files_that_a_saved_world_names_are_solid(tmp_path):
    """A ball rests on a wall of 3 m height; a cone of the mesh stands."""
    ball = '<geometry><sphere><radius>0.1</radius></sphere></geometry>'
    wall, cone = (
        f'<geometry><mesh><uri>model://{address}</uri><scale>{scale}</scale></mesh></geometry>'
        for address, scale in (
            ('brick_box_3x1x3/meshes/simple_box.dae', '3 1 3'),
            ('construction_cone/meshes/construction_cone.dae', '10 10 10'),
        )
    )
    models = ''.join(
        f'<model name="{name}"><static>{static}</static><pose>{pose} 0 0 0</pose><link name="link">'
        f'<collision name="collision">{shape}</collision></link></model>'
        for name, static, pose, shape in (
            ('wall', 1, '0 0 1.5', wall),
            ('ball', 0, '1 0 3.1', ball),
            ('cone', 0, '5 0 0', cone),
        )
    )
    with opened(tmp_path, models) as world:
        world.run(seconds=1.0)
        assert world.model('ball').pose.position == pytest.approx((1.0, 0.0, 3.1), abs=STILL)
        cone = world.model('cone').pose
        assert cone.position == pytest.approx((5.0, 0.0, 0.0), abs=STILL)
        assert rotate(cone.orientation, (0.0, 0.0, 1.0))[2] > UPRIGHT
