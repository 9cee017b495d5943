"""Wrenches and efforts applied by services give the accelerations of rigid-body mechanics."""

import math

from gazebo_msgs.msg import ODEJointProperties
from gazebo_msgs.srv import (
    ApplyBodyWrench,
    ApplyJointEffort,
    BodyRequest,
    GetJointProperties,
    GetModelProperties,
    JointRequest,
    SetJointProperties,
    SetLinkProperties,
)
from genpy import Duration, Time
from geometry_msgs.msg import Point, Pose, Quaternion, Vector3, Wrench
from rosbots_msgs.srv import Step
from simulator import BOX, SimulatorTest, proxy

SECOND = 1000  # steps
SPEED_TOLERANCE = 0.005  # [m/s] promised of 1 N for 1 s on 1 kg
RATE_TOLERANCE = 0.01  # share, promised
MOMENTS = {'x': 1.0, 'y': 2.0, 'z': 2.5}  # of the body [kg m^2]
QUARTER = Quaternion(0.0, 0.0, math.sqrt(0.5), math.sqrt(0.5))  # a turn to the left
DOOR = """<robot name="door"><link name="world"/>
<link name="leaf"><inertial><mass value="1"/>
  <inertia ixx="0.5" iyy="0.5" izz="0.5" ixy="0" ixz="0" iyz="0"/></inertial></link>
<joint name="hinge" type="continuous">
  <parent link="world"/><child link="leaf"/><axis xyz="0 0 1"/>
</joint></robot>"""
NOW = Time()


class PushesTest(SimulatorTest):
    def setUp(self):
        super().setUp()
        self.pause()
        self.wrench = proxy('apply_body_wrench', ApplyBodyWrench)
        self.effort = proxy('apply_joint_effort', ApplyJointEffort)
        self.clear_wrenches = proxy('clear_body_wrenches', BodyRequest)
        self.clear_forces = proxy('clear_joint_forces', JointRequest)
        self.joint = proxy('get_joint_properties', GetJointProperties)
        self.step = proxy('step', Step)

    def _floating(self, name='box', orientation=None, y=0.0):
        where = Pose(Point(0.0, y, 20.0), orientation or Quaternion(0.0, 0.0, 0.0, 1.0))
        self.assertTrue(self.spawn(name, BOX, where).success)
        response = proxy('set_link_properties', SetLinkProperties)(
            f'{name}::body',
            Pose(),
            False,
            1.0,
            MOMENTS['x'],
            0.0,
            0.0,
            MOMENTS['y'],
            0.0,
            MOMENTS['z'],
        )
        self.assertTrue(response.success, response.status_message)

    def _push(
        self,
        force=(0.0, 0.0, 0.0),
        torque=(0.0, 0.0, 0.0),
        frame='',
        point=(0.0, 0.0, 0.0),
        name='box::body',
        start=NOW,
        seconds=1.0,
    ):
        wrench = Wrench(Vector3(*force), Vector3(*torque))
        response = self.wrench(
            name, frame, Point(*point), wrench, start, Duration.from_sec(seconds)
        )
        self.assertEqual((response.success, response.status_message), (True, ''))

    def _twist(self, name='box'):
        return self.model_state(name, '').twist

    def test_torque_about_each_axis(self):
        for i, axis in enumerate(MOMENTS):
            self._floating(axis, y=5.0 * i)
            self._push(torque=[0.2 * (j == i) for j in range(3)], name=f'{axis}::body')
        self.step(2 * SECOND)
        for axis, moment in MOMENTS.items():
            rate = getattr(self._twist(axis).angular, axis)
            self.assertAlmostEqual(rate, 0.2 / moment, delta=RATE_TOLERANCE * 0.2 / moment)

    def test_wrench_in_the_bodys_frame_is_in_its_axes(self):
        self._floating(orientation=QUARTER)
        self._push(force=(1.0, 0.0, 0.0), frame='box::body')
        self.step(1 * SECOND)
        self.assertAlmostEqual(self._twist().linear.y, 1.0, delta=SPEED_TOLERANCE)
        self.assertAlmostEqual(self._twist().linear.x, 0.0, delta=SPEED_TOLERANCE)

    def test_force_with_a_lever_arm_turns_the_body(self):
        self._floating()
        self._push(force=(1.0, 0.0, 0.0), point=(0.0, -0.1, 0.0))  # lever arm in world axes
        self._floating('far', y=10.0)
        self._push(force=(1.0, 0.0, 0.0), frame='box', name='far::body')  # 10 m to its right
        self.step(int(0.1 * SECOND))
        self.assertAlmostEqual(self._twist().angular.z, 0.01 / MOMENTS['z'], delta=1e-4)
        self.assertAlmostEqual(self._twist('far').angular.z, 1.0 / MOMENTS['z'], delta=0.005)
        self.assertAlmostEqual(self._twist('far').linear.x, 0.1, delta=SPEED_TOLERANCE)

    def test_start_duration_and_clearing_of_wrenches(self):
        start = Time.from_sec(self.world().sim_time + 0.5)
        for i, (name, begin, seconds) in enumerate(
            (
                ('late', start, 1.0),
                ('brief', NOW, 0.2),
                ('none', NOW, 0.0),
                ('endless', NOW, -1.0),
                ('cleared', NOW, -1.0),
                ('deleted', NOW, -1.0),
            )
        ):
            self._floating(name, y=5.0 * i)
            self._push(force=(1.0, 0.0, 0.0), name=f'{name}::body', start=begin, seconds=seconds)
        self.step(SECOND // 2)
        self.clear_wrenches('cleared')  # not the scoped name: no effect
        self.step(SECOND // 4)
        self.clear_wrenches('cleared::body')
        self.assertTrue(self.delete('deleted').success)
        self.step(SECOND // 4)
        for name, speed in (
            ('late', 0.5),
            ('brief', 0.2),
            ('none', 0.0),
            ('endless', 1.0),
            ('cleared', 0.75),
        ):
            self.assertAlmostEqual(self._twist(name).linear.x, speed, delta=SPEED_TOLERANCE)

    def test_a_joint_motor_and_damping(self):
        self.spawn('door', DOOR)
        change = proxy('set_joint_properties', SetJointProperties)
        self.assertTrue(change('hinge', ODEJointProperties(fmax=[5.0], vel=[0.5])).success)
        self.step(SECOND)
        self.assertAlmostEqual(self.joint('hinge').rate[0], 0.5, delta=0.005)
        coasting = ODEJointProperties(fmax=[0.0], damping=[0.5])  # factor 1/e each second
        self.assertTrue(change('hinge', coasting).success)
        self.step(SECOND)
        self.assertAlmostEqual(self.joint('hinge').rate[0], 0.5 / math.e, delta=0.005)
        stopped = ODEJointProperties(loStop=[-0.1], hiStop=[self.joint('hinge').position[0] + 0.05])
        self.assertTrue(change('hinge', stopped).success)
        self.step(3 * SECOND)
        self.assertLess(self.joint('hinge').position[0], stopped.hiStop[0] + 0.01)

    def test_effort_turns_a_door(self):
        self.spawn('door', DOOR)
        self.assertEqual(
            proxy('get_model_properties', GetModelProperties)('door').joint_names, ['hinge']
        )
        self.assertTrue(self.effort('hinge', 0.1, NOW, Duration(1)).success)
        self.step(SECOND + 100)
        rate = self.joint('door::hinge').rate[0]
        self.assertAlmostEqual(rate, 0.1 / 0.5, delta=RATE_TOLERANCE * 0.2)
        self.assertTrue(self.effort('hinge', -0.1, NOW, Duration(-1)).success)
        self.step(SECOND)
        self.clear_forces('door::hinge')  # not the plain name: no effect
        self.step(SECOND)
        self.clear_forces('hinge')
        self.step(SECOND)
        self.assertAlmostEqual(self.joint('hinge').rate[0], rate - 0.4, delta=0.004)
