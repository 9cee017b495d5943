"""The collision filter covers its links as long as they exist, and no others."""

import pytest
from support import box_urdf, urdf_spec

from rosbots_description.sim.core.transforms import Pose, Twist
from rosbots_description.sim.formats.sdf.sdf import load_sdf

SECOND = 1000  # steps

LOOSE = (
    '<sdf version="1.6"><model name="pile">'
    + ''.join(
        f"""<link name="{name}"><pose>0 0 {z} 0 0 0</pose><collision name="c"><geometry>
    <box><size>1 1 1</size></box></geometry></collision></link>"""
        for name, z in (('low', 0.5), ('high', 2.0))
    )
    + '</model></sdf>'
)


def loose_links():
    return load_sdf(LOOSE, 'pile', source='test', find_model=lambda _: None)[0]


def box():
    return urdf_spec(box_urdf('1 1 1', 1.0))


@pytest.mark.parametrize('static', [False, True])
def test_models_spawned_after_unconnected_links_collide(world, static):
    # PyBullet reuses the ids of the links for the boxes.
    base = urdf_spec(box_urdf('1 1 1', 1.0, '<gazebo><static>true</static></gazebo>' * static))
    world.spawn(loose_links(), 'pile', Pose())
    world.delete('pile')
    world.spawn(base, 'base', Pose((0.0, 0.0, 0.5)))
    load = world.spawn(box(), 'load', Pose((0.0, 0.0, 1.6)))
    world.run(SECOND)
    assert load.pose.position[2] == pytest.approx(1.5, abs=0.01)


def test_unconnected_links_do_not_collide_after_a_deletion(world):
    world.spawn(box(), 'gone', Pose((5.0, 0.0, 0.5)))
    pile = world.spawn(loose_links(), 'pile', Pose())
    world.delete('gone')
    world.spawn(box(), 'new', Pose((5.0, 0.0, 0.5)))
    world.reset_simulation()
    world.run(SECOND)
    for link in pile.links.values():
        assert link.pose.position[2] == pytest.approx(0.5, abs=0.01)


def test_static_model_may_have_several_surfaces(world):
    floor = (
        box_urdf('4 4 0.2', 1.0)
        + """
      <link name="ice"><collision><origin xyz="4 0 0"/><geometry><box size="4 4 0.2"/></geometry>
        </collision></link>
      <joint name="j" type="fixed"><parent link="box"/><child link="ice"/></joint>
      <gazebo reference="ice"><mu1>0</mu1><mu2>0</mu2></gazebo>
      <gazebo><static>true</static></gazebo>"""
    )
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


SLIPPERY = '<surface><friction><ode><mu>{}</mu></ode></friction></surface>'


def two_faced(name, place, extra=(), self_collide=0):
    """Return a link of two boxes with different friction; the second is on an auxiliary link."""
    shapes = ''.join(
        f"""<collision name="{side}"><pose>{x} 0 0 0 0 0</pose><geometry><box><size>1 1 1</size>
        </box></geometry>{SLIPPERY.format(mu)}</collision>"""
        for side, x, mu in (('left', 0.5, 1.0), ('right', -0.5, 0.2), *extra)
    )
    return (
        f'<link name="{name}"><pose>{place} 0 0 0</pose>'
        f'<self_collide>{self_collide}</self_collide>{shapes}</link>'
    )


def sdf_model(*parts):
    text = f'<sdf version="1.6"><model name="m">{"".join(parts)}</model></sdf>'
    return load_sdf(text, 'm', source='test', find_model=lambda _: None)[0]


@pytest.mark.parametrize(
    'spec',
    [loose_links(), sdf_model(two_faced('low', '0 0 0.5'), two_faced('high', '0 0 2'))],
    ids=['one surface', 'two surfaces'],
)
def test_unconnected_links_of_a_model_do_not_collide(world, spec):
    pile = world.spawn(spec, 'pile', Pose())
    world.run(SECOND)
    for link in pile.links.values():
        assert link.pose.position[2] == pytest.approx(0.5, abs=0.01)


def test_links_of_a_joint_do_not_collide_with_any_of_their_surfaces(world):
    # They overlap on one side; a contact would turn the hinge.
    hinge = """<joint name="hinge" type="revolute"><parent>post</parent><child>arm</child>
      <axis><xyz>1 0 0</xyz></axis></joint>"""
    third = [('third', 0.0, 0.5)]
    post, arm = two_faced('post', '0 0 0.5', third, 1), two_faced('arm', '0 0.3 0.8', third, 1)
    model = world.spawn(sdf_model(post, arm, hinge), 'm', Pose())
    world.run(300)
    assert model.links['post'].pose.position == pytest.approx((0.0, 0.0, 0.5), abs=0.01)
    assert abs(model.joint('hinge').velocity) < 0.01


def masked(collide, category='', shape='<box><size>1 1 1</size></box>'):
    """Return a box of 1 m whose collision has these bitmasks."""
    masks = ''.join(
        f'<{tag}>{mask}</{tag}>'
        for tag, mask in (('collide_bitmask', collide), ('category_bitmask', category))
        if mask
    )
    return sdf_model(
        f'<link name="l"><collision name="c"><geometry>{shape}</geometry><surface>'
        f'<contact>{masks}</contact></surface></collision></link>'
    )


@pytest.mark.parametrize(
    ('lower', 'upper', 'meet'),
    [
        (('0x01',), ('0x02',), False),
        (('0x01',), ('0x03',), True),
        (('1',), ('',), True),  # by default everything
        (('0',), ('',), False),
        (('0x01', '0x02'), ('0x02', '0x01'), True),  # each collides with the other's category
        (('0x04', '0x02'), ('0x08', '0x01'), False),
        (('0x04', '0x02'), ('0x02', '0x01'), True),  # one direction is enough
    ],
)
def test_bitmasks_decide_whether_two_models_collide(world, lower, upper, meet):
    world.spawn(masked(*lower), 'lower', Pose((0.0, 0.0, 0.5)))
    high = world.spawn(masked(*upper), 'upper', Pose((0.0, 0.0, 1.51)))
    world.run(300)
    assert (high.pose.position[2] > 1.4) == meet


def test_a_shape_that_collides_with_nothing_falls_through_the_ground_and_is_replaced(world):
    ghost = world.spawn(masked('0'), 'ghost', Pose((0.0, 0.0, 0.6)))
    world.run(600)
    assert ghost.pose.position[2] < -0.5
    world.delete('ghost')
    solid = world.spawn(box(), 'solid', Pose((0.0, 0.0, 0.6)))  # with the ghost's number
    world.run(SECOND)
    assert solid.pose.position[2] == pytest.approx(0.5, abs=0.01)


def test_bitmasks_hold_after_the_world_has_been_rebuilt(world):
    world.spawn(masked('0x01'), 'lower', Pose((0.0, 0.0, 0.5)))
    high = world.spawn(masked('0x02'), 'upper', Pose((0.0, 0.0, 1.51)))
    world.reset_simulation()
    world.run(SECOND)
    assert high.pose.position[2] == pytest.approx(0.5, abs=0.01)


def test_collisions_of_one_link_have_their_own_bitmasks(world):
    # The left end is held up, the rest passes through the ground: the plank tips over.
    parts = ''.join(
        f'<collision name="{name}"><pose>{x} 0 0 0 0 0</pose><geometry><box><size>{long} 1 0.2'
        f'</size></box></geometry><surface><contact><collide_bitmask>{mask}</collide_bitmask></contact>'
        '</surface></collision>'
        for name, x, long, mask in (('left', -0.4, 0.2, 1), ('right', 0.1, 0.8, 0))
    )
    plank = world.spawn(sdf_model(f'<link name="l">{parts}</link>'), 'm', Pose((0.0, 0.0, 0.11)))
    world.run(SECOND)
    assert abs(plank.pose.orientation[1]) > 0.2
