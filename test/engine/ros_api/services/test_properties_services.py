"""Property tests of services: any request is answered, and the world remains intact."""

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support.bench import (
    ALL,
    BOX,
    BYSTANDER,
    DOOR,
    LAMP,
    NAMES,
    NESTED,
    PLACE,
    Bench,
    furnished_world,
)
from support.invariants import numbers_in
from support.isolation import isolated
from support.mutations import damaged
from support.requests import TEXTS, messages

from rosbots_description.sim.description.physics_settings import PhysicsSettings
from rosbots_description.sim.runtime.divergence_watchdog import PERIOD

MOST_STEPS = 50  # limits the requested number of steps
NEAR = 1e-3  # [m] permitted drift of the bystander


@pytest.fixture(scope='module')
def bench():
    with furnished_world() as world:
        world.run(PERIOD)
        yield Bench(world)


def requests(name):
    """Return a strategy for calls of a service: its name and a request."""
    strategy = messages(ALL[name].type._request_class, NAMES)
    if name.startswith(('spawn_', 'insert_')):
        texts = st.sampled_from((BOX, DOOR, NESTED, LAMP)) | damaged(BOX) | damaged(NESTED) | TEXTS
        strategy = st.builds(_set, strategy, st.just('model_xml'), texts)
    if name == 'step':
        strategy = st.builds(_set, strategy, st.just('steps'), st.integers(0, MOST_STEPS))
    return st.tuples(st.just(name), strategy)


def _set(message, field, value):
    setattr(message, field, value)
    return message


CALLS = st.lists(st.sampled_from(sorted(ALL)).flatmap(requests), min_size=1, max_size=5)


def run_calls(bench, calls):
    """Make the calls with some steps after each, reset; return the pose of the bystander."""
    world = bench.world
    for name, request in calls:
        bench.call(name, request)
        world.run(3)
    world.run(PERIOD)  # diverged models have been rebuilt
    check_untouched(world)
    world.set_physics(PhysicsSettings())
    world.reset_simulation()
    assert world.clock.now_ns == 0
    for model in world.models.values():
        assert model.pose.position == pytest.approx(model.initial_pose.position)
        turns = zip(model.pose.orientation, model.initial_pose.orientation, strict=True)
        assert abs(sum(a * b for a, b in turns)) == pytest.approx(1.0)  # q and -q are equal
    world.run(PERIOD)
    check_untouched(world)
    return world.models[BYSTANDER].pose.position


def check_untouched(world):
    assert all(map(math.isfinite, numbers_in(world.models[BYSTANDER].state())))


@given(CALLS)
@settings(max_examples=settings.default.max_examples // 2)
def test_any_calls_are_answered_and_a_reset_restores_the_world(bench, calls):
    position = isolated(lambda: run_calls(bench, calls))
    assert math.dist(position, PLACE.position) < NEAR


@pytest.mark.parametrize('name', sorted(ALL))
@given(data=st.data())
@settings(max_examples=1 + settings.default.max_examples // 20)
def test_each_service_answers_any_request(bench, name, data):
    calls = data.draw(st.lists(requests(name), min_size=5, max_size=10))
    isolated(lambda: run_calls(bench, calls))
