"""The controller manager: loading, switching, unloading, conflicts, bad input; states of worlds."""

import contextlib
import math
from itertools import pairwise

import pytest
from support.controllers import EFFORT, POSITION, VELOCITY, refused, spawn_arm, start_controller

from rosbots_description.sim import NotFoundError, World
from rosbots_description.sim.controllers import ControllerError, ControllerManager

GROUP = 'position_controllers/JointGroupPositionController'
ONE = 'position_controllers/JointPositionController'
TRAJECTORY = 'position_controllers/JointTrajectoryController'
EFFORTS = 'effort_controllers/JointGroupEffortController'
BOTH = {'joints': ['joint1', 'joint2']}
STATES = 'joint_state_controller/JointStateController'
PID = 'effort_controllers/JointPositionController'
GAINS = {'joint': 'joint1', 'pid': {'p': 100.0, 'i': 0.01, 'd': 10.0}}
LATER = 300  # steps


def started(world, kind=GROUP):
    """Return the arm, and a running controller of its two joints."""
    model, _ = spawn_arm(world, POSITION)
    return model, start_controller(model, 'arm', kind, BOTH)


def test_a_group_follows_its_command(world):
    model, controller = started(world)
    controller.command([0.5, -0.3])
    world.run(LATER)
    assert [joint.position for joint in model.joints.values()] == pytest.approx(
        [0.5, -0.3], abs=1e-3
    )


def test_states_are_listed_as_upstream(world):
    _, manager = spawn_arm(world, POSITION)
    manager.load('arm', GROUP, BOTH)
    manager.load('states', STATES, {'publish_rate': 50})
    claimed = ((f'hardware_interface::{POSITION.rpartition("/")[2]}', ('joint1', 'joint2')),)
    assert manager.list() == [
        ('arm', 'initialized', GROUP, claimed),
        ('states', 'initialized', STATES, (('hardware_interface::JointStateInterface', ()),)),
    ]
    manager.switch(['arm'])
    assert manager.list()[0].state == 'running'
    manager.switch([], ['arm'])
    assert manager.list()[0].state == 'stopped'


def test_joint_states_come_at_their_rate_in_alphabetical_order(world):
    model, _ = spawn_arm(world)
    extra = [{'name': 'extra', 'position': 0.25}, {'name': 'joint1'}, {'position': 1.0}]
    parameters = {'publish_rate': 100, 'extra_joints': extra}
    came = []
    start_controller(model, 'states', STATES, parameters).outputs['joint_states'].connect(
        lambda reading: came.append((world.clock.steps, reading))
    )
    world.run(100)
    steps = [step for step, _ in came]
    later = steps[1:]  # as upstream, the first one comes at once
    assert [b - a for a, b in pairwise(later)] == [10] * (len(later) - 1)
    assert len(steps) == 11
    assert came[0][1].names == ('joint1', 'joint2', 'extra')
    assert came[0][1].positions[2] == 0.25


FAILED = "Initializing controller 'c' failed"
NO_GAIN = 'No p gain specified for pid.  Namespace: /arm/c/pid'
NOT_FOUND = "Could not find resource '{}' in 'hardware_interface::{}JointInterface'."


@pytest.mark.parametrize(
    ('type_name', 'parameters', 'sentence'),
    [
        (PID, {'joint': 'joint1'}, NO_GAIN),
        (PID, {'joint': 'joint1', 'pid': {'p': 'much'}}, NO_GAIN),
        (PID, {}, 'No joint given (namespace: /arm/c)'),
        (EFFORTS, {'joints': []}, 'List of joint names is empty.'),
        (EFFORTS, {'joints': 'joint1'}, "Failed to getParam 'joints' (namespace: /arm/c)."),
        (
            EFFORTS,
            {'joints': ['joint1', 'nose']},
            f'Exception thrown: {NOT_FOUND.format("nose", "Effort")}',
        ),
        (STATES, {}, "Parameter 'publish_rate' not set"),
    ],
)
def test_bad_parameters_get_upstreams_answer(type_name, parameters, sentence, world):
    _, manager = spawn_arm(world)
    answer = (sentence, 'Failed to initialize the controller', FAILED)
    assert refused(manager.load, 'c', type_name, parameters) == answer
    assert manager.list() == []
    world.run(10)


@pytest.mark.parametrize(
    ('type_name', 'joint', 'interface'), [(PID, 'nose', 'Effort'), (ONE, 'joint1', 'Position')]
)
def test_a_joint_that_the_interface_lacks_gets_upstreams_answer(type_name, joint, interface, world):
    _, manager = spawn_arm(world)
    assert refused(manager.load, 'c', type_name, GAINS | {'joint': joint}) == (
        "Exception thrown while initializing controller 'c'.\n"
        + NOT_FOUND.format(joint, interface),
        FAILED,
    )


def test_an_unknown_or_missing_type_gets_upstreams_answer(world):
    _, manager = spawn_arm(world)
    assert refused(manager.load, 'c', 'my/Controller', {}) == (
        "Could not load controller 'c' because controller type 'my/Controller' does not exist.",
        "Use 'rosservice call controller_manager/list_controller_types' to get the available types",
    )
    assert refused(manager.load, 'c', '', {}) == (
        "Could not load controller 'c' because the type was not specified. Did you load the "
        "controller configuration on the parameter server (namespace: '/arm/c')?",
    )


def test_names_are_unique_and_running_controllers_stay(world):
    _, manager = spawn_arm(world)
    manager.load('c', PID, GAINS)
    assert refused(manager.load, 'c', PID, GAINS) == (
        "A controller named 'c' was already loaded inside the controller manager",
    )
    manager.switch(['c'])
    assert refused(manager.unload, 'c') == (
        "Could not unload controller with name 'c' because it is still running",
    )
    manager.switch([], ['c'])
    manager.unload('c')
    assert refused(manager.unload, 'c') == (
        "Could not unload controller with name 'c' because no controller with this name exists",
    )


def test_a_joint_has_one_running_controller(world):
    _, manager = spawn_arm(world, POSITION)
    manager.load('arm', GROUP, BOTH)
    manager.load('one', ONE, {'joint': 'joint1'})
    manager.switch(['arm'])
    assert refused(manager.switch, ['one']) == (
        'Resource conflict on [joint1].  Controllers = [arm, one, ]',
        'Could not switch controllers, due to resource conflict',
    )
    assert [one.state for one in manager.list()] == ['running', 'initialized']
    manager.switch(['one'], ['arm'])
    assert [one.state for one in manager.list()] == ['stopped', 'running']


def test_strictness_is_upstreams(world):
    _, manager = spawn_arm(world)
    manager.load('c', PID, GAINS)
    assert refused(manager.switch, ['d']) == (
        "Could not start controller with name 'd' because no controller with this name exists",
    )
    assert refused(manager.switch, [], ['d']) == (
        "Could not stop controller with name 'd' because no controller with this name exists",
    )
    assert refused(manager.switch, [], ['c']) == (
        "Could not stop controller 'c' since it is not running",
    )
    manager.switch(['c', 'd'], ['c'], strict=False)
    assert refused(manager.switch, ['c']) == ("Controller 'c' is already running",)
    assert refused(manager.switch, ['c'], ['c']) == (
        "Could no start or stop controller 'c' because of conflicting switching command",
    )
    manager.switch(['c'], ['d'], strict=False)
    assert manager.list()[0].state == 'running'


def test_a_thousand_switches_leave_nothing_behind(world):
    model, manager = spawn_arm(world, POSITION)
    plugin = model.plugin('gazebo_ros_control')
    for i in range(1000):
        name = f'c{i}'
        manager.load(name, GROUP, BOTH)
        manager.switch([name])
        world.step()
        manager.switch([], [name])
        manager.unload(name)
    assert manager.list() == []
    fresh = len([*plugin.components(), *plugin.shared()])
    with World.empty() as other:
        again, _ = spawn_arm(other, POSITION)
        unused = again.plugin('gazebo_ros_control')
        assert fresh == len([*unused.components(), *unused.shared()])
    assert len(world.schedule._hooks) == len(other.schedule._hooks)


@pytest.mark.parametrize('command', [math.nan, math.inf, -math.inf])
def test_a_command_that_is_not_finite_is_refused(command, world):
    model, controller = started(world)
    controller.command([0.1, 0.1])
    with pytest.raises(ValueError, match='finite'):
        controller.command([0.2, command])
    world.run(LATER)
    assert model.joint('joint1').position == pytest.approx(0.1, abs=1e-3)


def test_a_command_of_another_size_is_refused(world):
    model, manager = spawn_arm(world, POSITION)
    manager.load('arm', GROUP, BOTH)
    with pytest.raises(
        ValueError,
        match=r'Dimension of command \(1\) does not match number of '
        r'joints \(2\)! Not executing!',
    ):
        model.controller('arm').command([0.2])


def test_an_unknown_controller_is_named_with_those_that_exist(world):
    model, manager = spawn_arm(world)
    with pytest.raises(NotFoundError, match="no controller 'arm'; its controllers: none"):
        model.controller('arm')
    manager.load('c', PID, GAINS)
    with pytest.raises(NotFoundError, match='its controllers: c'):
        model.controller('arm')


@pytest.mark.parametrize('interface', [EFFORT, POSITION, VELOCITY])
def test_a_restored_world_repeats_bit_for_bit(interface, world):
    kind = interface.rpartition('/')[2].removesuffix('JointInterface').lower()
    name = f'JointGroup{kind.capitalize()}Controller'
    gains = {one: {'p': 80.0, 'i': 5.0, 'd': 3.0, 'i_clamp': 4.0} for one in BOTH['joints']}
    model, manager = spawn_arm(world, interface, {} if kind == 'velocity' else gains)
    controller = start_controller(model, 'arm', f'{kind}_controllers/{name}', BOTH)
    controller.command([0.7, -0.4])
    world.run(50)
    saved = world.save_state()

    def go():
        world.run(100)
        controller.command([-0.2, 0.3])
        world.run(LATER)
        return [joint.state() for joint in model.joints.values()]

    first = go()
    manager.switch([], ['arm'])
    manager.unload('arm')
    world.restore(saved)
    assert model.controller('arm') is controller
    assert go() == first


def test_commands_survive_a_reset_of_the_simulation(world):
    model, controller = started(world)
    controller.command([0.5, -0.3])
    world.run(LATER)
    world.reset_simulation()
    world.run(LATER)
    assert model.joint('joint1').position == pytest.approx(0.5, abs=1e-3)


@pytest.mark.parametrize(('reset', 'position'), [('reset_world', 0.5), ('reset_simulation', 0.0)])
def test_a_trajectory_goes_on_through_a_reset_of_the_world_only(world, reset, position):
    model, controller = started(world, TRAJECTORY)
    joint = model.joint('joint1')
    controller.command([0.5, -0.3], seconds=0.5)
    world.run(250)
    getattr(world, reset)()
    world.run(400)
    assert joint.position == pytest.approx(position, abs=1e-3)
    controller.command([0.5, -0.3], seconds=0.5)
    world.run(600)
    assert joint.position == pytest.approx(0.5, abs=1e-3)


def test_a_controller_that_fails_does_not_stop_the_world(world, caplog):
    model, _ = spawn_arm(world)
    start_controller(model, 'c', PID, GAINS).update = None
    world.run(10)
    assert 'internal fault of RosControl; the simulation goes on' in caplog.text
    assert world.clock.steps == 10


def test_all_types_of_the_recorded_controller_manager_can_be_loaded():
    """The types that Gazebo's manager listed, with the packages that were built there."""
    recorded = {
        'diff_drive_controller/DiffDriveController',
        STATES,
        *(
            f'{kind}_controllers/JointTrajectoryController'
            for kind in ('effort', 'position', 'velocity', 'pos_vel', 'pos_vel_acc')
        ),
        *(
            f'effort_controllers/Joint{what}Controller'
            for what in ('Effort', 'GroupEffort', 'GroupPosition', 'Position', 'Velocity')
        ),
        'position_controllers/JointGroupPositionController',
        'position_controllers/JointPositionController',
        *(
            f'velocity_controllers/Joint{what}Controller'
            for what in ('GroupVelocity', 'Position', 'Velocity')
        ),
    }
    types = ControllerManager.types()
    assert {base for _, base in types} == {'controller_interface::ControllerBase'}
    assert recorded <= {name for name, _ in types}


@pytest.mark.parametrize('huge', [1e300, 1e-300, -1e300, 10**400])
@pytest.mark.parametrize(
    ('kind', 'paths'),
    [
        (PID, ['pid/p', 'pid/i', 'pid/d', 'pid/i_clamp']),
        (STATES, ['publish_rate']),
        (
            'effort_controllers/GripperActionController',
            ['stall_timeout', 'goal_tolerance', 'max_effort', 'gains/joint1/p'],
        ),
        (
            'effort_controllers/JointTrajectoryController',
            [
                'stop_trajectory_duration',
                'state_publish_rate',
                'action_monitor_rate',
                'constraints/goal_time',
                'gains/joint1/p',
            ],
        ),
    ],
)
def test_absurd_parameters_neither_stop_the_world_nor_make_it_diverge(kind, paths, huge, world):
    model, _ = spawn_arm(world)
    parameters = {
        'joint': 'joint1',
        'joints': ['joint1'],
        'publish_rate': 50.0,
        'pid': {'p': 1.0},
        'gains': {'joint1': {'p': 1.0}},
        'constraints': {},
    }
    for path in paths:
        *sections, last = path.split('/')
        inner = parameters
        for section in sections:
            inner = inner.setdefault(section, {})
        inner[last] = huge
    with contextlib.suppress(ControllerError):
        controller = start_controller(model, 'c', kind, parameters)
        if hasattr(controller, 'command'):
            wanted = 0.5 if kind != 'effort_controllers/JointTrajectoryController' else [0.5]
            controller.command(wanted)
    world.run(200)
    assert world.rebuilds == 0
    assert not model.has_diverged()


def test_a_command_that_overflows_is_none(world):
    model, _ = spawn_arm(world)
    gains = GAINS | {'pid': {'p': 1e200, 'd': -1e200}}
    start_controller(model, 'c', PID, gains).command(1e200)
    world.run(50)
    assert not model.has_diverged()
    assert world.rebuilds == 0
