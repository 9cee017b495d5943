"""Friction that is read and changed while the world runs."""

import math

import pytest
from rosbots_msgs.srv import GetFrictionRequest, SetFrictionRequest
from support import urdf_spec
from support.bench import Bench, box_urdf, empty_world

from rosbots_description.sim.core.transforms import Pose, Twist
from rosbots_description.sim.formats import load_sdf

GRAVITY = 9.8  # [m/s^2]
BALL = """<link name="{}"><collision name="c"><geometry><sphere><radius>0.1</radius></sphere>
</geometry></collision></link>"""
NESTED = f"""<sdf version="1.6"><model name="outer">{BALL.format('body')}
<model name="arm">{BALL.format('hand')}</model></model></sdf>"""
TWO = """<gazebo reference="box"><mu1>0.5</mu1><mu2>0.25</mu2></gazebo>"""


@pytest.fixture
def bench():
    with empty_world() as world:
        world.spawn(urdf_spec(box_urdf('1 1 1', 2.0, TWO)), 'a', Pose((0.0, 0.0, 0.5)))
        world.run(100)
        yield Bench(world)


def friction(bench, name):
    answer = bench.call('get_friction', GetFrictionRequest(name))
    assert answer.success, answer.status_message
    return dict(zip(answer.collision_names, zip(answer.mu, answer.mu2, strict=True), strict=True))


def deceleration(bench):
    """Return how fast the box slows down in a slide along x [m/s^2]."""
    model = bench.world.models['a']
    model.set_twist(Twist((2.0, 0.0, 0.0)))
    bench.world.run(200)
    return (2.0 - model.twist.linear[0]) / 0.2


@pytest.mark.parametrize('name', ['a', 'a::box', 'a::box::box_collision'])
def test_friction_changes_and_acts_at_once(bench, name):
    assert friction(bench, name) == {'a::box::box_collision': (0.5, 0.25)}
    model = bench.world.models['a']
    before = model.pose
    assert bench.call('set_friction', SetFrictionRequest(name, 0.1, 0.1)).success
    assert model.pose.position == pytest.approx(before.position, abs=1e-9)
    assert friction(bench, name) == {'a::box::box_collision': (0.1, 0.1)}
    assert deceleration(bench) == pytest.approx(0.1 * GRAVITY, rel=0.05)
    assert bench.call('set_friction', SetFrictionRequest(name, 0.4, 0.4)).success
    assert deceleration(bench) == pytest.approx(0.4 * GRAVITY, rel=0.05)


@pytest.mark.parametrize(
    ('request_', 'sentence'),
    [
        (SetFrictionRequest('b', 1.0, 1.0), "there is no model, link or collision named 'b'"),
        (SetFrictionRequest('a', 1.0, -0.5), "friction of 'a' is -0.5; it must not be negative"),
        (SetFrictionRequest('a', math.nan, 1.0), 'mu is nan; it must be a finite number'),
    ],
)
def test_what_cannot_be_is_refused_in_a_sentence(bench, request_, sentence):
    answer = bench.call('set_friction', request_)
    assert (answer.success, answer.status_message) == (False, f'SetFriction: Failure - {sentence}')
    assert friction(bench, 'a') == {'a::box::box_collision': (0.5, 0.25)}


def test_a_nested_model_has_the_friction_of_its_own_links(bench):
    outer, _ = load_sdf(NESTED, 'outer', find_model=lambda _: None)
    bench.world.spawn(outer, 'outer', Pose((5.0, 0.0, 1.0)))
    assert bench.call('set_friction', SetFrictionRequest('outer::arm', 0.2, 0.1)).success
    assert friction(bench, 'outer') == {
        'outer::body::c': (1.0, 1.0),
        'outer::arm::hand::c': (0.2, 0.1),
    }


def test_a_link_that_touches_nothing_has_no_friction(bench):
    ghost = urdf_spec(
        '<link name="ghost"><inertial><mass value="1"/><inertia ixx="1" iyy="1" '
        'izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>'
    )
    bench.world.spawn(ghost, 'ghost', Pose((5.0, 0.0, 1.0)))
    assert friction(bench, 'ghost') == {}
    answer = bench.call('set_friction', SetFrictionRequest('ghost::ghost', 1.0, 1.0))
    assert answer.status_message.endswith("'ghost::ghost' has no collision, so it has no friction")
