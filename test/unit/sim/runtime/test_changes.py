"""What readers of a world are told of its changes, and what of the world is read for them."""

import gc
import weakref
from dataclasses import replace

import pytest
from support import urdf_spec
from support.fake_engine import FakeEngine

from rosbots_description.sim.core.transforms import Pose
from rosbots_description.sim.description import LightSpec
from rosbots_description.sim.runtime.changes import NOTHING
from rosbots_description.sim.runtime.shown_world import ShownWorld
from rosbots_description.sim.runtime.world import World

CRATE = urdf_spec(
    '<link name="crate"><inertial><mass value="1"/>'
    '<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>'
)
WALL = replace(CRATE, static=True)
AHEAD = Pose((1.0, 0.0, 0.0))


class CountingEngine(FakeEngine):
    """Counts how often poses are read."""

    def __init__(self, physics):
        super().__init__(physics)
        self.reads = []

    def link_pose(self, body, link):
        self.reads.append(body.spec.static)
        return super().link_pose(body, link)


@pytest.fixture
def world():
    made = World(make_engine=CountingEngine)
    made.spawn(WALL, 'wall', Pose())
    made.spawn(CRATE, 'crate', Pose())
    return made


@pytest.fixture
def seen(world):
    """What a reader has seen that has looked once."""
    return world.revisions.since(NOTHING).revision


def moved(changes):
    return {link.scoped_name: pose for link, pose in changes.moved.items()}


def test_a_new_reader_is_told_everything(world):
    changes = world.revisions.since(NOTHING)
    assert [model.name for model in changes.added] == ['wall', 'crate']
    assert moved(changes) == {'wall::crate': Pose(), 'crate::crate': Pose()}
    assert changes.scenery
    assert changes.physics
    assert not changes.removed


def test_one_who_has_seen_everything_is_told_nothing(world, seen):
    revision, *changes = world.revisions.since(seen)
    assert revision == seen
    assert not any(changes)


def test_a_model_of_the_same_name_is_another_one(world, seen):
    world.delete('crate')
    world.spawn(CRATE, 'crate', Pose())
    changes = world.revisions.since(seen)
    assert changes.removed == ['crate']
    assert changes.added == [world.models['crate']]
    assert moved(changes) == {'crate::crate': Pose()}


def test_what_came_and_went_between_two_looks_is_not_told(world, seen):
    world.spawn(CRATE, 'other', Pose())
    world.revisions.since(seen)  # another reader
    world.delete('other')
    _, *changes = world.revisions.since(seen)
    assert not any(changes)


def test_a_model_that_is_described_anew_is_told_as_such(world, seen):
    crate = world.models['crate']
    crate.change_links(lambda link: replace(link, gravity=False))
    changes = world.revisions.since(seen)
    assert (changes.added, changes.respecified, changes.removed) == ([], [crate], [])


def test_each_reader_is_told_of_a_motion_that_it_has_not_seen(world, seen):
    world.models['crate'].set_pose(AHEAD)
    first = world.revisions.since(seen)
    assert moved(first) == moved(world.revisions.since(seen)) == {'crate::crate': AHEAD}
    assert not world.revisions.since(first.revision).moved


def test_lights_and_physics_are_told_each_as_such(world, seen):
    world.lights['lamp'] = LightSpec('lamp')
    lit = world.revisions.since(seen)
    assert (lit.scenery, lit.physics) == (True, False)
    world.set_physics(replace(world.physics, max_update_rate=100.0))
    other = world.revisions.since(lit.revision)
    assert (other.scenery, other.physics) == (False, True)


def test_a_step_lets_links_be_read_once_and_none_of_static_models(world, seen):
    world.engine.reads.clear()
    world.run(1)
    assert world.engine.reads == []
    for _ in range(3):  # readers
        world.revisions.since(seen)
    assert world.engine.reads == [False]


def test_a_static_model_that_is_placed_is_read(world, seen):
    world.models['wall'].set_pose(AHEAD)
    assert moved(world.revisions.since(seen)) == {'wall::crate': AHEAD}


def test_models_are_the_same_object_until_one_is_another(world):
    models = world.revisions.models()
    world.models['crate'].set_pose(AHEAD)
    assert world.revisions.models() is models
    world.delete('crate')
    assert list(world.revisions.models()) == [world.models['wall']]


def test_a_world_goes_whose_revisions_are_kept():
    world = World(make_engine=CountingEngine)
    kept = {world.revisions: weakref.ref(world)}
    del world
    gc.collect()
    assert [gone() for gone in kept.values()] == [None]


def test_what_a_page_is_shown_is_read_once(world):
    shown = ShownWorld(world)
    world.engine.reads.clear()
    assert shown.change()
    assert shown.motion(0.0).poses == {}
    assert world.engine.reads == [True, False]  # of the wall and the crate
