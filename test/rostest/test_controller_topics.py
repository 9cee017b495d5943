"""Topics, actions and gains of controllers on the wire: names and types as recorded, and motion."""

import re
import sys
from contextlib import contextmanager
from pathlib import Path

import actionlib
import rospy
from actionlib_msgs.msg import GoalStatus
from control_msgs.msg import (
    FollowJointTrajectoryAction,
    FollowJointTrajectoryGoal,
    JointControllerState,
)
from control_msgs.srv import QueryTrajectoryState
from controller_manager_msgs.srv import ListControllers
from controllers import (
    ARM,
    BURGER,
    JSC,
    MANAGER,
    RECORDED,
    ControllersTest,
    added,
    graph,
    managers,
    periods,
)
from dynamic_reconfigure.client import Client
from four_wheel_steering_msgs.msg import FourWheelSteering, FourWheelSteeringStamped
from gazebo_msgs.srv import GetJointProperties
from geometry_msgs.msg import Twist, Vector3, WrenchStamped
from nav_msgs.msg import Odometry
from sensor_msgs.msg import Imu, JointState
from simulator import DEADLINE, proxy, wait_until
from std_msgs.msg import Bool, Float64, Header
from tf2_msgs.msg import TFMessage
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

sys.path.append(str(Path(__file__).resolve().parents[1]))
from support.cars import SIDES, car

# With a flap that follows the steering, an IMU, and a sensor of forces at the flap.
CAR = (
    car(*[[side for side, _, _ in SIDES]] * 2)
    .replace(
        'filename="libgazebo_ros_control.so"/>',
        'filename="libgazebo_ros_control.so"><robotNamespace>/car</robotNamespace></plugin>'
        '<plugin name="mimic" filename="libroboticsgroup_gazebo_mimic_joint_plugin.so">'
        '<robotNamespace>/car</robotNamespace><joint>front_left_steer</joint>'
        '<mimicJoint>flap</mimicJoint><hasPID/></plugin>'
        '<plugin name="wrist" filename="libgazebo_ros_ft_sensor.so"><jointName>flap</jointName>'
        '<topicName>of_plugin</topicName></plugin>',
    )
    .replace(
        '</robot>',
        """
  <link name="flap_link"><inertial><mass value="0.5"/>
    <inertia ixx="0.01" ixy="0" ixz="0" iyy="0.01" iyz="0" izz="0.01"/></inertial></link>
  <joint name="flap" type="revolute"><parent link="base_link"/><child link="flap_link"/>
    <origin xyz="0 0 0.1"/><axis xyz="0 0 1"/><dynamics damping="0.1"/>
    <limit lower="-1" upper="1" effort="20" velocity="20"/></joint>
  <gazebo reference="base_link"><sensor name="imu" type="imu"><update_rate>100</update_rate>
  </sensor></gazebo></robot>""",
    )
)
WHEELS, STEERINGS = (
    [f'{place}_{side}_{kind}' for place in ('front', 'rear') for side in ('left', 'right')]
    for kind in ('joint', 'steer')
)
DRIVE = {
    'pose_covariance_diagonal': [1.0] * 6,
    'twist_covariance_diagonal': [1.0] * 6,
    'cmd_vel_timeout': 600.0,
}
CAR_CONTROLLERS = {
    'four': {
        'type': 'four_wheel_steering_controller/FourWheelSteeringController',
        'front_wheel': WHEELS[:2],
        'rear_wheel': WHEELS[2:],
        'front_steering': STEERINGS[:2],
        'rear_steering': STEERINGS[2:],
        **DRIVE,
    },
    'mecanum': {
        'type': 'mecanum_drive_controller/MecanumDriveController',
        'front_left_wheel_joint': WHEELS[0],
        'front_right_wheel_joint': WHEELS[1],
        'back_left_wheel_joint': WHEELS[2],
        'back_right_wheel_joint': WHEELS[3],
        **DRIVE,
    },
    'bicycle': {
        'type': 'ackermann_steering_controller/AckermannSteeringController',
        'rear_wheel': WHEELS[2],
        'front_steer': STEERINGS[0],
        'wheel_separation_h': 0.3,
        **DRIVE,
    },
    'imus': {'type': 'imu_sensor_controller/ImuSensorController', 'publish_rate': 50},
    'wrenches': {
        'type': 'force_torque_sensor_controller/ForceTorqueSensorController',
        'publish_rate': 50,
    },
}
GAINS = 'gazebo_ros_control/pid_gains/flap'  # of the plugin that moves the flap


class ControllerTopicsTest(ControllersTest):
    def test_names_and_types_are_those_of_the_recordings(self):
        for scenario, recorded in RECORDED.items():
            with self.subTest(scenario), self._spawned(recorded) as before:
                if recorded['by_plugin']:
                    self.assertEqual(added(before), recorded['by_plugin'])
                idle = graph()
                controllers = recorded['parameters']
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

    @contextmanager
    def _spawned(self, recorded):
        """Spawn the robot of a recording, give the graph before it, and delete it at the end."""
        interface, controllers = recorded['interface'], recorded['parameters']
        before = graph()
        try:
            if interface:
                self.spawn_robot(
                    ARM.replace('EffortJointInterface', interface),
                    '/arm',
                    {**controllers, 'gazebo_ros_control/pid_gains': recorded['pid_gains']},
                )
            else:
                self.spawn_robot(BURGER, '', controllers)
            services = (recorded['by_plugin'] or {}).get('services', MANAGER)
            wait_until(lambda: len(added(before)['services']) >= len(services), 'all services')
            yield before
        finally:
            self._clean()
            wait_until(lambda: not managers(), 'the services to go')

    def test_drives_and_sensors_of_a_car_are_on_the_wire(self):
        self.spawn_robot(CAR, '/car', {**CAR_CONTROLLERS, GAINS: {'p': 0.0}})
        before = graph()
        for name in CAR_CONTROLLERS:
            self.assertTrue(self.load(name), self.errors)
        self._check_car_topics(before)
        self.assertTrue(self.switch(start=['imus', 'wrenches', 'four']), self.errors)
        imus = self.collect('/car/imu', Imu)
        wrenches = self.collect('/car/wrist', WrenchStamped)
        joint = proxy('get_joint_properties', GetJointProperties)

        def angle(name):
            return joint(name).position[0]

        def drives(name, kind, message, speed, reached=0.2):
            """Command another speed than before, and wait for it [m/s]."""
            topic = '/car/' + name
            odometry = self.collect(topic.rpartition('/')[0] + '/odom', Odometry)
            self.publisher(topic, kind).publish(message)
            wait_until(
                lambda: odometry and abs(speed(odometry[-1].twist.twist) - reached) < 0.005,
                f'the speed by {topic}',
            )

        drives(
            'four/cmd_four_wheel_steering',
            FourWheelSteering,
            FourWheelSteering(speed=0.2, front_steering_angle=0.5, rear_steering_angle=-0.5),
            lambda twist: twist.linear.x,
        )
        steered = self.collect('/car/four/odom_steer', FourWheelSteeringStamped)
        wait_until(
            lambda: steered and abs(steered[-1].data.front_steering_angle - 0.5) < 0.01, 'the angle'
        )
        self.assertGreater(angle('front_left_steer'), 0.5)
        # Its gains let the flap follow the steering.
        self.assertGreater(abs(angle('flap') - angle('front_left_steer')), 0.1)
        client = Client(f'/car/{GAINS}', timeout=DEADLINE)
        self.assertEqual(client.update_configuration({'p': 2.0})['p'], 2.0)
        wait_until(lambda: abs(angle('flap') - angle('front_left_steer')) < 0.05, 'the flap')
        drives(
            'four/cmd_vel', Twist, Twist(linear=Vector3(x=0.3)), lambda twist: twist.linear.x, 0.3
        )
        self.assertTrue(self.switch(start=['mecanum'], stop=['four']), self.errors)
        drives('mecanum/cmd_vel', Twist, Twist(linear=Vector3(y=0.2)), lambda twist: twist.linear.y)
        self.assertTrue(self.switch(start=['bicycle'], stop=['mecanum']), self.errors)
        drives(
            'bicycle/cmd_vel',
            Twist,
            Twist(linear=Vector3(x=0.3), angular=Vector3(z=0.3)),
            lambda twist: twist.linear.x,
            0.3,
        )
        wait_until(lambda: abs(angle('front_left_steer') - 0.3) < 0.01, 'the steering')
        self.assertEqual(
            (imus[-1].header.frame_id, wrenches[-1].header.frame_id), ('base_link', 'flap_link')
        )
        self.assertEqual((periods(imus), periods(wrenches)), ({0.02}, {0.02}))
        self.assertTrue(any(abs(one.linear_acceleration.z - 9.8) < 0.5 for one in imus))
        self.assertTrue(any(abs(abs(one.wrench.force.z) - 4.9) < 0.5 for one in wrenches))

    def _check_car_topics(self, before):
        odometry, commands = (
            {f'/car/{name}/{topic}': kind for name in ('four', 'mecanum', 'bicycle')}
            for topic, kind in (('odom', 'nav_msgs/Odometry'), ('cmd_vel', 'geometry_msgs/Twist'))
        )
        steering = 'four_wheel_steering_msgs/FourWheelSteering'
        self.assertEqual(
            added(before),
            {
                'publishes': {
                    **odometry,
                    '/car/four/odom_steer': f'{steering}Stamped',
                    '/tf': 'tf2_msgs/TFMessage',
                    '/car/imu': 'sensor_msgs/Imu',
                    '/car/wrist': 'geometry_msgs/WrenchStamped',
                },
                'subscribes': {**commands, '/car/four/cmd_four_wheel_steering': steering},
                'services': {},
            },
        )

    def test_goals_are_followed_violated_rejected_and_canceled(self):
        recorded = RECORDED['jtc_position']['parameters']
        self.spawn_robot(
            ARM.replace('EffortJointInterface', 'PositionJointInterface'), parameters=recorded
        )
        self.run_controllers(recorded)
        client = actionlib.SimpleActionClient(
            '/arm/arm_controller/follow_joint_trajectory', FollowJointTrajectoryAction
        )
        self.assertTrue(client.wait_for_server(rospy.Duration(DEADLINE)))
        feedback = []

        def follow(seconds, positions, names=('joint1', 'joint2'), wait=True, start=0.0):
            goal = FollowJointTrajectoryGoal()
            goal.trajectory.header.stamp = rospy.Time.from_sec(start)
            goal.trajectory.joint_names = list(names)
            goal.trajectory.points = [
                JointTrajectoryPoint(positions=positions, time_from_start=rospy.Duration(seconds))
            ]
            client.send_goal(goal, feedback_cb=feedback.append)
            if wait:
                # The goal's own state: SimpleActionClient misses a result that comes at once.
                wait_until(lambda: client.gh.get_comm_state() == actionlib.CommState.DONE, 'result')
            result = client.get_result()
            return (client.get_state(), result.error_code, result.error_string) if wait else None

        self.assertEqual(follow(0.5, [0.5, -0.3]), (GoalStatus.SUCCEEDED, 0, ''))
        query = rospy.ServiceProxy('/arm/arm_controller/query_state', QueryTrajectoryState)
        now = rospy.Time.from_sec(self.world().sim_time)
        self.assertEqual([round(one, 6) for one in query(now).position], [0.5, -0.3])
        self.assertEqual(follow(1.0, [0.5], ['nope']), (GoalStatus.REJECTED, -2, ''))
        past = 'Dropping all 1 trajectory point(s), as they occur before the current time.'
        state, code, text = follow(0.001, [0.0, 0.0], start=0.001)
        self.assertEqual((state, code), (GoalStatus.REJECTED, -1))
        self.assertRegex(text, rf'^{re.escape(past)}\nLast point is \d+\.\d{{6}}s in the past\.$')
        self.publisher('/arm/arm_controller/command', JointTrajectory).publish(
            JointTrajectory(
                Header(stamp=rospy.Time.from_sec(0.001)),
                ['joint1', 'joint2'],
                [JointTrajectoryPoint(positions=[0.0, 0.0])],
            )
        )
        self.heard_errors(past)
        follow(30.0, [0.0, 0.0], wait=False)
        wait_until(lambda: client.get_state() == GoalStatus.ACTIVE, 'the goal to be accepted')
        feedback.clear()
        wait_until(lambda: feedback, 'feedback')
        self.assertEqual(feedback[-1].joint_names, ['joint1', 'joint2'])
        client.cancel_goal()
        wait_until(lambda: client.get_state() == GoalStatus.PREEMPTED, 'the goal to be canceled')
        state, code, text = follow(0.02, [2.5, -2.0])
        self.assertEqual((state, code), (GoalStatus.ABORTED, -4))
        self.assertRegex(text, r'^joint\d path error -?\d\.\d{6}$')

    def test_gains_are_changed_and_the_emergency_stop_takes_the_effort(self):
        parameters = RECORDED['effort_pos']['parameters']
        self.spawn_robot(
            ARM.replace('</robotNamespace>', '</robotNamespace><eStopTopic>stop</eStopTopic>'),
            parameters=parameters,
        )
        self.run_controllers(parameters)
        reports = self.collect('/arm/joint1_position_controller/state', JointControllerState)
        client = Client('/arm/joint1_position_controller/pid', timeout=DEADLINE)
        changed = client.update_configuration({'p': 55.0, 'i_clamp_max': 3.0})
        self.assertEqual((changed['p'], changed['d']), (55.0, 10.0))
        wait_until(lambda: reports and (reports[-1].p, reports[-1].i_clamp) == (55.0, 3.0), 'p')
        self.publisher('/arm/joint1_position_controller/command', Float64).publish(0.5)
        states = self.collect('/arm/joint_states', JointState)
        wait_until(lambda: any(abs(state.effort[0]) > 0.5 for state in list(states)), 'effort')
        stop = self.publisher('/arm/stop', Bool)
        stop.publish(True)
        wait_until(lambda: states[-1].effort[0] == 0.0, 'the stop')
        stop.publish(False)
        wait_until(lambda: states[-1].effort[0] != 0.0, 'effort again')

    def test_a_controller_of_a_users_package_is_loaded_by_its_type(self):
        self.spawn_robot(
            ARM.replace('EffortJointInterface', 'PositionJointInterface'),
            parameters={
                JSC: RECORDED['effort_pos']['parameters'][JSC],
                'swing': {'type': 'my_robot/Swing', 'joint': 'joint2'},
            },
        )
        self.run_controllers([JSC, 'swing'])
        listed = self.call('list_controllers', ListControllers).controller
        self.assertEqual({one.name: one.type for one in listed}['swing'], 'my_robot/Swing')
        states = self.collect('/arm/joint_states', JointState)

        def swings_about(centre):
            angles = [one.position[1] for one in states[-25:]]
            return (
                len(angles) == 25
                and max(abs(max(angles) - centre - 0.1), abs(min(angles) - centre + 0.1)) < 0.02
            )

        wait_until(lambda: swings_about(0.0), 'the swing')
        self.publisher('/arm/swing/command', Float64).publish(0.5)
        wait_until(lambda: swings_about(0.5), 'the swing elsewhere')

    def test_a_robot_drives_by_its_diff_drive_controller(self):
        parameters = RECORDED['diff_drive_controller']['parameters']
        self.spawn_robot(BURGER, '', parameters)
        self.run_controllers(parameters)
        odometry = self.collect('/diff_cont/odom', Odometry)
        frames = self.collect('/tf', TFMessage)
        self.driver('/diff_cont/cmd_vel')(0.2, 0.5)
        wait_until(
            lambda: any(abs(one.twist.twist.linear.x - 0.2) < 0.002 for one in list(odometry)),
            'the speed',
        )
        driving = odometry[-1]
        self.assertEqual(
            (driving.header.frame_id, driving.child_frame_id), ('odom', 'base_footprint')
        )
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


def as_dict(state):
    return {
        'name': state.name,
        'state': state.state,
        'type': state.type,
        'claimed_resources': [
            {'hardware_interface': claim.hardware_interface, 'resources': claim.resources}
            for claim in state.claimed_resources
        ],
    }
