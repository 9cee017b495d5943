"""A saved world, opened again: the same poses bit for bit, and the motion goes on."""

import logging
import math

import pytest
from lxml import etree
from support import LIBRARY, XACRO, box_urdf

from rosbots_description.sim import Pose, SimError, World, from_rpy

WORLDS = sorted(path.stem for path in (LIBRARY / 'worlds').glob('*.world'))
AHEAD = 300  # steps over which a motion is compared
DRIVEN = 0.002  # [m] the integral action of motors starts anew
TURN = from_rpy(0.4, 0.3, 0.2)
CRATE = f'<robot name="crate">{box_urdf("1 0.6 0.4", 2.0)}</robot>'
LINK = (
    '<link name="{}"><pose>{}</pose><inertial><pose>0.1 0.2 0.05 0.3 0.2 0.1</pose><mass>2'
    '</mass><inertia><ixx>0.1</ixx><iyy>0.2</iyy><izz>0.25</izz><ixy>0.01</ixy></inertia>'
    '</inertial></link>'
)
ARM = f"""<sdf version="1.6"><model name="arm">{LINK.format('base', '0 0 0 0.1 0.2 0.3')}
{LINK.format('upper', '0.3 0 0 1 0 0')}{LINK.format('slider', '0 0 0.5 0 1 0')}
<joint name="turn" type="revolute"><parent>base</parent><child>upper</child>
<pose>0.1 0.2 0.3 0.3 0.2 0.1</pose><axis><xyz>0.6 0.1 0.3</xyz></axis></joint>
<joint name="slide" type="prismatic"><parent>upper</parent><child>slider</child>
<axis><xyz>1 0.2 0</xyz><dynamics><friction>0.1</friction></dynamics></axis></joint>
</model></sdf>"""

DOORS = '<sdf version="1.6"><model name="doors">{}</model></sdf>'.format(
    ''.join(
        LINK.format(name, pose)
        + f'<joint name="{name}_hinge" type="revolute"><parent>world</parent>'
        f'<child>{name}</child><pose>0.1 0.5 0 0 0 0</pose><axis><xyz>0 0 1</xyz></axis></joint>'
        for name, pose in (('first', '0 1 0 0 0 0.1'), ('second', '0 -1 0.2 0.3 0 0'))
    )
)


def poses(world):
    """Return the poses of all models and links."""
    links = [link for model in world.models.values() for link in model.links.values()]
    return {part.scoped_name: part.pose for part in (*world.models.values(), *links)}


def farthest(one, other):
    """Return the greatest distance between two worlds' links [m]."""
    there = poses(other)
    return max(math.dist(pose.position, there[name].position) for name, pose in poses(one).items())


def require_same(world, other):
    assert list(other.models) == list(world.models)
    assert poses(other) == poses(world)
    for what in ('time', 'physics', 'scene', 'lights', 'name'):
        assert getattr(other, what) == getattr(world, what)
    for model in world.models.values():
        there = other.models[model.name]
        assert there.initial_pose == model.initial_pose
        assert {name: joint.state() for name, joint in there.joints.items()} == {
            name: joint.state() for name, joint in model.joints.items()
        }
        for link, again in zip(model.links.values(), there.links.values(), strict=True):
            if not model.static:
                assert again.twist.linear == pytest.approx(link.twist.linear, abs=1e-12)
                assert again.twist.angular == pytest.approx(link.twist.angular, abs=1e-12)


@pytest.mark.parametrize('name', WORLDS)
def test_a_robot_drives_on_where_it_was_saved(name, tmp_path, caplog):
    with World.from_file(name) as world:
        robot = world.spawn(XACRO, 'rosbots', z=0.5)
        world.run(seconds=0.7)
        robot.plugin('diff_drive').command(0.6, 0.4)
        world.run(1337)
        caplog.clear()
        assert world.save(tmp_path / 'saved.world') == ()
        with World.from_file(tmp_path / 'saved.world') as other:
            errors = [record for record in caplog.records if record.levelno >= logging.ERROR]
            assert errors == []
            require_same(world, other)
            assert [*other.model('rosbots').plugins] == [*robot.plugins]
            other.model('rosbots').plugin('diff_drive').command(0.6, 0.4)
            world.run(AHEAD)
            other.run(AHEAD)
            assert farthest(world, other) < DRIVEN


def test_bodies_in_flight_keep_their_poses_over_many_saves(world, tmp_path):
    arm = world.spawn(ARM, pose=Pose((0.0, 0.0, 30.0), TURN))
    crate = world.spawn(CRATE, pose=Pose((5.0, 0.0, 40.0), TURN))
    crate.set_twist(crate.twist._replace(angular=(3.0, -2.0, 1.0)))
    arm.joint('turn').set_motor(4.0, 50.0)
    for turn in range(8):
        world.run(100)
        world.save(tmp_path / f'{turn}.world')
        with World.from_file(tmp_path / f'{turn}.world') as other:
            require_same(world, other)
            other.save(tmp_path / 'again.world', overwrite=True)
            with World.from_file(tmp_path / 'again.world') as third:
                assert poses(third) == poses(world)


@pytest.mark.parametrize('place', [Pose((0.0, 0.0, 3.0)), Pose((1.0, 2.0, 3.0), TURN)])
def test_models_on_joints_to_the_world_keep_their_poses(world, place, tmp_path):
    doors = world.spawn(DOORS, pose=place)
    doors.joint('first_hinge').set_position(3.0, 2.0)
    doors.joint('second_hinge').set_motor(-2.0, math.inf)
    for turn in range(3):
        world.run(300)
        assert world.save(tmp_path / f'{turn}.world') == ()
        with World.from_file(tmp_path / f'{turn}.world') as other:
            require_same(world, other)
            assert other.model('doors').joint('second_hinge').motor == (-2.0, math.inf)
    assert doors.joint('first_hinge').position > math.pi


def test_a_reset_returns_models_to_where_they_were_spawned(world, tmp_path):
    world.spawn(CRATE, 'another', pose=Pose((1.0, 2.0, 3.0), TURN))
    world.run(500)
    world.model('ground_plane').set_pose(Pose((0.0, 0.0, -0.5), TURN))
    world.save(tmp_path / 'saved.world')
    with World.from_file(tmp_path / 'saved.world') as other:
        require_same(world, other)
        other.reset_simulation()
        assert other.time == 0.0
        assert math.dist(other.model('another').pose.position, (1.0, 2.0, 3.0)) < 1e-12


def test_poses_that_are_changed_by_hand_are_believed(world, tmp_path):
    path = tmp_path / 'saved.world'
    world.spawn(CRATE, pose=Pose((1.0, 2.0, 3.0)))
    world.run(100)
    z = repr(world.model('crate').pose.position[2])
    world.save(path)
    path.write_text(path.read_text().replace(z, '7.5'))
    with World.from_file(path) as other:
        assert other.model('crate').pose.position[2] == pytest.approx(7.5)


def test_parts_of_its_file_that_nothing_acts_on_are_saved_again(tmp_path):
    path, saved = tmp_path / 'a.world', tmp_path / 'saved.world'
    path.write_text(
        '<sdf version="1.6"><world name="w"><road name="r"><width>3</width></road>'
        '<light name="lamp" type="point"/><plugin name="p" filename="libp.so">'
        '<rate>5</rate></plugin></world></sdf>'
    )
    with World.from_file(path) as world:
        world.save(saved)
    root = etree.parse(saved)
    assert [root.findtext(f'world/{part}') for part in ('road/width', 'plugin/rate')] == ['3', '5']
    with World.from_file(saved) as again:
        assert list(again.lights) == ['lamp']


def test_what_is_not_in_the_file_is_named(world, tmp_path):
    part = LINK.format('hill', '0 0 0 0 0 0').replace(
        '</link>',
        '<collision name="c"><geometry><heightmap/></geometry></collision>'
        '<sensor name="s" type="sonar"/></link>',
    )
    hill = world.spawn(f'<sdf version="1.6"><model name="hill">{part}</model></sdf>')
    world.apply_wrench(hill.link('hill'), (1.0, 0.0, 0.0))
    hill.link('hill').scale_friction(0.5)
    assert world.save(tmp_path / 'a.world') == (
        f"of model 'hill' what was left out: {hill.spec.left_out[0]}",
        "of model 'hill' the factors on mass and friction",
        'forces and efforts that act for a time',
    )
    assert 'heightmap' in hill.spec.left_out[0]
    assert '<sensor name="s" type="sonar"' in (tmp_path / 'a.world').read_text()
    with pytest.raises(SimError, match='exists already'):
        world.save(tmp_path / 'a.world')
