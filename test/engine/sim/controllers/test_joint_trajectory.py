"""Trajectories: the recorded path, errors and texts, replacing, cancelling, bad input."""

import math

import pytest
from support.controllers import (
    EFFORT,
    POSITION,
    RECORDED,
    VELOCITY,
    aligned,
    refused,
    sampled,
    spawn_arm,
    start_controller,
)

from rosbots_description.sim.controllers import (
    ControllerError,
    Tolerance,
    Trajectory,
    TrajectoryGoal,
    TrajectoryPoint,
)

NAMES = 'joint1', 'joint2'
REST = 0.0, 0.0
PATH = 0.005  # [rad] greatest distance from the recorded path
PARAMETERS = RECORDED['jtc_position']['controller']
TYPES = {EFFORT: 'effort', POSITION: 'position', VELOCITY: 'velocity'}
NUMBER = 'Trajectory message contains a number'
STATES = {3: 'succeeded', 4: 'aborted'}  # of actionlib


def started(world, interface=POSITION, parameters=PARAMETERS, **more):
    """Return the arm and its running trajectory controller."""
    model, _ = spawn_arm(world, interface, **more)
    kind = f'{TYPES[interface]}_controllers/JointTrajectoryController'
    return model, start_controller(model, 'arm', kind, parameters)


def goal(*points, names=NAMES, **more):
    """Return a goal of points (time, positions), at rest in each."""
    return TrajectoryGoal(trajectory(*points, names=names), **more)


def trajectory(*points, names=NAMES, start_ns=0):
    return Trajectory(
        names,
        [
            TrajectoryPoint(positions, (0.0,) * len(positions), time_from_start=time)
            for time, positions in points
        ],
        start_ns,
    )


@pytest.mark.parametrize('name', ['jtc_effort', 'jtc_position'])
def test_the_recorded_goals_have_the_recorded_path_and_result(name, world):
    scene = RECORDED[name]
    _, arm = started(world, f'hardware_interface/{scene["hardware"][0]}', scene['controller'])
    joints = arm.model.joints.values()
    for recorded in scene['goals']:
        begin = recorded['sent']
        followed = arm.follow(goal(*recorded['points']))
        rows = []
        for step in range(2500 if recorded['state'] == 3 else 400):
            rows.append([step / 1000.0, *(joint.position for joint in joints)])
            world.step()
        assert followed.status == STATES[recorded['state']]
        assert followed.error_code == recorded['result']['error_code']
        if recorded['state'] != 3:
            # The path that is left to a jump is a matter of steps: joint and number differ.
            assert followed.error_string.split(' error ')[0].endswith(' path')
            assert abs(float(followed.error_string.rpartition(' ')[2])) == pytest.approx(
                0.51, abs=0.03
            )
            return
        there = [row for row in scene['trace'] if begin <= row[0] <= begin + 2.4]
        # When the recorded goal was taken is known to the period of the action server only.
        times = aligned(rows, [(row[0] - begin, row[1]) for row in there], 0, 0.0)
        for row, time in zip(there, times, strict=True):
            for joint in (0, 1):
                assert sampled(rows, time, joint) == pytest.approx(row[1 + joint], abs=PATH)


@pytest.mark.parametrize('interface', [EFFORT, POSITION, VELOCITY])
def test_each_interface_reaches_the_goal(interface, world):
    gains = {
        name: {'p': 300.0, 'd': 20.0, 'i': 10.0, 'i_clamp': 10.0}
        if interface == EFFORT
        else {'p': 20.0}
        for name in NAMES
    }
    _, arm = started(
        world, interface, PARAMETERS | {'gains': gains, 'velocity_ff': dict.fromkeys(NAMES, 1.0)}
    )
    followed = arm.follow(goal((0.5, (0.3, -0.2)), (1.0, (0.6, 0.2))))
    assert followed.is_active
    world.run(1700)
    assert (followed.status, followed.error_code, followed.error_string) == ('succeeded', 0, '')
    assert [joint.position for joint in arm.joints] == pytest.approx([0.6, 0.2], abs=0.1)


def test_splines_follow_the_derivatives_that_are_given(world):
    _, arm = started(world)
    arm.play(Trajectory(NAMES, [TrajectoryPoint((1.0, -1.0), time_from_start=1.0)]))
    assert arm.query(world.clock.now_ns + 250_000_000).positions[0] == pytest.approx(0.25)
    arm.play(Trajectory(NAMES, []))
    arm.play(Trajectory(NAMES, [TrajectoryPoint((1.0, -1.0), REST, time_from_start=1.0)]))
    cubic = arm.query(world.clock.now_ns + 250_000_000)
    assert cubic.positions[0] == pytest.approx(3 * 0.25**2 - 2 * 0.25**3)
    assert cubic.velocities[0] == pytest.approx(6 * 0.25 - 6 * 0.25**2)
    arm.play(Trajectory(NAMES, []))
    arm.play(Trajectory(NAMES, [TrajectoryPoint((1.0, -1.0), REST, REST, 1.0)]))
    quintic = arm.query(world.clock.now_ns + 250_000_000)
    assert quintic.positions[0] == pytest.approx(10 * 0.25**3 - 15 * 0.25**4 + 6 * 0.25**5)
    assert arm.query(world.clock.now_ns + 2_000_000_000) == TrajectoryPoint((1.0, -1.0), REST, REST)


def test_a_new_trajectory_replaces_the_rest_without_a_jump(world):
    _, arm = started(world)
    first = arm.follow(goal((1.0, (1.0, 0.0))))
    world.run(500)
    second = arm.follow(goal((1.0, (0.0, 0.5))))
    assert (first.status, second.status) == ('canceled', 'active')
    before = arm.query(world.clock.now_ns)
    world.step()
    after = arm.query(world.clock.now_ns)
    assert after.velocities[0] == pytest.approx(before.velocities[0], abs=0.02)
    world.run(1200)
    assert second.status == 'succeeded'
    assert [joint.position for joint in arm.joints] == pytest.approx([0.0, 0.5], abs=1e-3)


def test_a_trajectory_that_starts_later_keeps_the_current_one_until_then(world):
    _, arm = started(world)
    arm.play(trajectory((1.0, (1.0, 0.0))))
    begin = world.clock.now_ns
    arm.play(trajectory((1.0, (0.0, 0.5)), start_ns=begin + 600_000_000))
    ahead = arm.query(begin + 500_000_000)
    assert ahead.positions == pytest.approx((0.5, 0.0), abs=0.01)
    world.run(1700)
    assert [joint.position for joint in arm.joints] == pytest.approx([0.0, 0.5], abs=1e-3)


def test_a_canceled_goal_stops_within_the_duration_of_a_stop(world):
    _, arm = started(world)
    followed = arm.follow(goal((1.0, (1.0, 0.0))))
    world.run(500)
    done = []
    followed.done.connect(done.append)
    arm.cancel(followed)
    assert done == [followed]
    assert followed.status == 'canceled'
    reached, speed = arm.joints[0].position, arm.query(world.clock.now_ns).velocities[0]
    world.run(1000)  # stop_trajectory_duration is 0.5 s
    gone = arm.joints[0].position - reached
    assert 0.1 * speed < gone < 0.4 * speed
    arm.cancel(followed)
    assert done == [followed]


def test_a_trajectory_without_points_stops_the_joints(world):
    _, arm = started(world)
    followed = arm.follow(goal((1.0, (1.0, 0.0))))
    world.run(500)
    arm.play(Trajectory(NAMES, []))
    assert followed.status == 'canceled'
    world.run(600)
    stood = arm.joints[0].position
    world.run(300)
    assert arm.joints[0].position == pytest.approx(stood, abs=1e-4)


def test_a_stopped_controller_cancels_its_goal_and_rejects_others(world):
    model, arm = started(world)
    followed = arm.follow(goal((1.0, (1.0, 0.0))))
    model.plugin('gazebo_ros_control').manager.switch([], ['arm'])
    assert followed.status == 'canceled'
    late = arm.follow(goal((1.0, (1.0, 0.0))))
    assert (late.status, late.error_code) == ('rejected', -1)
    with pytest.raises(ControllerError, match='Controller is not running'):
        arm.play(trajectory((1.0, (1.0, 0.0))))
    with pytest.raises(ControllerError, match="Can't sample trajectory"):
        arm.query(world.clock.now_ns)


def test_an_end_out_of_tolerance_aborts_after_the_goal_time(world):
    _, arm = started(
        world,
        EFFORT,
        RECORDED['jtc_effort']['controller']
        | {'gains': {name: {'p': 100.0, 'd': 20.0} for name in NAMES}},
    )
    followed = arm.follow(
        goal(
            (0.5, (0.8, 0.0)),
            goal_tolerances={'joint1': Tolerance(0.001)},
            path_tolerances={name: Tolerance(-1.0) for name in NAMES},
            goal_time_tolerance=0.3,
        )
    )
    world.run(780)
    assert followed.is_active
    world.run(40)
    assert (followed.status, followed.error_code) == ('aborted', -5)
    assert followed.error_string.startswith('joint1 goal error -0.0')


@pytest.mark.parametrize(
    ('bad', 'code', 'text'),
    [
        (goal((1.0, (1.0,)), names=('joint1',)), -2, ''),
        (goal((1.0, (1.0, 0.0)), names=('joint1', 'nose')), -2, ''),
        (
            goal((1.0, (1.0, 0.0)), (1.0, (0.5, 0.0))),
            -1,
            'Trajectory message contains waypoints that are not strictly increasing in time.',
        ),
        (goal((1.0, (math.nan, 0.0))), -1, f'{NUMBER} that is not finite.'),
        (goal((math.inf, (0.0, 0.0))), -1, f'{NUMBER} that is not finite.'),
        (goal((1e200, (0.0, 0.0))), -1, f'{NUMBER} beyond 1e+09.'),
        (goal((1.0, (1e300, 0.0))), -1, f'{NUMBER} beyond 1e+09.'),
        (
            goal((1.0, (1.0, 0.0, 0.0))),
            -1,
            'Size mismatch in trajectory point position, velocity or acceleration data.',
        ),
        (
            goal((1.0, ())),
            -1,
            "Quintic spline segment can't be constructed: Endpoint positions can't be empty.",
        ),
        (
            TrajectoryGoal(trajectory((0.1, (1.0, 0.0)), (0.2, (0.5, 0.0)), start_ns=100_000_000)),
            -1,
            'Dropping all 2 trajectory point(s), as they occur before the current time.\n'
            'Last point is 0.701000s in the past.',
        ),
    ],
)
def test_a_bad_goal_is_rejected_and_the_joints_go_on(bad, code, text, world):
    _, arm = started(world)
    world.run(500)
    arm.command((0.4, 0.2), seconds=0.5)
    world.run(500)
    rejected = arm.follow(bad)
    assert (rejected.status, rejected.error_code, rejected.error_string) == ('rejected', code, text)
    world.run(200)
    assert [joint.position for joint in arm.joints] == pytest.approx([0.4, 0.2], abs=1e-3)


def test_points_that_are_past_are_dropped_with_a_warning(world, caplog):
    _, arm = started(world)
    world.run(500)
    arm.play(trajectory((0.1, (9.0, 0.0)), (0.9, (0.5, 0.0)), start_ns=100_000_000))
    assert 'Dropping first 1 trajectory point(s) out of 2' in caplog.text
    world.run(600)
    assert arm.joints[0].position == pytest.approx(0.5, abs=1e-3)


def test_a_goal_of_some_joints_needs_permission(world):
    _, arm = started(world, parameters=PARAMETERS | {'allow_partial_joints_goal': True})
    followed = arm.follow(goal((0.5, (0.5,)), names=('joint2',)))
    world.run(700)
    assert arm.joints[1].position == pytest.approx(0.5, abs=1e-3)
    assert followed.status == 'succeeded'


def test_a_continuous_joint_takes_the_shorter_way(world):
    change = ('name="joint1" type="revolute"', 'name="joint1" type="continuous"')
    _, arm = started(world, change=lambda text: text.replace(*change))
    arm.play(trajectory((0.5, (3.0, 0.0)), (1.0, (3.0, 0.0))))
    world.run(600)
    arm.play(trajectory((1.0, (-3.0, 0.0))))
    world.run(500)
    assert arm.joints[0].position == pytest.approx(math.pi, abs=0.02)


def test_states_and_feedback_come_at_their_rates(world):
    _, arm = started(world)  # 25 Hz and 10 Hz
    states, feedback = [], []
    arm.outputs['state'].connect(states.append)
    followed = arm.follow(goal((1.0, (1.0, -0.5))))
    followed.feedback.connect(feedback.append)
    world.run(1000)
    assert len(states) == 24
    assert len(feedback) == 9
    last = feedback[-1]
    assert last.joint_names == NAMES
    assert last.error.positions[0] == pytest.approx(
        last.desired.positions[0] - last.actual.positions[0]
    )
    assert last.actual.time_from_start == pytest.approx(0.9, abs=0.01)


@pytest.mark.parametrize(
    ('change', 'text'),
    [
        ({'joints': None}, "Could not find 'joints' parameter (namespace: /arm/arm)."),
        ({'joints': ['joint1', 'nose']}, "Could not find joint 'nose' in URDF model."),
        (
            {'joints': ['fixed']},
            "Could not find joint 'fixed' in 'hardware_interface::PositionJointInterface'.",
        ),
    ],
)
def test_bad_parameters_get_upstreams_answer(change, text, world):
    assert refused(started, world, parameters=PARAMETERS | change)[0] == text


def test_a_restored_world_repeats_a_goal_bit_for_bit(world):
    _, arm = started(world, EFFORT, RECORDED['jtc_effort']['controller'])
    followed = arm.follow(goal((0.5, (0.4, -0.3)), (1.0, (0.8, 0.2))))
    world.run(300)
    saved = world.save_state()

    def go():
        world.run(1000)
        return followed.status, [joint.joint.state() for joint in arm.joints]

    first = go()
    assert first[0] == 'succeeded'
    arm.play(Trajectory(NAMES, []))
    world.restore(saved)
    assert followed.is_active
    assert go() == first


@pytest.mark.parametrize('kind', ['pos_vel', 'pos_vel_acc'])
def test_an_interface_that_gazebo_lacks_gets_upstreams_answer(kind, world):
    _, manager = spawn_arm(world)
    type_name = f'{kind}_controllers/JointTrajectoryController'
    name = {'pos_vel': 'PosVel', 'pos_vel_acc': 'PosVelAcc'}[kind]
    assert refused(manager.load, 'arm', type_name, PARAMETERS) == (
        f"This controller requires a hardware interface of type 'hardware_interface::{name}"
        "JointInterface'. Make sure this is registered in the hardware_interface::RobotHW class.",
        "Initializing controller 'arm' failed",
    )
