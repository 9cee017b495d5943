#!/usr/bin/env python3
"""Controllers on the wire: names and types as recorded, launch files, commands, bad input."""

import json
import math
import re
import signal
import subprocess
import sys
import xmlrpc.client
from itertools import pairwise
from pathlib import Path

import actionlib
import rosgraph
import rospy
import rosservice
import rostest
from actionlib_msgs.msg import GoalStatus
from control_msgs.msg import (
    FollowJointTrajectoryAction,
    FollowJointTrajectoryGoal,
    JointControllerState,
)
from control_msgs.srv import QueryTrajectoryState
from controller_manager_msgs.srv import (
    ListControllers,
    ListControllerTypes,
    LoadController,
    ReloadControllerLibraries,
    SwitchController,
    UnloadController,
)
from dynamic_reconfigure.client import Client
from four_wheel_steering_msgs.msg import FourWheelSteering, FourWheelSteeringStamped
from gazebo_msgs.srv import GetJointProperties
from geometry_msgs.msg import Twist, Vector3, WrenchStamped
from nav_msgs.msg import Odometry
from rosgraph_msgs.msg import Log
from sensor_msgs.msg import Imu, JointState
from simulator import DEADLINE, SimulatorTest, proxy, wait_until
from std_msgs.msg import Bool, Float64, Header
from tf2_msgs.msg import TFMessage
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

sys.path.append(str(Path(__file__).resolve().parents[1]))
from support.cars import SIDES, car

DATA = Path(__file__).resolve().parents[1] / 'data'
ROBOTS = DATA / 'gazebo' / 'robots'
RECORDED = json.loads((DATA / 'gazebo' / 'controller_interfaces.json').read_text())
ARM = (ROBOTS / 'twolink.urdf').read_text()
BURGER = (ROBOTS / 'burger_ros_control.urdf').read_text()
LAUNCH = DATA / 'controllers' / 'arm_control.launch'
# With a flap that follows the steering, an IMU, and a sensor of forces at the flap.
CAR = car(*[[side for side, _, _ in SIDES]] * 2).replace(
    'filename="libgazebo_ros_control.so"/>',
    'filename="libgazebo_ros_control.so"><robotNamespace>/car</robotNamespace></plugin>'
    '<plugin name="mimic" filename="libroboticsgroup_gazebo_mimic_joint_plugin.so">'
    '<robotNamespace>/car</robotNamespace><joint>front_left_steer</joint>'
    '<mimicJoint>flap</mimicJoint><hasPID/></plugin>'
    '<plugin name="wrist" filename="libgazebo_ros_ft_sensor.so"><jointName>flap</jointName>'
    '<topicName>of_plugin</topicName></plugin>').replace('</robot>', '''
  <link name="flap_link"><inertial><mass value="0.5"/>
    <inertia ixx="0.01" ixy="0" ixz="0" iyy="0.01" iyz="0" izz="0.01"/></inertial></link>
  <joint name="flap" type="revolute"><parent link="base_link"/><child link="flap_link"/>
    <origin xyz="0 0 0.1"/><axis xyz="0 0 1"/><dynamics damping="0.1"/>
    <limit lower="-1" upper="1" effort="20" velocity="20"/></joint>
  <gazebo reference="base_link"><sensor name="imu" type="imu"><update_rate>100</update_rate>
  </sensor></gazebo></robot>''')
MANAGER = ('list_controller_types', 'list_controllers', 'load_controller',
           'reload_controller_libraries', 'switch_controller', 'unload_controller')
STRICT, BEST_EFFORT = 2, 1
JSC = 'joint_state_controller'


class ControllersTest(SimulatorTest):

    def setUp(self):
        super().setUp()
        self.errors = []
        self._connections.append(rospy.Subscriber('/rosout', Log, self._hear))
        self.parameters = set()

    def tearDown(self):
        super().tearDown()
        for name in self.parameters:
            rospy.delete_param(name)
        wait_until(lambda: not managers(), 'the services of deleted robots to go')

    def _hear(self, message):
        if message.level >= Log.WARN and message.name == '/gazebo':
            self.errors.append(message.msg)

    def set_parameter(self, name, value):
        rospy.set_param(name, value)
        self.parameters.add(name)

    def spawn_robot(self, text=ARM, namespace='/arm', parameters=None):
        """Spawn a robot with the parameters of its controllers, and wait for its manager."""
        self.set_parameter('/robot_description', text)
        for name, value in (parameters or {}).items():
            self.set_parameter(f'{namespace}/{name}', value)
        self.assertTrue(self.spawn('robot', text).success)
        wait_until(lambda: managers() >= {f'{namespace}/controller_manager/{name}'
                                          for name in MANAGER}, 'the controller manager')
        self.manager = f'{namespace}/controller_manager'

    def call(self, service, kind, *arguments, **named):
        return rospy.ServiceProxy(f'{self.manager}/{service}', kind)(*arguments, **named)

    def load(self, name):
        return self.call('load_controller', LoadController, name).ok

    def unload(self, name):
        return self.call('unload_controller', UnloadController, name).ok

    def switch(self, start=(), stop=(), strictness=STRICT):
        return self.call('switch_controller', SwitchController, start_controllers=list(start),
                         stop_controllers=list(stop), strictness=strictness).ok

    def states(self):
        return {one.name: one.state
                for one in self.call('list_controllers', ListControllers).controller}

    def publisher(self, topic, kind):
        made = rospy.Publisher(topic, kind, queue_size=10)
        self._connections.append(made)
        wait_until(made.get_num_connections, f'a subscriber of {topic}')
        return made

    def start(self, name, *arguments):
        """Return the process of a program of controller_manager, which prints to a pipe."""
        process = subprocess.Popen(
            ['rosrun', 'controller_manager', name, *arguments, '__ns:=/arm'],
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        self.addCleanup(process.kill)  # unless it has ended
        return process

    def heard_errors(self, *texts):
        wait_until(lambda: all(any(text in error for error in self.errors) for text in texts),
                   f'{texts} in {self.errors}')

    def test_names_and_types_are_those_of_the_recordings(self):
        for scenario, recorded in RECORDED.items():
            with self.subTest(scenario):
                try:
                    self._check_scenario(recorded)
                finally:
                    self._clean()
                    wait_until(lambda: not managers(), 'the services to go')

    def _check_scenario(self, recorded):
        interface, controllers = recorded['interface'], recorded['parameters']
        before = graph()
        if interface:
            self.spawn_robot(
                ARM.replace('EffortJointInterface', interface), '/arm',
                {**controllers, 'gazebo_ros_control/pid_gains': recorded['pid_gains']})
        else:
            self.spawn_robot(BURGER, '', controllers)
        wait_until(lambda: len(added(before)['services']) >= len(
            (recorded['by_plugin'] or {}).get('services', MANAGER)), 'all services')
        if recorded['by_plugin']:
            self.assertEqual(added(before), recorded['by_plugin'])
        idle = graph()
        for name in controllers:
            self.assertTrue(self.load(name), self.errors)
        self.assertEqual(set(self.states().values()), {'initialized'})
        self.assertTrue(self.switch(start=controllers))
        self.assertEqual(added(idle), recorded['by_controllers'])
        if 'list' in recorded:
            listed = self.call('list_controllers', ListControllers).controller
            self.assertEqual([as_dict(one) for one in listed], recorded['list'])
        self.assertTrue(self.switch(stop=controllers))
        for name in controllers:
            self.assertTrue(self.unload(name))
        self.assertEqual(graph(), idle)

    def test_launch_file_starts_controllers_and_ctrl_c_unloads_them(self):
        self.spawn_robot()
        launch = subprocess.Popen(['roslaunch', str(LAUNCH)], stdout=subprocess.PIPE,
                                  stderr=subprocess.STDOUT, text=True)
        try:
            wait_until(lambda: set(self.states().values()) == {'running'}, 'the controllers')
            states = self.collect('/arm/joint_states', JointState)
            reports = self.collect('/arm/joint1_position_controller/state', JointControllerState)
            self.publisher('/arm/joint1_position_controller/command', Float64).publish(0.3)
            # As recorded, gravity leaves an error of command / p.
            wait_until(lambda: reports and reports[-1].set_point == 0.3 and abs(
                reports[-1].process_value_dot) < 1e-4 and reports[-1].process_value > 0.25,
                'the joint to rest')
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
        for line in ('Controller Spawner: Waiting for service controller_manager/load_controller',
                     'Loading controller: joint_state_controller',
                     'Started controllers: joint_state_controller, joint1_position_controller',
                     'Shutting down spawner. Stopping and unloading controllers...',
                     'Succeeded in unloading joint_state_controller'):
            self.assertIn(line, output)

    def _check_programs(self):
        """The commands of controller_manager, beside running controllers."""
        for command, expected in (
                ('list', "'joint1_position_controller' - 'hardware_interface::EffortJointInterface'"
                         ' ( running )'),
                ('stop joint2_position_controller',
                 "Stopped ['joint2_position_controller'] successfully"),
                ('start joint2_position_controller nope',
                 "Started ['joint2_position_controller'] successfully\n"
                 "Error when starting ['nope'] and stopping []")):
            self.assertIn(expected, said_by(self.start('controller_manager', *command.split())))

    def test_programs_load_stop_and_unload_controllers(self):
        one, two = (f'joint{number}_position_controller' for number in (1, 2))
        self.spawn_robot(parameters={
            **RECORDED['effort_pos']['parameters'],
            'controller_groups': {'first': [JSC, one], 'second': [JSC, two, two]}})
        readers = [self.start(f'controller_{which}', command) for which, command in (
            ('manager', 'list-types'), ('group', 'list'))]
        for which, command, said, states in (
                ('manager', f'load {one} nope',
                 f"Loaded '{one}'\nError when loading 'nope'", {one: 'initialized'}),
                ('manager', f'spawn {two}',
                 f"Loaded '{two}'\nStarted ['{two}'] successfully",
                 {one: 'initialized', two: 'running'}),
                ('manager', 'reload-libraries --restore',
                 'Restore: True\nSuccessfully reloaded libraries\n'
                 'Controllers restored to original state',
                 {one: 'initialized', two: 'running'}),
                ('manager', f'kill {two} {one}',
                 f"Stopped ['{two}'] successfully\nError when starting [] and stopping ['{one}']\n"
                 f"Unloaded '{two}' successfully\nUnloaded '{one}' successfully", {}),
                ('group', 'spawn first', f"Started ['{one}'] successfully",
                 {JSC: 'running', one: 'running'}),
                ('group', 'switch second', f"Loaded '{two}'\nStarted ['{two}'] successfully\n"
                 f"Stopped ['{one}'] successfully",
                 {JSC: 'running', one: 'stopped', two: 'running'})):
            with self.subTest(which, command=command):
                self.assertIn(said, said_by(self.start(f'controller_{which}', *command.split())))
                self.assertEqual(self.states(), states)
        types, groups = map(said_by, readers)
        self.assertLessEqual(set(RECORDED['effort_pos']['types']), set(types.splitlines()))
        self.assertIn(f'Number of groups: 2\n  first\n      {JSC}\n      {one}\n  second\n',
                      groups)

    def test_libraries_are_reloaded_only_without_controllers_unless_forced(self):
        self.spawn_robot(parameters={JSC: RECORDED['effort_pos']['parameters'][JSC]})
        self.assertTrue(self.load(JSC))
        self.assertTrue(self.switch(start=[JSC]))
        self.assertFalse(self.call('reload_controller_libraries', ReloadControllerLibraries,
                                   force_kill=False).ok)
        self.assertEqual(self.states(), {JSC: 'running'})
        self.heard_errors('Controller manager: Cannot reload controller libraries because there '
                          'are still 1 controllers running')
        for force_kill in (True, False):
            self.assertTrue(self.call('reload_controller_libraries', ReloadControllerLibraries,
                                      force_kill=force_kill).ok)
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
        self.assertTrue(self.load(JSC))
        self.assertTrue(self.switch(start=[JSC]))
        unspawner = self.start('unspawner', JSC)
        wait_until(lambda: self.states() == {JSC: 'stopped'}, 'the controller to stop')
        self._clean()
        wait_until(lambda: not managers(), 'the services to go')
        unspawner.send_signal(signal.SIGINT)
        self.assertIn('the controllers were not started again: service', said_by(unspawner))

    def test_spawner_reports_what_cannot_be_loaded_and_waits(self):
        self.spawn_robot(parameters={JSC: RECORDED['effort_pos']['parameters'][JSC]})
        spawner = subprocess.Popen(
            ['rosrun', 'controller_manager', 'spawner', '--namespace', '/arm', 'nope', JSC],
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        wait_until(lambda: self.states() == {JSC: 'running'}, 'the other controller')
        spawner.send_signal(signal.SIGINT)
        output = spawner.communicate(timeout=DEADLINE)[0]
        self.assertEqual(spawner.returncode, 0)
        self.assertIn('Failed to load nope', output)
        self.assertEqual(self.states(), {})
        self.heard_errors("Could not load controller 'nope' because the type was not specified. "
                          'Did you load the controller configuration on the parameter server '
                          "(namespace: '/arm/nope')?")

    def test_bad_input_is_answered_as_upstream_and_the_world_goes_on(self):
        good = RECORDED['effort_pos']['parameters']
        self.spawn_robot(parameters={
            **good, 'wrong': {'type': 'no_such/Controller'}, 'list': [1, 2],
            'jointless': {'type': 'effort_controllers/JointEffortController', 'joint': 'joint9'},
            'rival': {'type': 'effort_controllers/JointEffortController', 'joint': 'joint1'}})
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
            'a command takes finite numbers')
        now = self.world().sim_time
        wait_until(lambda: self.world().sim_time > now, 'the world')

    def test_types_are_at_least_those_of_the_recording(self):
        self.spawn_robot()
        answer = self.call('list_controller_types', ListControllerTypes)
        self.assertLessEqual(set(RECORDED['effort_pos']['types']), set(answer.types))
        self.assertEqual(set(answer.base_classes), {'controller_interface::ControllerBase'})

    def test_drives_and_sensors_of_a_car_are_on_the_wire(self):
        wheels, steerings = ([f'{place}_{side}_{kind}' for place in ('front', 'rear')
                              for side in ('left', 'right')] for kind in ('joint', 'steer'))
        drive = {'pose_covariance_diagonal': [1.0] * 6, 'twist_covariance_diagonal': [1.0] * 6,
                 'cmd_vel_timeout': 600.0}
        controllers = {
            'four': {'type': 'four_wheel_steering_controller/FourWheelSteeringController',
                     'front_wheel': wheels[:2], 'rear_wheel': wheels[2:],
                     'front_steering': steerings[:2], 'rear_steering': steerings[2:], **drive},
            'mecanum': {'type': 'mecanum_drive_controller/MecanumDriveController',
                        'front_left_wheel_joint': wheels[0], 'front_right_wheel_joint': wheels[1],
                        'back_left_wheel_joint': wheels[2], 'back_right_wheel_joint': wheels[3],
                        **drive},
            'bicycle': {'type': 'ackermann_steering_controller/AckermannSteeringController',
                        'rear_wheel': wheels[2], 'front_steer': steerings[0],
                        'wheel_separation_h': 0.3, **drive},
            'imus': {'type': 'imu_sensor_controller/ImuSensorController', 'publish_rate': 50},
            'wrenches': {'type': 'force_torque_sensor_controller/ForceTorqueSensorController',
                         'publish_rate': 50}}
        gains = 'gazebo_ros_control/pid_gains/flap'
        self.spawn_robot(CAR, '/car', {**controllers, gains: {'p': 0.0}})
        before = graph()
        for name in controllers:
            self.assertTrue(self.load(name), self.errors)
        odometry, commands = (
            {f'/car/{name}/{topic}': kind for name in ('four', 'mecanum', 'bicycle')}
            for topic, kind in (('odom', 'nav_msgs/Odometry'), ('cmd_vel', 'geometry_msgs/Twist')))
        steering = 'four_wheel_steering_msgs/FourWheelSteering'
        self.assertEqual(added(before), {
            'publishes': {**odometry, '/car/four/odom_steer': f'{steering}Stamped',
                          '/tf': 'tf2_msgs/TFMessage', '/car/imu': 'sensor_msgs/Imu',
                          '/car/wrist': 'geometry_msgs/WrenchStamped'},
            'subscribes': {**commands, '/car/four/cmd_four_wheel_steering': steering},
            'services': {}})
        self.assertTrue(self.switch(start=['imus', 'wrenches', 'four']), self.errors)
        imus = self.collect('/car/imu', Imu)
        wrenches = self.collect('/car/wrist', WrenchStamped)
        joint = proxy('get_joint_properties', GetJointProperties)

        def angle(name):
            return joint(name).position[0]

        def drives(name, kind, message, speed):
            topic = '/car/' + name
            odometry = self.collect(topic.rpartition('/')[0] + '/odom', Odometry)
            self.publisher(topic, kind).publish(message)
            wait_until(lambda: odometry and abs(speed(odometry[-1].twist.twist) - 0.2) < 0.005,
                       f'the speed by {topic}')

        drives('four/cmd_four_wheel_steering', FourWheelSteering,
               FourWheelSteering(speed=0.2, front_steering_angle=0.5, rear_steering_angle=-0.5),
               lambda twist: twist.linear.x)
        steered = self.collect('/car/four/odom_steer', FourWheelSteeringStamped)
        wait_until(lambda: steered and abs(
            steered[-1].data.front_steering_angle - 0.5) < 0.01, 'the angle')
        self.assertGreater(angle('front_left_steer'), 0.5)
        # Its gains let the flap follow the steering.
        self.assertGreater(abs(angle('flap') - angle('front_left_steer')), 0.1)
        client = Client(f'/car/{gains}', timeout=DEADLINE)
        self.assertEqual(client.update_configuration({'p': 2.0})['p'], 2.0)
        wait_until(lambda: abs(angle('flap') - angle('front_left_steer')) < 0.05, 'the flap')
        drives('four/cmd_vel', Twist, Twist(linear=Vector3(x=0.2)), lambda twist: twist.linear.x)
        self.assertTrue(self.switch(start=['mecanum'], stop=['four']), self.errors)
        drives('mecanum/cmd_vel', Twist, Twist(linear=Vector3(y=0.2)), lambda twist: twist.linear.y)
        self.assertTrue(self.switch(start=['bicycle'], stop=['mecanum']), self.errors)
        drives('bicycle/cmd_vel', Twist, Twist(linear=Vector3(x=0.2), angular=Vector3(z=0.3)),
               lambda twist: twist.linear.x)
        wait_until(lambda: abs(angle('front_left_steer') - 0.3) < 0.01, 'the steering')
        self.assertEqual((imus[-1].header.frame_id, wrenches[-1].header.frame_id),
                         ('base_link', 'flap_link'))
        self.assertEqual((periods(imus), periods(wrenches)), ({0.02}, {0.02}))
        self.assertTrue(any(abs(one.linear_acceleration.z - 9.8) < 0.5 for one in imus))
        self.assertTrue(any(abs(abs(one.wrench.force.z) - 4.9) < 0.5 for one in wrenches))

    def test_a_hundred_cycles_leave_nothing_behind(self):
        controllers = {'arm_controller': RECORDED['jtc_effort']['parameters']['arm_controller']}
        for number in range(19):
            controllers[f'position_{number}'] = RECORDED['effort_pos']['parameters'][
                f'joint{number % 2 + 1}_position_controller']
        self.spawn_robot(parameters=controllers)
        pid = xmlrpc.client.ServerProxy(rosgraph.Master('/test').lookupNode('/gazebo')).getPid(
            '/test')[2]
        threads = Path(f'/proc/{pid}/task')
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
        wait_until(lambda: len(list(threads.iterdir())) <= count,
                   f'{count} threads, as before')

    def test_goals_are_followed_violated_rejected_and_canceled(self):
        recorded = RECORDED['jtc_position']['parameters']
        self.spawn_robot(ARM.replace('EffortJointInterface', 'PositionJointInterface'),
                         parameters=recorded)
        for name in recorded:
            self.assertTrue(self.load(name))
        self.assertTrue(self.switch(start=recorded))
        client = actionlib.SimpleActionClient(
            '/arm/arm_controller/follow_joint_trajectory', FollowJointTrajectoryAction)
        self.assertTrue(client.wait_for_server(rospy.Duration(DEADLINE)))
        feedback = []

        def follow(seconds, positions, names=('joint1', 'joint2'), wait=True, start=0.0):
            goal = FollowJointTrajectoryGoal()
            goal.trajectory.header.stamp = rospy.Time.from_sec(start)
            goal.trajectory.joint_names = list(names)
            goal.trajectory.points = [JointTrajectoryPoint(
                positions=positions, time_from_start=rospy.Duration(seconds))]
            client.send_goal(goal, feedback_cb=feedback.append)
            if wait:
                wait_until(lambda: client.simple_state == actionlib.SimpleGoalState.DONE, 'result')
            result = client.get_result()
            return (client.get_state(), result.error_code, result.error_string) if wait else None

        self.assertEqual(follow(0.5, [0.5, -0.3]), (GoalStatus.SUCCEEDED, 0, ''))
        self.assertEqual(feedback[-1].joint_names, ['joint1', 'joint2'])
        query = rospy.ServiceProxy('/arm/arm_controller/query_state', QueryTrajectoryState)
        now = rospy.Time.from_sec(self.world().sim_time)
        self.assertEqual([round(one, 6) for one in query(now).position], [0.5, -0.3])
        self.assertEqual(follow(1.0, [0.5], ['nope']), (GoalStatus.REJECTED, -2, ''))
        past = 'Dropping all 1 trajectory point(s), as they occur before the current time.'
        state, code, text = follow(0.001, [0.0, 0.0], start=0.001)
        self.assertEqual((state, code), (GoalStatus.REJECTED, -1))
        self.assertRegex(text, rf'^{re.escape(past)}\nLast point is \d+\.\d{{6}}s in the past\.$')
        self.publisher('/arm/arm_controller/command', JointTrajectory).publish(JointTrajectory(
            Header(stamp=rospy.Time.from_sec(0.001)), ['joint1', 'joint2'],
            [JointTrajectoryPoint(positions=[0.0, 0.0])]))
        self.heard_errors(past)
        follow(30.0, [0.0, 0.0], wait=False)
        wait_until(lambda: client.get_state() == GoalStatus.ACTIVE, 'the goal to be accepted')
        client.cancel_goal()
        wait_until(lambda: client.get_state() == GoalStatus.PREEMPTED, 'the goal to be canceled')
        state, code, text = follow(0.02, [2.5, -2.0])
        self.assertEqual((state, code), (GoalStatus.ABORTED, -4))
        self.assertRegex(text, r'^joint\d path error -?\d\.\d{6}$')

    def test_gains_are_changed_and_the_emergency_stop_takes_the_effort(self):
        parameters = RECORDED['effort_pos']['parameters']
        self.spawn_robot(ARM.replace('</robotNamespace>',
                                     '</robotNamespace><eStopTopic>stop</eStopTopic>'),
                         parameters=parameters)
        for name in parameters:
            self.assertTrue(self.load(name))
        self.assertTrue(self.switch(start=parameters))
        reports = self.collect('/arm/joint1_position_controller/state', JointControllerState)
        client = Client('/arm/joint1_position_controller/pid', timeout=DEADLINE)
        changed = client.update_configuration({'p': 55.0, 'i_clamp_max': 3.0})
        self.assertEqual((changed['p'], changed['d']), (55.0, 10.0))
        wait_until(lambda: reports and (reports[-1].p, reports[-1].i_clamp) == (55.0, 3.0), 'p')
        self.publisher('/arm/joint1_position_controller/command', Float64).publish(0.5)
        states = self.collect('/arm/joint_states', JointState)
        wait_until(lambda: states and abs(states[-1].effort[0]) > 0.5, 'effort')
        stop = self.publisher('/arm/stop', Bool)
        stop.publish(True)
        wait_until(lambda: states[-1].effort[0] == 0.0, 'the stop')
        stop.publish(False)
        wait_until(lambda: states[-1].effort[0] != 0.0, 'effort again')

    def test_a_controller_of_a_users_package_is_loaded_by_its_type(self):
        self.spawn_robot(
            ARM.replace('EffortJointInterface', 'PositionJointInterface'),
            parameters={JSC: RECORDED['effort_pos']['parameters'][JSC],
                        'swing': {'type': 'my_robot/Swing', 'joint': 'joint2'}})
        for name in (JSC, 'swing'):
            self.assertTrue(self.load(name), self.errors)
        self.assertTrue(self.switch(start=[JSC, 'swing']))
        states = self.collect('/arm/joint_states', JointState)

        def swings_about(centre):
            angles = [one.position[1] for one in states[-25:]]
            return len(angles) == 25 and max(
                abs(max(angles) - centre - 0.1), abs(min(angles) - centre + 0.1)) < 0.02

        wait_until(lambda: swings_about(0.0), 'the swing')
        self.publisher('/arm/swing/command', Float64).publish(0.5)
        wait_until(lambda: swings_about(0.5), 'the swing elsewhere')

    def test_the_world_goes_on_until_the_description_arrives(self):
        self.assertFalse(rospy.has_param('/robot_description'))
        self.assertTrue(self.spawn('robot', ARM).success)
        start = self.world().sim_time
        wait_until(lambda: self.world().sim_time > start + 0.3, 'the world')
        self.assertEqual(managers(), set())
        self.set_parameter('/robot_description', ARM)
        wait_until(lambda: len(managers()) == len(MANAGER), 'the controller manager')

    def test_a_robot_drives_by_its_diff_drive_controller(self):
        parameters = RECORDED['diff_drive_controller']['parameters']
        self.spawn_robot(BURGER, '', parameters)
        for name in parameters:
            self.assertTrue(self.load(name))
        self.assertTrue(self.switch(start=parameters))
        odometry = self.collect('/diff_cont/odom', Odometry)
        frames = self.collect('/tf', TFMessage)
        command = Twist()
        command.linear.x, command.angular.z = 0.2, 0.5
        publisher = self.publisher('/diff_cont/cmd_vel', Twist)
        publisher.publish(command)
        wait_until(lambda: odometry and abs(odometry[-1].twist.twist.linear.x - 0.2) < 0.002,
                   'the speed')
        driving = odometry[-1]
        self.assertEqual((driving.header.frame_id, driving.child_frame_id),
                         ('odom', 'base_footprint'))
        self.assertEqual(driving.pose.covariance[35], 1000.0)
        # Without further commands it stops after cmd_vel_timeout.
        wait_until(lambda: abs(odometry[-1].twist.twist.linear.x) < 0.01, 'the time-out')
        self.assertEqual(periods(odometry), {0.02})
        edge = frames[-1].transforms[0]
        self.assertEqual((edge.header.frame_id, edge.child_frame_id), ('odom', 'base_footprint'))
        self.assertGreater(edge.transform.translation.x, 0.01)
        settings = Client('/diff_cont', timeout=DEADLINE)
        changed = settings.update_configuration({'enable_odom_tf': False, 'publish_rate': 10.0})
        self.assertEqual(changed['publish_rate'], 10.0)
        wait_until(lambda: periods(odometry[-2:]) == {0.1}, 'the new rate')


def said_by(process):
    """Return what a program has printed when it ends."""
    said = process.communicate(timeout=DEADLINE)[0]
    assert process.returncode == 0, said
    return said


def periods(messages):
    """Return the times between messages [s]."""
    return {round((after.header.stamp - before.header.stamp).to_sec(), 6)
            for before, after in pairwise(messages)}


def managers():
    """Return the services of controller managers."""
    return {name for name in rosservice.get_service_list() if '/controller_manager/' in name}


def graph():
    """Return what the simulator publishes, subscribes to and serves, with types."""
    master = rosgraph.Master(rospy.get_name())
    published, subscribed, services = master.getSystemState()
    types = dict(master.getTopicTypes())

    def of_simulator(entries):
        return [name for name, nodes in entries if '/gazebo' in nodes]

    return {'publishes': {name: types[name] for name in of_simulator(published)},
            'subscribes': {name: types[name] for name in of_simulator(subscribed)},
            'services': {name: rosservice.get_service_type(name)
                         for name in of_simulator(services)}}


def added(before):
    """Return what has come since."""
    return {kind: {name: entry for name, entry in entries.items() if name not in before[kind]}
            for kind, entries in graph().items()}


def as_dict(state):
    return {'name': state.name, 'state': state.state, 'type': state.type, 'claimed_resources': [
        {'hardware_interface': claim.hardware_interface, 'resources': claim.resources}
        for claim in state.claimed_resources]}


if __name__ == '__main__':
    rospy.init_node('test_controllers', disable_rostime=True)
    rostest.rosrun('rosbots_description', 'controllers', ControllersTest, sys.argv)
