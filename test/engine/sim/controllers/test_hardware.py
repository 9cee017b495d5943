"""The simulated hardware: tags of the plugin, transmissions, limits, mimic joints, e-stop."""

import math

import pytest
from support.controllers import (
    EFFORT,
    POSITION,
    VELOCITY,
    arm,
    first_joint_only,
    spawn_arm,
    start_controller,
)

from rosbots_description.sim import PluginError
from rosbots_description.sim.controllers import ControllerError
from rosbots_description.sim.core import IDENTITY
from rosbots_description.sim.formats import load_robot_control, load_urdf, sdf_of_model

BOTH = {'joints': ['joint1', 'joint2']}
STILL = 1e-3  # [rad]
TYPES = {
    EFFORT: 'effort_controllers/JointGroupEffortController',
    POSITION: 'position_controllers/JointGroupPositionController',
    VELOCITY: 'velocity_controllers/JointGroupVelocityController',
}


def started(world, interface, command, **more):
    """Return the arm under a command."""
    model, _ = spawn_arm(world, interface, **more)
    start_controller(model, 'arm', TYPES[interface], BOTH).command(command)
    return model


def plugin_tags(tags):
    """Return a change of a URDF that adds tags to the plugin."""
    return lambda text: text.replace('</robotNamespace>', f'</robotNamespace>{tags}')


def spawned(world, change):
    """Spawn the arm with a change of its URDF; return its plugin."""
    return world.spawn(arm(change=change), name='arm').plugin('gazebo_ros_control')


def test_the_namespace_is_the_models_name_unless_given(world):
    without = world.spawn(
        arm(change=lambda text: text.replace('<robotNamespace>/arm</robotNamespace>', '')),
        name='bot',
    )
    assert without.plugin('gazebo_ros_control').manager.namespace == 'bot'
    assert spawned(world, lambda text: text).manager.namespace == '/arm'


@pytest.mark.parametrize(
    ('written', 'own'), [('/', '/c'), ('/arm', '/arm/c'), ('arm', 'arm/c'), ('', '/c')]
)
def test_a_controller_is_in_the_robots_namespace(written, own, world):
    plugin = spawned(world, lambda text: text.replace('>/arm<', f'>{written}<'))
    plugin.manager.load('c', TYPES[EFFORT], BOTH)
    assert plugin.manager.controller('c').namespace == own


@pytest.mark.parametrize(
    ('period', 'text'),
    [
        ('0.0001', '(0.000100000 s) is faster than the gazebo simulation period (0.001000000 s)'),
        ('0.01', '(0.010000000 s) is slower than the gazebo simulation period (0.001000000 s)'),
    ],
)
def test_another_period_is_logged(period, text, world, caplog):
    spawned(world, plugin_tags(f'<controlPeriod>{period}</controlPeriod>'))
    assert text in caplog.text


def test_controllers_run_once_per_period(world):
    model, _ = spawn_arm(world, change=plugin_tags('<controlPeriod>0.01</controlPeriod>'))
    periods = []
    controller = start_controller(model, 'arm', TYPES[EFFORT], BOTH)
    controller.update = lambda now_ns, period: periods.append(period)
    world.run(100)
    assert periods == pytest.approx([0.01] * 10)


def test_another_simulation_library_is_refused(world, caplog):
    model = world.spawn(arm(change=plugin_tags('<robotSimType>my/Sim</robotSimType>')), name='arm')
    assert model.plugins == {}
    assert '<robotSimType> is my/Sim, a library that is not available here' in caplog.text


@pytest.mark.parametrize('text', ['soon', '-1', 'nan'])
def test_a_period_that_is_none_is_refused(text, world, caplog):
    world.spawn(arm(change=plugin_tags(f'<controlPeriod>{text}</controlPeriod>')), name='arm')
    assert f"<controlPeriod> is '{text}'; it takes a period in seconds" in caplog.text


def test_a_transmission_of_an_unknown_joint_leaves_the_plugin_idle(world, caplog):
    plugin = spawned(
        world, lambda text: text.replace('<joint name="joint2"><h', '<joint name="x"><h')
    )
    world.run(10)
    assert 'This robot has a joint named "x" which is not in the gazebo model.' in caplog.text
    with pytest.raises(ControllerError, match='is not active; the log says why'):
        plugin.manager.list()


def test_an_unknown_interface_leaves_the_plugin_idle(world):
    plugin = spawned(world, lambda text: text.replace('EffortJoint', 'MagicJoint'))
    with pytest.raises(
        PluginError,
        match='No matching hardware interface found for '
        "'hardware_interface/MagicJointInterface' while loading "
        'interfaces for joint1',
    ):
        plugin.configure()


def test_a_transmission_of_two_joints_is_named_and_the_others_work(world, caplog):
    interface = f'<hardwareInterface>{EFFORT}</hardwareInterface></joint>'
    extra = (
        '<transmission name="both">'
        '<type>transmission_interface/DifferentialTransmission</type>'
        f'<joint name="joint1">{interface}<joint name="joint2">{interface}'
        '<actuator name="a"/></transmission></robot>'
    )
    plugin = spawned(world, lambda text: text.replace('</robot>', extra))
    assert list(plugin.manager.robot.joints) == ['joint1', 'joint2']
    assert (
        'Transmission both has more than one joint.' in caplog.text
        and 'transmission_interface/DifferentialTransmission is not simulated' in caplog.text
    )


def test_an_incomplete_transmission_is_skipped_with_upstreams_words(world, caplog):
    plugin = spawned(
        world, lambda urdf: urdf.replace('<actuator name="joint2_motor">', '<actuator>')
    )
    assert list(plugin.manager.robot.joints) == ['joint1']
    assert "Failed to load actuators for transmission 'joint2_trans'." in caplog.messages


def test_interfaces_without_a_prefix_work_and_are_named(world, caplog):
    plugin = spawned(world, lambda text: text.replace('hardware_interface/', ''))
    assert list(plugin.manager.robot.joints) == ['joint1', 'joint2']
    assert (
        "Deprecated syntax, please prepend 'hardware_interface/' to 'EffortJointInterface' "
        "within the <hardwareInterface> tag in joint 'joint1'."
    ) in caplog.messages


def test_missing_gains_are_an_error_as_recorded(world, caplog):
    spawn_arm(world, POSITION)
    missing = 'No p gain specified for pid.  Namespace: /arm/gazebo_ros_control/pid_gains/joint1'
    assert caplog.messages.count(missing) == 1


def test_an_effort_is_clamped_to_the_limit_and_vanishes_beyond_a_stop(world):
    model = started(world, EFFORT, [500.0, 0.0])
    handle = model.plugin('gazebo_ros_control').manager.robot.joints['joint1']
    world.step()
    assert handle.effort == 100.0
    world.run(1000)
    assert handle.position > 3.09


def test_parameters_replace_the_limits_of_the_urdf(world):
    model = started(
        world,
        POSITION,
        [3.0, 0.0],
        limits={
            'joint1': {
                'has_position_limits': True,
                'min_position': -0.2,
                'max_position': 0.2,
                'has_velocity_limits': True,
                'max_velocity': 1.0,
            }
        },
    )
    world.run(100)
    assert model.joint('joint1').position == pytest.approx(0.1, abs=STILL)
    world.run(200)
    assert model.joint('joint1').position == pytest.approx(0.2, abs=STILL)


def test_soft_limits_slow_a_joint_down(world):
    soft = (
        'effort="100" velocity="10"/><safety_controller soft_lower_limit="-0.5" '
        'soft_upper_limit="0.5" k_position="10" k_velocity="10"/>'
    )
    model = started(
        world,
        POSITION,
        [2.0, 0.0],
        change=lambda text: text.replace('effort="100" velocity="10"/>', soft),
    )
    world.run(100)  # x' = 10 (0.5 - x)
    assert model.joint('joint1').position == pytest.approx(
        0.5 * (1.0 - math.exp(-1.0)), abs=5 * STILL
    )
    world.run(2000)
    assert model.joint('joint1').position == pytest.approx(0.5, abs=STILL)


@pytest.mark.parametrize(('interface', 'command'), [(POSITION, 1.5), (VELOCITY, 1.0)])
def test_an_emergency_stop_holds_until_it_is_released(interface, command, world):
    model = started(world, interface, [command, 0.0])
    plugin = model.plugin('gazebo_ros_control')
    world.run(50)
    plugin.emergency_stop = True
    world.run(5)
    held = model.joint('joint1').position
    world.run(200)
    assert model.joint('joint1').position == pytest.approx(held, abs=STILL)
    plugin.emergency_stop = False
    world.run(200)  # the controllers were started again
    assert model.joint('joint1').position == pytest.approx(held, abs=STILL)


def test_efforts_vanish_in_an_emergency_stop(world):
    model = started(world, EFFORT, [20.0, 0.0])
    plugin = model.plugin('gazebo_ros_control')
    world.step()
    plugin.emergency_stop = True
    world.step()
    assert plugin.manager.robot.joints['joint1'].effort == 0.0


def test_a_plugin_waits_for_a_description_that_is_to_come(world):
    plugin = spawned(world, lambda text: text)
    plugin.postpone()
    world.run(10)
    with pytest.raises(ControllerError, match='waits for the robot description robot_description'):
        plugin.manager.list()
    plugin.configure(plugin.model.spec.control)
    assert list(plugin.manager.robot.joints) == ['joint1', 'joint2']
    with pytest.raises(PluginError, match='is running already'):
        plugin.configure()


def test_a_robot_from_sdf_is_controlled_by_its_urdf_only(world, caplog):
    text = sdf_of_model(load_urdf(arm(), 'arm')[0], IDENTITY)
    plugin = world.spawn(text, name='arm').plugin('gazebo_ros_control')
    assert list(plugin.manager.robot.joints) == []
    assert 'SDF has no transmissions, so that no joint is controlled' in caplog.text
    again = world.spawn(text, name='again').plugin('gazebo_ros_control')
    again.configure(load_robot_control(arm()))
    assert list(again.manager.robot.joints) == ['joint1', 'joint2']


def test_a_limp_robot_costs_no_steps(world):
    plugin = spawned(world, lambda text: text)
    world.run(2)
    assert plugin.due > world.clock.steps + 1000
    start_controller(plugin.model, 'arm', TYPES[EFFORT], BOTH)
    assert plugin.due == world.clock.steps + 1


def test_a_mimic_joint_follows_its_leader(world):
    mimic = 'effort="60" velocity="6"/><mimic joint="joint1" multiplier="-0.5" offset="0.1"/>'
    urdf = first_joint_only(arm(POSITION)).replace('effort="60" velocity="6"/>', mimic)
    model = world.spawn(urdf, name='arm')
    kind = 'position_controllers/JointPositionController'
    controller = start_controller(model, 'arm', kind, {'joint': 'joint1'})
    for wanted in (0.6, -0.4):
        controller.command(wanted)
        world.run(300)
        assert model.joint('joint2').position == pytest.approx(-0.5 * wanted + 0.1, abs=STILL)


@pytest.mark.parametrize(
    ('leader', 'why'), [('joint2', 'is itself'), ('nose', 'the model does not have')]
)
def test_a_mimic_joint_without_another_leader_is_passive(leader, why, world, caplog):
    limit = 'effort="60" velocity="6"/>'
    plugin = spawned(
        world,
        lambda text: first_joint_only(text).replace(limit, f'{limit}<mimic joint="{leader}"/>'),
    )
    world.run(50)
    assert f"joint 'joint2' mimics '{leader}', which {why}; it is passive" in caplog.messages
    assert plugin.due > world.clock.steps + 1000


@pytest.mark.parametrize('absurd', ['0', '1e300', '-1e300', '1e-300', 'nan'])
def test_absurd_limits_and_mimics_do_not_make_a_robot_diverge(absurd, world):
    text = arm(POSITION).replace(
        'effort="100" velocity="10"', f'effort="{absurd}" velocity="{absurd}"'
    )
    control = load_robot_control(
        text.replace(
            '<dynamics damping="0.5"/>',
            f'<dynamics damping="0.5"/><mimic joint="joint1" multiplier="{absurd}"/>'
            f'<safety_controller soft_lower_limit="{absurd}" soft_upper_limit="{absurd}" '
            f'k_position="{absurd}" k_velocity="{absurd}"/>',
        )
    )
    model = world.spawn(arm(POSITION), name='arm')
    plugin = model.plugin('gazebo_ros_control')
    plugin.configure(control)
    start_controller(model, 'arm', TYPES[POSITION], BOTH).command([0.5, 0.5])
    world.run(200)
    assert world.rebuilds == 0
    assert not model.has_diverged()
