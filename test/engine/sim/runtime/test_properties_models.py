"""Property tests: accepted models do not crash the engine, print, or affect other models."""

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support import box_urdf, empty_world, package_directory, robot_urdf, urdf_spec
from support.descriptions import sdfs, urdfs
from support.fuzzing import MEMORY, STEPS
from support.invariants import check_sentence, numbers_in
from support.isolation import isolated, limit_memory
from support.mutations import damaged

from rosbots_description.sim.core.errors import SimError
from rosbots_description.sim.core.transforms import Pose
from rosbots_description.sim.formats.sdf.sdf import load_sdf
from rosbots_description.sim.formats.urdf.urdf import load_urdf
from rosbots_description.sim.resources.uris import UnknownPackage
from rosbots_description.sim.resources.xml_parser import root_tag
from rosbots_description.sim.runtime.divergence_watchdog import PERIOD

ASIDE = Pose((1e4, 1e4, 0.5))  # [m] beyond the reach of moving models
RIGHT = Pose((0.0, 0.0, 100.0))


def read(text):
    if root_tag(text) == 'robot':
        return load_urdf(text, 'model', find_package=package_directory)
    return load_sdf(text, 'model', find_model=lambda _: None, find_package=package_directory)


@pytest.fixture(scope='module')
def world():
    """Open the initial world of every example: ground and a distant box at rest."""
    with empty_world() as world:
        world.spawn(urdf_spec(box_urdf('1 1 1', 1.0)), 'bystander', ASIDE)
        live(world, robot_urdf())  # children inherit the converted meshes
        yield world


def live(world, text, more=0):
    """Spawn, simulate and delete a model; return whether it stayed finite, and the bystander."""
    spec, pose = read(text)
    model = world.spawn(spec, 'model', pose if math.hypot(*pose.position) < 1e3 else RIGHT)
    world.run(STEPS)
    states = [link.state() for link in model.links.values()]
    states += [joint.state() for joint in model.joints.values()]
    states.append(model.state())
    numbers = list(numbers_in(states))
    finite = all(map(math.isfinite, numbers))
    world.run(more)
    world.delete('model')
    assert list(world.models) == ['ground_plane', 'bystander']
    return finite, world.models['bystander'].state()


def survive(world, text):
    """Simulate a model that may be rejected; return the state of the bystander."""
    limit_memory(MEMORY)
    try:
        finite, bystander = live(world, text, 2 * PERIOD)
    except (SimError, UnknownPackage) as error:
        check_sentence(error)
        world.run(1)
        return world.models['bystander'].state()
    assert finite
    return bystander


def check_bystander(state):
    (position, _), (linear, angular) = state
    assert math.dist(position, ASIDE.position) < 1e-2
    assert math.hypot(*linear, *angular) < 1e-2


@given(st.one_of(urdfs(), sdfs()))
def test_valid_model_is_simulated(world, description):
    finite, bystander = isolated(lambda: live(world, description.text))
    assert finite
    check_bystander(bystander)


@given(st.data())
def test_damaged_model_affects_no_other(world, data):
    description = data.draw(st.one_of(urdfs(), sdfs()))
    text = data.draw(damaged(description.text))
    check_bystander(isolated(lambda: survive(world, text)))


@given(st.data())
@settings(max_examples=settings.default.max_examples // 2)
def test_damaged_robot_affects_no_other(world, data):
    text = data.draw(damaged(robot_urdf()))
    check_bystander(isolated(lambda: survive(world, text)))
