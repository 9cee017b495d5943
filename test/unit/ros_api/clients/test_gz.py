"""What the commands of gz ask of the simulator, and what they print."""

import os
from itertools import count
from types import SimpleNamespace

import pytest
from gazebo_msgs.msg import ODEPhysics
from gazebo_msgs.srv import GetPhysicsPropertiesResponse
from geometry_msgs.msg import Point, Pose, Quaternion, Twist, Vector3
from support.programs import python

from rosbots_description.cli.gz import parser
from rosbots_description.ros_api.clients import gz, service_program
from rosbots_description.sim import from_rpy

STATE = SimpleNamespace(
    pose=Pose(Point(1.0, -2.5, 1e-9), Quaternion(*from_rpy(0.0, -1e-12, 0.25))),
    twist=Twist(linear=Vector3(3.0, 0.0, 0.0)),
)
PHYSICS = GetPhysicsPropertiesResponse(
    time_step=0.001,
    max_update_rate=1000.0,
    gravity=Vector3(0.0, 0.0, -9.8),
    ode_config=ODEPhysics(sor_pgs_iters=50, max_contacts=20),
)


class Simulator:
    """Records the calls of services, and gives the responses that a test wants."""

    def __init__(self, **responses):
        self.calls = []
        self._responses = responses

    def __call__(self, service, _type, **request):
        self.calls.append((service, request))
        response = self._responses.get(service)
        return next(response) if hasattr(response, '__next__') else response


def do(simulator, *arguments, **options):
    """Return the lines that a command prints."""
    flags = parser().parse_args(arguments)
    return list(gz.COMMANDS[flags.command](simulator, flags, **options))


@pytest.mark.parametrize(
    ('options', 'services'),
    [
        (['-p', '1'], ['pause_physics']),
        (['-p', '0'], ['unpause_physics']),
        (['-s'], ['pause_physics', 'step']),
        (['-r'], ['reset_simulation']),
        (['-o'], ['reset_world']),
        (
            ['-r', '-m', '2', '-p', '0'],
            ['unpause_physics', 'pause_physics', 'step', 'reset_simulation'],
        ),
    ],
)
def test_world_calls_services_in_gazebos_order(options, services):
    simulator = Simulator()
    assert do(simulator, 'world', *options) == []
    assert [service for service, _ in simulator.calls] == services


@pytest.mark.parametrize(('options', 'steps'), [(['-s'], 1), (['-m', '25'], 25)])
def test_world_makes_as_many_steps_as_asked(options, steps):
    simulator = Simulator()
    do(simulator, 'world', *options)
    assert simulator.calls[-1] == ('step', {'steps': steps})


def test_time_alone_is_not_reset_and_nothing_else_is_done():
    simulator = Simulator()
    with pytest.raises(gz.CommandError, match='time alone cannot be reset'):
        do(simulator, 'world', '-t', '-p', '1')
    assert simulator.calls == []


def test_a_list_has_one_model_per_line():
    simulator = Simulator(get_world_properties=SimpleNamespace(model_names=['ground', 'box']))
    assert do(simulator, 'model', '-l') == ['ground', 'box']


def test_a_pose_is_six_numbers_with_six_digits():
    simulator = Simulator(get_model_state=STATE)
    assert do(simulator, 'model', '-m', 'box', '-p') == ['1 -2.5 0 0 0 0.25']


def test_a_model_is_moved_at_the_velocity_that_it_has():
    simulator = Simulator(get_model_state=STATE)
    do(simulator, 'model', '-m', 'box', '-x', '4', '-Y', '0.5')
    service, request = simulator.calls[-1]
    state = request['model_state']
    assert (service, state.model_name, state.reference_frame) == ('set_model_state', 'box', '')
    assert state.pose == Pose(Point(4.0, 0.0, 0.0), Quaternion(*from_rpy(0.0, 0.0, 0.5)))
    assert state.twist == STATE.twist


def test_a_model_is_spawned_from_a_file_under_the_name_that_is_given(tmp_path):
    file = tmp_path / 'box.sdf'
    file.write_text('<sdf version="1.6"><model name="other"/></sdf>')
    simulator = Simulator()
    assert do(simulator, 'model', '-f', str(file), '-m', 'box', '-z', '2') == []
    ((service, request),) = simulator.calls
    assert (service, request['model_name']) == ('spawn_sdf_model', 'box')
    assert request['model_xml'] == file.read_text()
    assert request['initial_pose'].position == Point(0.0, 0.0, 2.0)


def test_info_names_joints_and_links_by_their_scoped_names():
    simulator = Simulator(
        get_model_state=STATE,
        get_model_properties=SimpleNamespace(
            is_static=False, joint_names=['hinge'], body_names=['arm']
        ),
    )
    lines = do(simulator, 'model', '-m', 'box', '-i')
    assert lines[:2] == ['name: "box"', 'is_static: false']
    assert '    y: -2.5' in lines
    assert str(lines).count('{') == str(lines).count('}')
    assert lines[-6:-3] == ['joint {', '  name: "box::hinge"', '}']
    assert lines[-3:] == ['link {', '  name: "box::arm"', '}']


def test_physics_changes_what_is_given_and_keeps_the_rest():
    simulator = Simulator(get_physics_properties=PHYSICS)
    do(simulator, 'physics', '-g', '0,0,-3.7', '-i', '80')
    service, request = simulator.calls[-1]
    assert service == 'set_physics_properties'
    assert (request['time_step'], request['max_update_rate']) == (0.001, 1000.0)
    assert request['gravity'] == Vector3(0.0, 0.0, -3.7)
    assert (request['ode_config'].sor_pgs_iters, request['ode_config'].max_contacts) == (80, 20)


def stats(times, *options, paused=False):
    """Return what `gz stats` prints of these simulated times, 0.25 s of wall time apart."""
    simulator = Simulator(
        get_world_properties=(SimpleNamespace(sim_time=time) for time in times),
        get_physics_properties=SimpleNamespace(pause=paused),
    )
    wall = count(100.0, 0.25)
    options = '-d', str(0.25 * (len(times) - 1) + 0.01), *options
    return do(simulator, 'stats', *options, clock=lambda: next(wall), sleep=lambda _seconds: None)


def test_stats_prints_gazebos_line_until_the_duration_is_over():
    assert stats([5.0, 5.125, 5.25, 5.25]) == [
        'Factor[0.50] SimTime[5.12] RealTime[0.50] Paused[F]',
        'Factor[0.50] SimTime[5.25] RealTime[0.75] Paused[F]',
    ]


def test_stats_for_a_plot_has_a_heading():
    heading, line = stats([0.0, 0.5, 0.5], '-p', paused=True)
    assert heading.startswith('# real-time factor')
    assert line == '2.00,         0.500000,         0.500000, T'


def test_the_factor_forgets_what_was_long_ago():
    slow, fast = [0.0] * 30, [0.5 * number for number in range(1, 41)]
    assert stats([*slow, *fast, 0.0])[-1].startswith('Factor[2.00] ')


def test_the_factor_of_time_that_was_reset_is_zero():
    assert gz.real_time_factor([(9.0, 0.0), (0.2, 0.2)]) == 0.0


def test_a_pipe_whose_other_end_is_closed_has_no_reader():
    read, write = os.pipe()
    assert service_program._has_reader(write)
    os.close(read)
    assert not service_program._has_reader(write)
    os.close(write)


@pytest.mark.parametrize('fails', [False, True])
def test_names_of_models_do_nothing_to_the_terminal(monkeypatch, capsys, fails):
    def act(_call):
        if fails:
            raise service_program.CommandError('\x1b]0;title\x07\x9b2J\u202e')
        yield 'a\x1b]0;title\x07\x9b2J\u202e\n\tb'

    monkeypatch.setattr(service_program, '_connect', lambda *_: None)
    monkeypatch.setattr(service_program.rospy, 'signal_shutdown', lambda _: None)  # for good
    assert service_program.run('gz model', act, []) == int(fails)
    printed, said = capsys.readouterr()
    escaped = r'\x1b]0;title\x07\x9b2J\u202e'
    assert (printed, said) == (
        ('', f'gz model: {escaped}\n') if fails else (f'a{escaped}\n\tb\n', '')
    )


def test_import_loads_no_simulator():
    ended = python(
        'import sys; import rosbots_description.ros_api.clients.gz; '
        "print(*(name for name in sys.modules if name.endswith(('pybullet', '.sim.runtime'))))"
    )
    assert (ended.stdout.strip(), ended.stderr) == ('', '')
