"""Links that pass through each other do so as long as they are there, and nobody else does."""

import pytest
from support import box_urdf, empty_world, urdf_spec

from rosbots_description.sim.pose import Pose, Twist
from rosbots_description.sim.sdf import load_sdf

SECOND = 1000  # steps

LOOSE = '<sdf version="1.6"><model name="pile">' + ''.join(
    f"""<link name="{name}"><pose>0 0 {z} 0 0 0</pose><collision name="c"><geometry>
    <box><size>1 1 1</size></box></geometry></collision></link>"""
    for name, z in (('low', 0.5), ('high', 2.0))
) + '</model></sdf>'


def loose_links():
    return load_sdf(LOOSE, 'pile', source='test', find_model=lambda _: None)[0]


def box():
    return urdf_spec(box_urdf('1 1 1', 1.0))


def test_loose_links_of_a_model_pass_through_each_other():
    with empty_world() as world:
        pile = world.spawn(loose_links(), 'pile', Pose())
        world.run(SECOND)
        for link in pile.links.values():
            assert link.pose.position[2] == pytest.approx(0.5, abs=0.01)


@pytest.mark.parametrize('static', [False, True])
def test_what_comes_after_loose_links_touches(static):
    # PyBullet gives the numbers of the links to the boxes.
    base = urdf_spec(box_urdf('1 1 1', 1.0, '<gazebo><static>true</static></gazebo>' * static))
    with empty_world() as world:
        world.spawn(loose_links(), 'pile', Pose())
        world.delete('pile')
        world.spawn(base, 'base', Pose((0.0, 0.0, 0.5)))
        load = world.spawn(box(), 'load', Pose((0.0, 0.0, 1.6)))
        world.run(SECOND)
        assert load.pose.position[2] == pytest.approx(1.5, abs=0.01)


def test_loose_links_pass_through_each_other_after_another_model_went():
    with empty_world() as world:
        world.spawn(box(), 'gone', Pose((5.0, 0.0, 0.5)))
        pile = world.spawn(loose_links(), 'pile', Pose())
        world.delete('gone')
        world.spawn(box(), 'new', Pose((5.0, 0.0, 0.5)))
        world.reset_simulation()
        world.run(SECOND)
        for link in pile.links.values():
            assert link.pose.position[2] == pytest.approx(0.5, abs=0.01)


def test_what_stands_may_have_several_surfaces():
    floor = box_urdf('4 4 0.2', 1.0) + """
      <link name="ice"><collision><origin xyz="4 0 0"/><geometry><box size="4 4 0.2"/></geometry>
        </collision></link>
      <joint name="j" type="fixed"><parent link="box"/><child link="ice"/></joint>
      <gazebo reference="ice"><mu1>0</mu1><mu2>0</mu2></gazebo>
      <gazebo><static>true</static></gazebo>"""
    with empty_world() as world:
        world.spawn(urdf_spec(floor), 'floor', Pose((0.0, 0.0, 1.0)))
        places = {'rough': 0.0, 'smooth': 4.0}
        ways = {}
        for name, x in places.items():
            load = world.spawn(box(), name, Pose((x, 0.0, 1.6)))
            load.set_twist(Twist((0.0, 1.0, 0.0), (0.0, 0.0, 0.0)))
            world.run(SECOND)
            assert load.pose.position[2] == pytest.approx(1.6, abs=0.01)
            ways[name] = load.pose.position[1]
        assert ways['rough'] < 0.2
        assert ways['smooth'] == pytest.approx(1.0, abs=0.05)
