"""Readings of contact sensors agree with Gazebo's recordings: names, counts, forces, axes."""

import math

import numpy as np
import pytest
from support.sensing import ROBOTS, box_sdf, collected, timed

from rosbots_description.ros_api.adapters.contacts import contacts_message
from rosbots_description.sim.public.world import World

OWN = 'bbot::base_footprint::base_footprint_fixed_joint_lump__base_link_collision'
GROUND, WALL = 'ground_plane::link::collision', 'wall_1::link::c'
GROUND_PLANE = '<include><uri>model://ground_plane</uri></include>'
CLOSE = 0.02  # permitted relative error of a force by the solver


def spawn(world, robot='bumper', settled=500, **place):
    """Return the model, and a list that takes times [ms] and readings, once it stands."""
    model = world.spawn(ROBOTS / f'{robot}.urdf', 'bbot', **place)
    world.run(settled)
    return model, timed(world, model.plugin('bumper').outputs['contacts'])


def total(touches, field='force'):
    return np.sum([getattr(point, field) for touch in touches for point in touch.points], axis=0)


def weight_of(model):
    return 9.8 * sum(link.spec.inertial.mass for link in model.links.values())


def test_standing_robot_has_a_state_per_step_with_its_weight(scene):
    model, found = spawn(scene)
    scene.run(200)
    assert [time for time, _ in found] == list(range(520, 701, 20))
    for time, touches in found:
        assert len(touches) == 20
        assert {(touch.first, touch.second) for touch in touches} == {(OWN, GROUND)}
        assert [touch.time_ns // 1_000_000 for touch in touches] == [*range(time - 19, time + 1)]
    for touch in found[-1][1]:
        assert total([touch]) == pytest.approx((0.0, 0.0, weight_of(model)), abs=CLOSE * 49.0)
        assert total([touch], 'torque') == pytest.approx((0.0, 0.0, 0.0), abs=0.1)
        for point in touch.points:
            assert point.normal == pytest.approx((0.0, 0.0, 1.0), abs=1e-6)
            assert abs(point.depth) < 1e-3


def test_message_has_the_text_and_totals_of_gazebos(scene):
    _, found = spawn(scene)
    scene.run(20)
    message = contacts_message(found[0][1])
    first = message.states[0]
    assert first.info == (
        f'Debug:  i:(0/20)     my geom:{OWN}   other geom:{GROUND}         time:0.501000000\n'
    )
    assert (first.collision1_name, first.collision2_name) == (OWN, GROUND)
    assert len(first.wrenches) == len(first.contact_positions) == len(first.depths)
    assert first.total_wrench.force.z == pytest.approx(
        sum(wrench.force.z for wrench in first.wrenches)
    )


def test_every_step_gives_a_message_without_a_rate(scene):
    _, found = spawn(scene, 'bumper_norate')
    scene.run(3)
    assert [(time, len(touches)) for time, touches in found] == [(501, 1), (502, 1), (503, 1)]


def test_message_without_contacts_is_sent(scene):
    _, found = spawn(scene, settled=0, z=0.3)
    scene.run(400)
    counts = [len(touches) for _, touches in found]
    assert counts[:12] == [0] * 12
    assert counts[-1] == 20


@pytest.mark.parametrize(
    ('yaw', 'push'),
    [
        (0.0, (-1.0, 0.0)),
        (math.pi, (1.0, 0.0)),
        (math.pi / 2, (0.0, 1.0)),
    ],
)
def test_force_of_a_wall_is_in_the_axes_of_the_link(scene, yaw, push):
    x = 7.9 - (0.15 if yaw == math.pi / 2 else 0.2)  # its front is at the wall
    model, found = spawn(scene, x=x, yaw=yaw)
    scene.apply_wrench(model.links['base_footprint'], (80.0, 0.0, 0.0))
    scene.run(500)
    touches = [touch for _, reading in found[-10:] for touch in reading]
    assert {touch.first for touch in touches} == {OWN}
    force = total(touches) / 200  # steps; how wall and ground share it is the solver's choice
    assert force == pytest.approx(
        (80.0 * push[0], 80.0 * push[1], weight_of(model)), rel=CLOSE, abs=1.0
    )
    of_wall = [touch for touch in touches if touch.second == WALL]
    assert total(of_wall)[:2] @ np.array(push) > 25.0 * 200
    for point in of_wall[-1].points:
        assert point.normal == pytest.approx((-1.0, 0.0, 0.0), abs=1e-3)


def test_lesser_body_is_the_first_of_a_pair(scene):
    _, found = spawn(scene)
    scene.spawn(box_sdf('.2 .2 .2', 'top', static=False), z=0.3)
    scene.run(1000)
    touches = found[-1][1]
    assert {(touch.first, touch.second) for touch in touches} == {
        ('top::l::c', OWN),
        (OWN, GROUND),
    }
    on_top = [touch for touch in touches if touch.first != OWN]
    assert total(on_top)[2] / len(on_top) == pytest.approx(9.8, rel=CLOSE)
    assert on_top[0].points[0].normal == pytest.approx((0.0, 0.0, 1.0), abs=1e-3)


def cube(name, size, z, *, static=False):
    """Return the text of a cube of that size [m], with a contact sensor, at a height [m]."""
    return f"""<model name="{name}"><static>{static}</static><pose>0 0 {z} 0 0 0</pose>
      <link name="link"><inertial><mass>10</mass></inertial>
        <collision name="c"><geometry><box><size>{size} {size} {size}</size></box></geometry>
        </collision>
        <sensor name="{name}" type="contact"><update_rate>2</update_rate>
          <contact><collision>c</collision></contact>
          <plugin name="bumper" filename="libgazebo_ros_bumper.so"/></sensor></link></model>"""


def readings_in(tmp_path, model, *parts, before=0, steps=1000):
    """Return the readings of a model's bumper in a world of these elements."""
    file = tmp_path / 'it.world'
    file.write_text(f'<sdf version="1.6"><world name="w">{"".join(parts)}</world></sdf>')
    with World.from_file(file) as world:
        world.run(before)
        found = collected(world.models[model].plugin('bumper').outputs['contacts'])
        world.run(steps)
    return found


@pytest.mark.parametrize(
    ('below', 'above', 'first'),
    [
        (('lower', 0.9, 0.45), ('upper', 0.6, 1.2), 'upper'),  # of one level: the newer one
        (('lower', 0.9, 0.45), ('upper', 1.1, 1.45), 'lower'),
        (('lower', 1.1, 0.55), ('upper', 0.9, 1.55), 'upper'),
        (('lower', 0.2, 0.1), ('upper', 0.1, 0.25), 'upper'),  # 0.25 m is the least level
    ],
)
@pytest.mark.parametrize('reverse', [False, True])
def test_order_of_a_pair_follows_from_sizes_and_age(tmp_path, below, above, first, reverse):
    cubes = [cube(*below), cube(*above)]
    if reverse:
        cubes.reverse()
        if first == 'upper' and below[1] // 1 == above[1] // 1:
            first = 'lower'
    touches = readings_in(tmp_path, 'upper', GROUND_PLANE, *cubes)[-1]
    second = {'upper': 'lower', 'lower': 'upper'}[first]
    assert {(touch.first, touch.second) for touch in touches} == {
        (f'{first}::link::c', f'{second}::link::c')
    }
    sign = 1 if first == 'upper' else -1
    assert total([touches[-1]])[2] == pytest.approx(sign * 98.0, abs=0.1)


def test_static_body_is_the_first_of_a_pair_of_equal_size(tmp_path):
    cubes = cube('upper', 0.8, 1.3), cube('lower', 0.9, 0.45, static=True)
    touches = readings_in(tmp_path, 'upper', *cubes)[-1]
    assert {(touch.first, touch.second) for touch in touches} == {
        ('lower::link::c', 'upper::link::c')
    }
    assert total([touches[-1]])[2] == pytest.approx(-98.0, abs=0.1)


def test_ground_is_the_second_of_a_pair_though_it_is_newer(tmp_path):
    """The promise of upstream's test_bumper: the box of a world bears its weight, upwards."""
    parts = '<gravity>0 0 -9.81</gravity>', cube('box', 1.0, 0.5), GROUND_PLANE
    # Bullet's contacts bear no load before they are 10 µm deep.
    found = readings_in(tmp_path, 'box', *parts, before=100, steps=5000)
    messages = [contacts_message(reading) for reading in found]
    assert {message.states[0].collision1_name for message in messages} == {'box::link::c'}
    forces = [message.states[0].total_wrench.force.z for message in messages]
    assert len(forces) >= 10
    assert np.mean(forces) == pytest.approx(98.1, abs=0.01)


def test_other_collision_of_a_reduced_link_is_distinguished(scene):
    _, found = spawn(scene, 'bumper_front')
    scene.run(40)
    assert [touches for _, touches in found] == [(), ()]


def test_unknown_collision_is_reported_and_gives_no_contacts(scene, caplog):
    _, found = spawn(scene, 'bumper_plainname')
    assert (
        "contact 'bump_sensor' of link 'base_footprint': it names base_link_collision as "
        "<collision>; the collisions of 'base_footprint' are: base_footprint_fixed_joint_lump__"
        'base_link_collision'
    ) in caplog.text
    scene.run(40)
    assert [touches for _, touches in found] == [(), ()]


def test_defaults_are_those_of_gazebo(scene):
    model, _ = spawn(scene, 'bumper_defaults')
    assert model.plugin('bumper').params.values == {
        'bumperTopicName': 'bumper_states',
        'frameName': 'world',
    }


def test_the_bumper_of_a_reduced_link_feels_the_wall_that_it_is_pushed_against(scene):
    model, found = spawn(scene, 'bumper_front', x=7.9 - 0.22)
    scene.apply_wrench(model.links['base_footprint'], (80.0, 0.0, 0.0))
    scene.run(500)
    touches = [touch for _, reading in found[-10:] for touch in reading]
    front = OWN.replace('base_link_collision', 'bumper_link_collision_1')
    assert {(touch.first, touch.second) for touch in touches} == {(front, WALL)}
    assert -80.0 <= total(touches)[0] / 200 < -55.0  # friction on the ground may bear the rest


def test_a_fallen_box_has_a_state_for_each_step_since_it_has_landed(scene):
    """It falls 2.9 m, for 0.769 s; its link is not reduced, so neither is its name."""
    _, found = spawn(scene, 'bumper_free', settled=0, z=3.0)
    scene.run(2000)
    counts = {time: len(touches) for time, touches in found}
    assert {counts[time] for time in counts if time <= 760} == {0}
    assert counts[780] == 11
    assert {counts[time] for time in counts if time > 1500} == {20}
    assert {(touch.first, touch.second) for touch in found[-1][1]} == {
        ('bbot::base_link::base_link_collision', GROUND)
    }
