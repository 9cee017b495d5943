"""The diff_drive_controller drives as the plugin of that name, and as recorded in Gazebo."""

import math
from itertools import pairwise

import pytest
from support.controllers import RECORDED, refused, start_controller
from support.recorded import DATA

from rosbots_description.sim import World, yaw_of
from rosbots_description.sim.controllers import ControllerError

TEXT = (DATA / 'robots' / 'burger_ros_control.urdf').read_text()
CONTROL = TEXT[TEXT.index('<gazebo><plugin name="gazebo_ros_control"') : TEXT.index('</robot>')]
PLUGIN = """<gazebo><plugin name="drive" filename="libgazebo_ros_diff_drive.so">
<leftJoint>wheel_left_joint</leftJoint><rightJoint>wheel_right_joint</rightJoint>
<wheelSeparation>0.16</wheelSeparation><wheelDiameter>0.066</wheelDiameter>
<wheelTorque>1e9</wheelTorque><updateRate>0</updateRate></plugin></gazebo>"""
TYPE = 'diff_drive_controller/DiffDriveController'
PARAMETERS = {
    'left_wheel': 'wheel_left_joint',
    'right_wheel': ['wheel_right_joint'],
    'pose_covariance_diagonal': [0.001, 0.001, 1e6, 1e6, 1e6, 1000.0],
    'twist_covariance_diagonal': [0.001, 0.001, 1e6, 1e6, 1e6, 1000.0],
    'base_frame_id': 'base_footprint',
}
RAMP = {'linear': {'x': {'has_acceleration_limits': True, 'max_acceleration': 1.0}}}
FORWARD, YAW_RATE = 0.2, 0.5


def spawned(world, parameters=PARAMETERS):
    """Return the robot at rest, and its controller, which runs."""
    robot = world.spawn(TEXT, name='bot')
    drive = start_controller(robot, 'drive', TYPE, parameters)
    world.run(500)
    return robot, drive


def test_a_robot_moves_alike_with_the_controller_and_with_the_plugin(world):
    robot, drive = spawned(world, PARAMETERS | {'cmd_vel_timeout': 60.0})
    with World.empty() as other:
        twin = other.spawn(TEXT.replace(CONTROL, PLUGIN), name='bot')
        other.run(500)
        for driven, owner in ((drive, world), (twin.plugin('drive'), other)):
            driven.command(FORWARD, YAW_RATE)
            owner.run(2000)
            driven.command(0.0, -1.0)
            owner.run(1000)
        assert robot.pose.position == pytest.approx(twin.pose.position, abs=1e-9)
        assert yaw_of(robot.pose.orientation) == pytest.approx(
            yaw_of(twin.pose.orientation), abs=1e-9
        )


def test_a_drive_moves_as_recorded(world):
    """3.02 s of 0.2 m/s and 0.5 rad/s, up at 1 m/s^2; then the command expires, 0.5 s later."""
    _, drive = spawned(world, PARAMETERS | RAMP)
    recorded = RECORDED['diff_drive']
    begin = next(row[0] for row in recorded['odometry'] if row[4] > 0.4) - 0.011
    readings = []
    drive.outputs['odometry'].connect(lambda reading: readings.append((world.time, reading)))
    start, x, y = world.time, drive.planar.x, drive.planar.y
    for _ in range(300):
        drive.command(FORWARD, YAW_RATE)
        world.run(10)
    reached = [row for row in recorded['odometry'] if begin < row[0] < begin + 2.9]
    for time, east, north, forward, yaw_rate in reached:
        when, ours = min(readings, key=lambda one: abs(one[0] - start - (time - begin)))
        assert abs(when - start - (time - begin)) < 0.02
        shift = FORWARD * (when - start - (time - begin))
        assert ours.pose.position[0] - x == pytest.approx(east, abs=0.004 + abs(shift))
        assert ours.pose.position[1] - y == pytest.approx(north, abs=0.004 + abs(shift))
        if time - begin > 0.4:
            assert ours.twist.linear[0] == pytest.approx(forward, abs=0.006)
            assert ours.twist.angular[2] == pytest.approx(yaw_rate, abs=0.03 * YAW_RATE)
    assert len(reached) > 60


def test_odometry_comes_at_its_rate_with_its_transform(world):
    _, drive = spawned(world, PARAMETERS | {'publish_rate': 20.0, 'odom_frame_id': 'wheels'})
    steps, frames = [], []
    drive.outputs['odometry'].connect(lambda reading: steps.append(world.clock.steps))
    drive.outputs['odometry_transform'].connect(frames.append)
    world.run(500)
    assert [b - a for a, b in pairwise(steps)] == [50] * 9
    assert {(one.parent, one.child) for one in frames} == {('wheels', 'base_footprint')}
    drive.enable_odom_tf = False
    frames.clear()
    world.run(100)
    assert frames == []


def test_a_command_expires(world):
    robot, drive = spawned(world)
    drive.command(FORWARD, 0.0)
    world.run(490)
    assert robot.twist.linear[0] == pytest.approx(FORWARD, rel=0.05)
    world.run(200)
    assert robot.twist.linear[0] == pytest.approx(0.0, abs=0.005)


def test_what_is_not_given_is_read_from_the_urdf(world):
    _, drive = spawned(world)
    assert drive.wheel_separation == pytest.approx(0.16)
    assert drive.wheel_radius_given == 0.033


def test_a_command_is_limited_and_reported(world):
    _, drive = spawned(
        world,
        PARAMETERS
        | {
            'publish_cmd': True,
            'linear': {
                'x': {
                    'has_velocity_limits': True,
                    'max_velocity': 0.1,
                    'has_jerk_limits': True,
                    'max_jerk': 50.0,
                }
            },
        },
    )
    sent = []
    drive.outputs['limited_command'].connect(sent.append)
    drive.command(1.0, 0.25)
    world.run(400)
    speeds = [twist.linear[0] for twist in sent]
    assert max(speeds) == speeds[-1] == pytest.approx(0.1)
    jerks = [
        (c - 2 * b + a) / 2e-6 for a, b, c in zip(speeds, speeds[1:], speeds[2:], strict=False)
    ]
    assert max(jerks) == pytest.approx(50.0, rel=1e-3)
    assert {twist.angular[2] for twist in sent} == {0.25}


@pytest.mark.parametrize(
    ('change', 'text'),
    [
        ({'left_wheel': None}, "Couldn't retrieve wheel param 'left_wheel'."),
        ({'left_wheel': []}, "Wheel param 'left_wheel' is an empty list"),
        ({'left_wheel': 3}, "Wheel param 'left_wheel' is neither a list of strings nor a string."),
        ({'left_wheel': ['a', 3]}, "Wheel param 'left_wheel' #1 isn't a string."),
        ({'left_wheel': ['wheel_left_joint'] * 2}, '#left wheels (2) != #right wheels (1).'),
        ({'left_wheel': 'nose'}, "nose couldn't be retrieved from model description"),
        ({'wheel_radius': 0.0}, 'wheel_radius is 0 m; it must be above 0'),
        ({'wheel_radius': 1e300}, 'wheel_radius is 1e+300 m; it must be below 1e+06'),
        (
            {'wheel_separation_multiplier': 0.0},
            'wheel_separation_multiplier is 0; it must be above 0, and about 1',
        ),
        (
            {'wheel_radius_multiplier': -1.0},
            'wheel_radius_multiplier is -1; it must be above 0, and about 1',
        ),
        ({'right_wheel': 'wheel_left_joint'}, 'wheel_separation is 0 m; it must be above 0'),
    ],
)
def test_bad_parameters_get_a_clear_answer(change, text, world):
    assert text in refused(spawned, world, PARAMETERS | change)


def test_commands_are_refused_while_it_does_not_run_or_if_they_are_not_finite(world):
    robot, drive = spawned(world)
    with pytest.raises(ValueError, match='finite'):
        drive.command(math.nan, 0.0)
    robot.plugin('gazebo_ros_control').manager.switch([], ['drive'])
    with pytest.raises(ControllerError, match='Controller is not running'):
        drive.command(FORWARD, 0.0)


def test_the_states_of_wheels_are_reported_on_request(world):
    _, drive = spawned(
        world,
        PARAMETERS
        | {
            'publish_wheel_joint_controller_state': True,
            'cmd_vel_timeout': 9.0,
            'linear': {'x': {'has_velocity_limits': True, 'max_velocity': 0.1}},
        },
    )
    states = []
    drive.outputs['wheel_states'].connect(states.append)
    before = drive.left[0].position
    drive.command(FORWARD, 0.0)
    world.run(500)
    assert len(states) == 500
    last = states[-1]
    assert last.joint_names == ('wheel_left_joint', 'wheel_right_joint')
    assert last.desired.velocities == pytest.approx([FORWARD / 0.033] * 2)
    assert last.desired.positions == pytest.approx([0.5 * FORWARD / 0.033] * 2)
    assert last.actual.velocities == pytest.approx([0.1 / 0.033] * 2, rel=0.01)
    assert last.error.velocities[0] == last.desired.velocities[0] - last.actual.velocities[0]
    assert last.actual.positions[0] > before
    assert math.isnan(last.desired.efforts[0])


@pytest.mark.parametrize('absurd', [1e300, -1e300, 1e-300])
@pytest.mark.parametrize(
    'path',
    [
        'publish_rate',
        'cmd_vel_timeout',
        'velocity_rolling_window_size',
        'linear/x/max_velocity',
        'linear/x/max_acceleration',
        'linear/x/max_jerk',
    ],
)
def test_absurd_parameters_neither_stop_the_world_nor_make_it_diverge(path, absurd, world):
    section, _, name = path.rpartition('/')
    limits = {f'has_{what}_limits': True for what in ('velocity', 'acceleration', 'jerk')}
    given = {'linear': {'x': {name: absurd} | limits}} if section else {name: absurd}
    robot, drive = spawned(world, PARAMETERS | given)
    drive.command(1e300, 1e300)
    world.run(100)
    assert world.rebuilds == 0
    assert not robot.has_diverged()
