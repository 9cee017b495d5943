"""Whatever a service is asked, it answers, and the world lives on."""

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

MOST_STEPS = 50  # as many as are asked for are made, so not too many
NEAR = 1e-3  # [m] as far as a box that nobody touches may be from where it stood


@pytest.fixture(scope='module')
def bench():
    with furnished_world() as world:
        world.run(PERIOD)
        yield Bench(world)


def requests(name):
    """Return a strategy for calls of a service: its name and a request."""
    strategy = messages(ALL[name].type._request_class, NAMES)
    if name.startswith('spawn_'):
        texts = st.sampled_from((BOX, DOOR, NESTED, LAMP)) | damaged(BOX) | damaged(NESTED) | TEXTS
        strategy = st.builds(_set, strategy, st.just('model_xml'), texts)
    if name == 'step':
        strategy = st.builds(_set, strategy, st.just('steps'), st.integers(0, MOST_STEPS))
    return st.tuples(st.just(name), strategy)


def _set(message, field, value):
    setattr(message, field, value)
    return message


CALLS = st.lists(st.sampled_from(sorted(ALL)).flatmap(requests), min_size=1, max_size=5)


def live(bench, calls):
    """Make the calls, with some steps after each; begin again; return where the bystander is."""
    world = bench.world
    for name, request in calls:
        bench.call(name, request)
        world.run(3)
    world.run(PERIOD)  # whatever was broken has been rebuilt
    check_untouched(world)
    world.set_physics(PhysicsSettings())
    world.reset_simulation()
    assert world.clock.now_ns == 0
    for model in world.models.values():
        assert model.pose.position == pytest.approx(model.initial_pose.position)
        turns = zip(model.pose.orientation, model.initial_pose.orientation, strict=True)
        assert abs(sum(a * b for a, b in turns)) == pytest.approx(1.0)  # either sign means the same
    world.run(PERIOD)
    check_untouched(world)
    return world.models[BYSTANDER].pose.position


def check_untouched(world):
    assert all(map(math.isfinite, numbers_in(world.models[BYSTANDER].state())))


@given(CALLS)
@settings(max_examples=settings.default.max_examples // 2)
def test_services_answer_whatever_they_are_asked_and_a_reset_mends_all(bench, calls):
    position = isolated(lambda: live(bench, calls))
    assert math.dist(position, PLACE.position) < NEAR


@pytest.mark.parametrize('name', sorted(ALL))
@given(data=st.data())
@settings(max_examples=1 + settings.default.max_examples // 20)
def test_each_service_answers(bench, name, data):
    calls = data.draw(st.lists(requests(name), min_size=5, max_size=10))
    isolated(lambda: live(bench, calls))
