"""Property tests of topics: any message is handled, and the next valid one takes effect."""

import math

import pytest
from gazebo_msgs.msg import LinkState, ModelState
from geometry_msgs.msg import Twist
from hypothesis import given, settings
from hypothesis import strategies as st
from support.bench import BYSTANDER, NAMES, PLACE, Bench, furnished_world
from support.invariants import numbers_in
from support.isolation import isolated
from support.requests import messages
from support.wire import Wire

from rosbots_description.ros_api.topics import state_commands
from rosbots_description.sim.runtime.divergence_watchdog import PERIOD

NEAR = 1e-3  # [m] permitted drift of the bystander
KINDS = {'set_model_state': ModelState, 'set_link_state': LinkState, 'cmd_vel': Twist}
# Without the ground: raising it lifts all models on it.
LOOSE = tuple(name for name in NAMES if 'ground' not in name)
SENT = st.sampled_from(sorted(KINDS)).flatmap(
    lambda kind: st.tuples(st.just(kind), messages(KINDS[kind], LOOSE))
)


@pytest.fixture(scope='module')
def bench():
    with furnished_world() as world:
        world.run(PERIOD)
        yield Bench(world)


@pytest.fixture
def listeners(bench, monkeypatch):
    """Return the callbacks of topics, by the last part of the name."""
    wire = Wire(monkeypatch)
    monkeypatch.setattr(state_commands, 'rospy', wire)
    state_commands.subscribe_states(bench.server)
    (drive,) = bench.world.models['rosbots'].plugins.values()
    wire.join(drive)
    heard = {name.rpartition('/')[2].lstrip('~'): take for name, take in wire.subscribers.items()}
    assert sorted(heard) == sorted(KINDS)
    return heard


def run_messages(bench, listeners, sent):
    """Deliver messages with some steps after each, then drive; return the final states."""
    world = bench.world
    for kind, message in sent:
        listeners[kind](message)
        world.run(3)
    world.run(2 * PERIOD)
    bystander = world.models[BYSTANDER].pose.position
    world.reset_simulation()
    world.run(PERIOD)
    good = Twist()
    good.linear.x = 0.5
    listeners['cmd_vel'](good)
    world.run(PERIOD)
    wheels = [joint.velocity for joint in world.models['rosbots'].joints.values()]
    finite = all(math.isfinite(x) for m in world.models.values() for x in numbers_in(m.state()))
    return bystander, wheels, finite


@given(sent=st.lists(SENT, min_size=1, max_size=6))
@settings(max_examples=settings.default.max_examples // 2)
def test_any_messages_are_handled(bench, listeners, sent):
    bystander, wheels, finite = isolated(lambda: run_messages(bench, listeners, sent))
    assert math.dist(bystander, PLACE.position) < NEAR
    assert finite
    assert min(wheels) > 0.1  # [rad/s], on the way to 1.9
