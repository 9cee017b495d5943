"""A gripper's joint closes to a position, or until it stalls."""

import math

import pytest
from support.controllers import EFFORT, POSITION, refused, spawn_arm

GAINS = {'gains': {'joint2': {'p': 100.0, 'd': 5.0}}}
PARAMETERS = {'joint': 'joint2', 'max_effort': 40.0, 'stall_timeout': 0.2}


def started(world, interface=EFFORT, parameters=PARAMETERS):
    """Return the running controller, of the second joint of an arm whose first one is held."""
    model, manager = spawn_arm(world, interface)
    kind = 'effort' if interface == EFFORT else 'position'
    manager.load('grip', f'{kind}_controllers/GripperActionController', parameters | GAINS)
    hold = {'joint': 'joint1', 'pid': {'p': 500.0, 'd': 50.0}}
    manager.load('hold', f'{kind}_controllers/JointPositionController', hold)
    manager.switch(['grip', 'hold'])
    return model.controller('grip')


@pytest.mark.parametrize('interface', [EFFORT, POSITION])
def test_a_goal_succeeds_within_its_tolerance(interface, world):
    grip = started(world, interface)
    goal = grip.follow(0.05, 40.0)
    done = []
    goal.done.connect(done.append)
    world.run(1000)
    assert done == [goal]
    assert goal.status == 'succeeded'
    assert (goal.result.reached_goal, goal.result.stalled) == (True, False)
    assert goal.result.position == pytest.approx(0.05, abs=0.01)


def test_a_goal_is_aborted_where_the_joint_stalls(world):
    grip = started(world)
    goal = grip.follow(3.0, 20.0)  # beyond the stop at 2.5
    world.run(3000)
    assert (goal.status, goal.result.reached_goal, goal.result.stalled) == ('aborted', False, True)
    assert goal.result.effort == pytest.approx(20.0)
    assert goal.result.position == pytest.approx(2.5, abs=0.01)


def test_a_new_goal_a_cancel_and_a_stop_cancel(world):
    grip = started(world)
    first, second = grip.follow(0.5, 40.0), grip.follow(0.6, 40.0)
    assert (first.status, second.status) == ('canceled', 'active')
    grip.cancel(first)
    grip.cancel(second)
    assert second.status == 'canceled'
    third = grip.follow(0.4, 40.0)
    world.run(2)
    grip.model.plugin('gazebo_ros_control').manager.switch([], ['grip'])
    assert third.status == 'canceled'
    assert grip.follow(0.4, 40.0).status == 'rejected'


@pytest.mark.parametrize(
    ('change', 'text'),
    [
        ({'joint': None}, 'Could not find joint name on param server'),
        ({'joint': 'nose'}, "Could not find joint 'nose' in URDF model."),
        (
            {'joint': 'fixed'},
            "Could not find joint 'fixed' in 'hardware_interface::EffortJointInterface'.",
        ),
    ],
)
def test_bad_parameters_get_upstreams_answer(change, text, world):
    assert refused(started, world, parameters=PARAMETERS | change)[0] == text


def test_what_is_not_finite_is_refused(world):
    grip = started(world)
    with pytest.raises(ValueError, match='finite'):
        grip.follow(math.nan, 1.0)
    grip.command(0.1)
    world.run(500)
    assert grip.handle.position == pytest.approx(0.1, abs=0.05)
