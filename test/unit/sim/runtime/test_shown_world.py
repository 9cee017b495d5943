"""What windows are told of a world: everything once, then what has changed."""

from dataclasses import replace

from support import urdf_spec
from support.fake_engine import FakeEngine

from rosbots_description.sim.core.transforms import Pose
from rosbots_description.sim.description import LightSpec, Sphere
from rosbots_description.sim.runtime.shown_world import ShownWorld
from rosbots_description.sim.runtime.world import World

BALL = urdf_spec(
    '<link name="ball"><inertial><mass value="1"/>'
    '<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>'
    '<visual><geometry><sphere radius="0.5"/></geometry></visual></link>'
)


def names(change):
    return [model.name for model in change.models], change.removed


def test_models_come_and_go():
    world = World(make_engine=FakeEngine)
    world.spawn(BALL, 'a', Pose((1.0, 0.0, 0.0)))
    shown = ShownWorld(world)
    change = shown.change()
    assert change.reset
    assert names(change) == (['a'], ())
    (link,) = change.models[0].links
    assert (link.name, link.pose.position) == ('ball', (1.0, 0.0, 0.0))
    assert link.visuals[0].geometry == Sphere(0.5)
    assert shown.change() is None
    world.spawn(BALL, 'b', Pose())
    assert names(shown.change()) == (['b'], ())
    world.delete('a')
    world.spawn(BALL, 'a', Pose())
    change = shown.change()
    assert names(change) == (['a'], ('a',))
    assert not change.reset
    assert change.models[0].links[0].number != link.number
    shown.reset()
    assert names(shown.change()) == (['b', 'a'], ())


def test_only_what_moved_is_told_and_the_clock_always():
    world = World(make_engine=FakeEngine)
    world.spawn(BALL, 'still', Pose())
    ball = world.spawn(BALL, 'ball', Pose())
    shown = ShownWorld(world)
    number = shown.change().models[1].links[0].number
    assert shown.motion(1.0).poses == {}
    world.run(3)
    ball.set_pose(Pose((0.0, 2.0, 0.0)))
    motion = shown.motion(2.0)
    assert motion.poses == {number: Pose((0.0, 2.0, 0.0))}
    assert (motion.time, motion.real_time, motion.iterations) == (0.003, 2.0, 3)
    assert not motion.paused
    world.delete('ball')
    shown.change()
    assert shown.motion(3.0).poses == {}


def test_links_that_cannot_be_seen_are_told_too():
    world = World(make_engine=FakeEngine)
    bare = replace(BALL, links=(replace(BALL.links[0], pose=Pose((0.0, 0.0, 1.0)), visuals=()),))
    ball = world.spawn(bare, 'ball', Pose())
    shown = ShownWorld(world)
    (model,) = shown.change().models
    assert model.canonical_pose == Pose((0.0, 0.0, 1.0))
    ball.set_pose(Pose((0.0, 2.0, 0.0)))
    assert shown.motion(1.0).poses == {model.links[0].number: ball.links['ball'].pose}


def test_lights_and_speed_are_told_when_they_change():
    world = World(make_engine=FakeEngine)
    shown = ShownWorld(world)
    shown.change()
    world.lights['lamp'] = LightSpec('lamp')
    assert shown.change().lights == {'lamp': LightSpec('lamp')}
    world.set_physics(replace(world.physics, max_update_rate=100.0))
    assert shown.change().max_update_rate == 100.0
