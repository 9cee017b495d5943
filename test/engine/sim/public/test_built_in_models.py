"""Built-in models that move come to rest where a world puts them, upright."""

import pytest

from rosbots_description.sim import World
from rosbots_description.sim.core import rotate

NAMES = ('beer', 'cardboard_box', 'cinder_block', 'coke_can', 'construction_barrel',
         'construction_cone', 'dumpster', 'first_2015_trash_can', 'mailbox', 'person_standing',
         'person_walking')
STILL = 0.005  # [m]
UPRIGHT = 0.9999  # cosine of the tilt


def test_they_stand(tmp_path):
    included = ''.join(f'<include><uri>model://{name}</uri><name>{name}</name><pose>{4 * i} 0 '
                       f'{0.15 if name == "cardboard_box" else 0} 0 0 0</pose></include>'
                       for i, name in enumerate(NAMES))
    path = tmp_path / 'w.world'
    path.write_text('<sdf version="1.6"><world name="w"><include><uri>model://ground_plane</uri>'
                    f'</include>{included}</world></sdf>', encoding='utf-8')
    with World.from_file(path) as world:
        world.run(seconds=1.0)
        for i, name in enumerate(NAMES):
            pose = world.model(name).pose
            assert pose.position[:2] == pytest.approx((4.0 * i, 0.0), abs=STILL), name
            assert rotate(pose.orientation, (0.0, 0.0, 1.0))[2] > UPRIGHT, name
