"""Controller managers on the wire: launch files, programs, bad input, and nothing left behind."""

import math
import signal
import subprocess
from pathlib import Path

import rospy
from control_msgs.msg import JointControllerState
from controller_manager_msgs.srv import ListControllerTypes, ReloadControllerLibraries
from controllers import (
    ARM,
    BEST_EFFORT,
    DATA,
    JSC,
    MANAGER,
    RECORDED,
    ControllersTest,
    graph,
    managers,
    periods,
)
from programs import find_program
from sensor_msgs.msg import JointState
from simulator import DEADLINE, process_of, wait_until
from std_msgs.msg import Float64

LAUNCH = DATA / 'controllers' / 'arm_control.launch'


class ManagersTest(ControllersTest):
    def test_launch_file_starts_controllers_and_ctrl_c_unloads_them(self):
        self.spawn_robot()
        launch = subprocess.Popen(
            ['roslaunch', str(LAUNCH)], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
        )
        try:
            wait_until(lambda: set(self.states().values()) == {'running'}, 'the controllers')
            states = self.collect('/arm/joint_states', JointState)
            reports = self.collect('/arm/joint1_position_controller/state', JointControllerState)
            self.publisher('/arm/joint1_position_controller/command', Float64).publish(0.3)
            # As recorded, gravity leaves an error of command / p.
            wait_until(
                lambda: (
                    reports
                    and reports[-1].set_point == 0.3
                    and abs(reports[-1].process_value_dot) < 1e-4
                    and reports[-1].process_value > 0.25
                ),
                'the joint to rest',
            )
            last = reports[-1]
            self.assertAlmostEqual(last.command, 100.0 * last.error, delta=0.01)
            self.assertEqual((last.p, last.i, last.d, last.i_clamp), (100.0, 0.01, 10.0, 0.0))
            wait_until(lambda: abs(states[-1].position[0] - last.process_value) < 1e-3, 'the state')
            self.assertEqual(states[-1].name, ['joint1', 'joint2'])
            self.assertEqual(periods(states), {0.01})
            self._check_programs()
        finally:
            launch.send_signal(signal.SIGINT)
            output = launch.communicate(timeout=DEADLINE)[0]
        self.assertEqual(self.states(), {})
        for line in (
            'Controller Spawner: Waiting for service controller_manager/load_controller',
            'Loading controller: joint_state_controller',
            'Started controllers: joint_state_controller, joint1_position_controller',
            'Shutting down spawner. Stopping and unloading controllers...',
            'Succeeded in unloading joint_state_controller',
        ):
            self.assertIn(line, output)

    def _check_programs(self):
        """The commands of controller_manager, beside running controllers."""
        for command, expected in (
            (
                'list',
                "'joint1_position_controller' - 'hardware_interface::EffortJointInterface'"
                ' ( running )',
            ),
            (
                'stop joint2_position_controller',
                "Stopped ['joint2_position_controller'] successfully",
            ),
            (
                'start joint2_position_controller nope',
                "Started ['joint2_position_controller'] successfully\n"
                "Error when starting ['nope'] and stopping []",
            ),
        ):
            self.assertIn(expected, said_by(self.start('controller_manager', *command.split())))

    def test_programs_load_stop_and_unload_controllers(self):
        one, two = (f'joint{number}_position_controller' for number in (1, 2))
        self.spawn_robot(
            parameters={
                **RECORDED['effort_pos']['parameters'],
                'controller_groups': {'first': [JSC, one], 'second': [JSC, two, two]},
            }
        )
        readers = [
            self.start(f'controller_{which}', command)
            for which, command in (('manager', 'list-types'), ('group', 'list'))
        ]
        for which, command, said, states in (
            (
                'manager',
                f'load {one} nope',
                f"Loaded '{one}'\nError when loading 'nope'",
                {one: 'initialized'},
            ),
            (
                'manager',
                f'spawn {two}',
                f"Loaded '{two}'\nStarted ['{two}'] successfully",
                {one: 'initialized', two: 'running'},
            ),
            (
                'manager',
                'reload-libraries --restore',
                'Restore: True\nSuccessfully reloaded libraries\n'
                'Controllers restored to original state',
                {one: 'initialized', two: 'running'},
            ),
            (
                'manager',
                f'kill {two} {one}',
                f"Stopped ['{two}'] successfully\nError when starting [] and stopping ['{one}']\n"
                f"Unloaded '{two}' successfully\nUnloaded '{one}' successfully",
                {},
            ),
            (
                'group',
                'spawn first',
                f"Started ['{one}'] successfully",
                {JSC: 'running', one: 'running'},
            ),
            (
                'group',
                'switch second',
                f"Loaded '{two}'\nStarted ['{two}'] successfully\nStopped ['{one}'] successfully",
                {JSC: 'running', one: 'stopped', two: 'running'},
            ),
        ):
            with self.subTest(which, command=command):
                self.assertIn(said, said_by(self.start(f'controller_{which}', *command.split())))
                self.assertEqual(self.states(), states)
        types, groups = map(said_by, readers)
        self.assertLessEqual(set(RECORDED['effort_pos']['types']), set(types.splitlines()))
        self.assertIn(f'Number of groups: 2\n  first\n      {JSC}\n      {one}\n  second\n', groups)

    def test_libraries_are_reloaded_only_without_controllers_unless_forced(self):
        self.spawn_robot(parameters={JSC: RECORDED['effort_pos']['parameters'][JSC]})
        self.run_controllers([JSC])
        self.assertFalse(
            self.call('reload_controller_libraries', ReloadControllerLibraries, force_kill=False).ok
        )
        self.assertEqual(self.states(), {JSC: 'running'})
        self.heard_errors(
            'Controller manager: Cannot reload controller libraries because there '
            'are still 1 controllers running'
        )
        for force_kill in (True, False):
            self.assertTrue(
                self.call(
                    'reload_controller_libraries', ReloadControllerLibraries, force_kill=force_kill
                ).ok
            )
            self.assertEqual(self.states(), {})

    def test_unspawner_keeps_controllers_stopped_until_it_ends(self):
        controllers = RECORDED['effort_pos']['parameters']
        self.spawn_robot(parameters=controllers)
        for name in controllers:
            self.assertTrue(self.load(name))
        one, two = (f'joint{number}_position_controller' for number in (1, 2))
        self.assertTrue(self.switch(start=[JSC, one]))
        unspawner = self.start('unspawner', one, two, 'nope')
        stopped = {JSC: 'running', one: 'stopped', two: 'initialized'}
        wait_until(lambda: self.states() == stopped, 'the controller to stop')
        # Whoever starts one, it is stopped again.
        self.assertTrue(self.switch(start=[two]))
        wait_until(lambda: self.states() == {**stopped, two: 'stopped'}, 'the other one, too')
        unspawner.send_signal(signal.SIGINT)
        output = said_by(unspawner)
        for name in (one, two):
            self.assertIn(f'Inhibiting controllers: {name}', output)
        self.assertEqual(self.states(), dict.fromkeys(controllers, 'running'))

    def test_unspawner_ends_without_the_manager(self):
        self.spawn_robot(parameters={JSC: RECORDED['effort_pos']['parameters'][JSC]})
        self.run_controllers([JSC])
        unspawner = self.start('unspawner', JSC)
        wait_until(lambda: self.states() == {JSC: 'stopped'}, 'the controller to stop')
        self.pause()  # it looks for the manager every 3 s of simulated time: not while that goes
        self.assertTrue(self.delete('robot').success)
        wait_until(lambda: not managers(), 'the services to go')
        unspawner.send_signal(signal.SIGINT)
        self.assertIn('the controllers were not started again: service', said_by(unspawner))

    def test_spawner_reports_what_cannot_be_loaded_and_waits(self):
        self.spawn_robot(parameters={JSC: RECORDED['effort_pos']['parameters'][JSC]})
        spawner = subprocess.Popen(
            [find_program('controller_manager', 'spawner'), '--namespace', '/arm', 'nope', JSC],
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
        )
        wait_until(lambda: self.states() == {JSC: 'running'}, 'the other controller')
        spawner.send_signal(signal.SIGINT)
        output = spawner.communicate(timeout=DEADLINE)[0]
        self.assertEqual(spawner.returncode, 0)
        self.assertIn('Failed to load nope', output)
        self.assertEqual(self.states(), {})
        self.heard_errors(
            "Could not load controller 'nope' because the type was not specified. "
            'Did you load the controller configuration on the parameter server '
            "(namespace: '/arm/nope')?"
        )

    def test_bad_input_is_answered_as_upstream_and_the_world_goes_on(self):
        good = RECORDED['effort_pos']['parameters']
        self.spawn_robot(
            parameters={
                **good,
                'wrong': {'type': 'no_such/Controller'},
                'list': [1, 2],
                'jointless': {
                    'type': 'effort_controllers/JointEffortController',
                    'joint': 'joint9',
                },
                'rival': {'type': 'effort_controllers/JointEffortController', 'joint': 'joint1'},
            }
        )
        name = 'joint1_position_controller'
        for bad in ('nope', 'wrong', 'list', 'jointless', '', 'a b', '../../x'):
            self.assertFalse(self.load(bad), bad)
        self.assertTrue(self.load(name))
        self.assertFalse(self.load(name))
        self.assertTrue(self.load('rival'))
        self.assertTrue(self.switch(start=[name]))
        self.assertFalse(self.switch(start=['rival']))
        self.assertFalse(self.switch(start=['nope']))
        self.assertTrue(self.switch(start=['nope'], strictness=BEST_EFFORT))
        self.assertFalse(self.unload(name))
        self.assertTrue(self.switch(start=['rival'], stop=[name]))
        self.assertEqual(self.states(), {name: 'stopped', 'rival': 'running'})
        command = self.publisher('/arm/rival/command', Float64)
        for value in (math.nan, math.inf):
            command.publish(value)
        self.heard_errors(
            "Could not load controller 'wrong' because controller type 'no_such/Controller' does "
            'not exist.',
            "Use 'rosservice call controller_manager/list_controller_types' to get the available "
            'types',
            f"A controller named '{name}' was already loaded inside the controller manager",
            "Initializing controller 'jointless' failed",
            'Could not switch controllers, due to resource conflict',
            "Could not start controller with name 'nope' because no controller with this name "
            'exists',
            f"Could not unload controller with name '{name}' because it is still running",
            'a command takes finite numbers',
        )
        now = self.world().sim_time
        wait_until(lambda: self.world().sim_time > now, 'the world')

    def test_types_are_at_least_those_of_the_recording(self):
        self.spawn_robot()
        answer = self.call('list_controller_types', ListControllerTypes)
        self.assertLessEqual(set(RECORDED['effort_pos']['types']), set(answer.types))
        self.assertEqual(set(answer.base_classes), {'controller_interface::ControllerBase'})

    def test_a_hundred_cycles_leave_nothing_behind(self):
        controllers = {'arm_controller': RECORDED['jtc_effort']['parameters']['arm_controller']}
        for number in range(19):
            controllers[f'position_{number}'] = RECORDED['effort_pos']['parameters'][
                f'joint{number % 2 + 1}_position_controller'
            ]
        self.spawn_robot(parameters=controllers)
        threads = Path(f'/proc/{process_of()}/task')
        before = {}
        # Twenty controllers, five times; before, the server has not imported all yet.
        for number in range(6):
            for name in controllers:
                self.assertTrue(self.load(name), self.errors)
            for name in controllers:
                self.assertTrue(self.switch(start=[name]), self.errors)
                self.assertTrue(self.switch(stop=[name]), self.errors)
            for name in controllers:
                self.assertTrue(self.unload(name), self.errors)
            if number == 0:
                before = graph()
                count = len(list(threads.iterdir()))
        self.assertEqual(graph(), before)
        self.assertEqual(self.states(), {})
        wait_until(lambda: len(list(threads.iterdir())) <= count, f'{count} threads, as before')

    def test_the_world_goes_on_until_the_description_arrives(self):
        self.assertFalse(rospy.has_param('/robot_description'))
        self.assertTrue(self.spawn('robot', ARM).success)
        start = self.world().sim_time
        wait_until(lambda: self.world().sim_time > start + 0.3, 'the world')
        self.assertEqual(managers(), set())
        self.set_parameter('/robot_description', ARM)
        wait_until(lambda: len(managers()) == len(MANAGER), 'the controller manager')


def said_by(process):
    """Return what a program has printed when it ends."""
    said = process.communicate(timeout=DEADLINE)[0]
    assert process.returncode == 0, said
    return said
