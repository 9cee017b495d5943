#!/usr/bin/env python3
"""The server answers any input soon, its memory stays bounded, and another robot drives on."""

import contextlib
import io
import math
import os
import sys
import tempfile
from itertools import pairwise
from pathlib import Path

import rospy
import rostest
from gazebo_msgs.msg import ModelState
from gazebo_msgs.srv import (
    ApplyBodyWrench,
    ApplyJointEffort,
    GetModelState,
    GetPhysicsProperties,
    SetLinkProperties,
    SetModelConfiguration,
    SetModelState,
    SetPhysicsProperties,
    SpawnModel,
)
from geometry_msgs.msg import Twist, Vector3, Wrench
from nav_msgs.msg import Odometry
from programs import memory_of
from simulator import BOX, SimulatorTest, pose, process_of, proxy, wait_until

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from support.hostile import cases

ANSWERED = 10.0  # [s] of the server's processor time, for what takes at most 2
GROWN = 600e6  # [bytes] growth by all cases together; one of 100 MB needs as much for a moment
FORWARD, TURN = 0.3, 0.3  # [m/s, rad/s] commands of the neighbour
FASTEST = 0.6  # [m/s] bound of the neighbour's speed
TURNS = 0.15  # [rad/s] least yaw rate; half the command
HEIGHT, SINKS = -0.12, 0.02  # [m] height of its origin at rest, and tolerance
AFTERWARDS = 5  # odometry messages, every 10 ms of simulated time
STEADY = 50  # odometry messages after which the neighbour counts as driving
AWAY = (30.0, 30.0, 0.5)  # [m] spawn position, away from the neighbour
HUGE = (math.nan, math.inf, -math.inf, 1e308)
ODD_NAMES = ('a/b', '/a', 'a b', 'ünï', '🤖', 'a\'b"c', '<a>', '%s{}', '::', '$(a)', '~', '..')
ODD_NAMESPACES = ('a b', '\n', 'ü', '..', 'a' * 10_000)  # none of them gives the topic /odom
UNFIT_NAMES = ('', 'a\nb', 'a\0b', 'a\tb', 'a' * 100_000)


class RawRequest(SpawnModel._request_class):
    """A request whose texts are bytes, sent as they are."""

    def serialize(self, buff):
        """Serialize like SpawnModelRequest, without encoding."""
        stream = io.BytesIO()
        plain = SpawnModel._request_class(
            self.model_name, 'XML', *[getattr(self, slot) for slot in self.__slots__[2:]]
        )
        plain.serialize(stream)
        name = self.model_name.encode()
        rest = stream.getvalue()[4 + len(name) + 4 + 3 :]
        for text in (name, self.model_xml):
            buff.write(len(text).to_bytes(4, 'little') + text)
        buff.write(rest)


def _distance(one, other):
    a, b = one.pose.pose.position, other.pose.pose.position
    return math.dist((a.x, a.y, a.z), (b.x, b.y, b.z))


def _farthest(one, other):
    """Return the greatest distance of the neighbour between two odometry messages [m]."""
    return FASTEST * (other.header.stamp - one.header.stamp).to_sec() + 0.001


class HostileTest(SimulatorTest):
    """A neighbour drives in a circle during all tests of this file."""

    def setUp(self):
        super().setUp()
        self.assertTrue(self.spawn('neighbour').success)
        self._drive = self.driver()
        self._odometry = self.collect('/odom', Odometry)
        self._spawn_sdf = proxy('spawn_sdf_model', SpawnModel)
        wait_until(self._is_driving, 'motion of the neighbour')
        self._pid = process_of()

    def _is_driving(self):
        self._drive(FORWARD, TURN)  # repeated: the first may reach a deleted robot
        # Beyond its ramp, and beyond the swing after its drop to the ground.
        latest = list(self._odometry)[-STEADY:]
        return len(latest) == STEADY and all(
            reading.twist.twist.angular.z > 0.9 * TURN for reading in latest
        )

    def _processor_time(self):
        """Return the processor time that the server has used [s]."""
        fields = Path(f'/proc/{self._pid}/stat').read_text(encoding='ascii').rpartition(')')[2]
        user, system = fields.split()[11:13]
        return (int(user) + int(system)) / os.sysconf('SC_CLK_TCK')

    @contextlib.contextmanager
    def _neighbour_drives_on(self):
        """Assert that the neighbour meanwhile drives as commanded, without a jump."""
        self._odometry.clear()
        wait_until(lambda: self._odometry, 'a first odometry message')
        yield
        count = len(self._odometry)
        wait_until(lambda: len(self._odometry) > count + AFTERWARDS, 'further odometry')
        path = list(self._odometry)
        for one, next_one in pairwise(path):
            self.assertLess(_distance(one, next_one), _farthest(one, next_one))
        for reading in path[count:]:
            self.assertGreater(reading.twist.twist.angular.z, TURNS)
            self.assertLess(abs(reading.pose.pose.position.z - HEIGHT), SINKS)

    def _send(self, case, folder):
        """Return success and message of a case."""
        text = case.text(folder)
        service = self._spawn_sdf if case.kind == 'sdf' else self.spawn_service
        request = RawRequest(
            'hostile', text if isinstance(text, bytes) else text.encode(), '/', pose(*AWAY), ''
        )
        try:
            response = service.call(request)
        except rospy.ServiceException as error:
            self.assertTrue(case.call_error, str(error))
            return False, str(error)
        self.assertFalse(case.call_error, response)
        return response.success, response.status_message

    def test_descriptions(self):
        before = memory_of(self._pid)
        with tempfile.TemporaryDirectory() as folder:
            for case in cases():
                if case.kind == 'world' or not case.wire:
                    continue
                with self.subTest(case.name), self._neighbour_drives_on():
                    begin = self._processor_time()
                    own = Path(folder, case.name)
                    own.mkdir()
                    success, sentence = self._send(case, own)
                    self.assertLess(self._processor_time() - begin, ANSWERED)
                    self.assertEqual(success, not case.says, sentence)
                    self.assertIn(case.wire_says or case.says, sentence)
                    self.assertNotIn('\n', sentence)
                    self.assertEqual(
                        success, 'hostile' in self.world().model_names, self.world().model_names
                    )
                    if success:
                        self.assertTrue(self.delete('hostile').success)
        self.assertLess(memory_of(self._pid) - before, GROWN)

    def test_text_that_is_not_unicode(self):
        with self._neighbour_drives_on():
            response = self.spawn_service.call(
                RawRequest('hostile', b'<robot name="caf\xe9"/>', '/', pose(*AWAY), '')
            )
            self.assertFalse(response.success)

    def test_names(self):
        with self._neighbour_drives_on():
            for name in ODD_NAMES:
                with self.subTest(name):
                    self.assertTrue(self.spawn(name, BOX, pose(*AWAY)).success)
                    self.assertTrue(self.model_state(name, '').success)
                    self.assertTrue(self.delete(name).success)
            for name in UNFIT_NAMES:
                with self.subTest(name[:20]):
                    response = self.spawn(name, BOX, pose(*AWAY))
                    self.assertFalse(response.success)
                    self.assertIn('name', response.status_message)
                    self.assertFalse(self.model_state(name or 'x', '').success)
                    self.assertFalse(self.delete(name).success)
            for namespace in ODD_NAMESPACES:
                with self.subTest(namespace=namespace[:20]):
                    response = self.spawn('robot', None, pose(*AWAY), namespace=namespace)
                    self.assertTrue(response.success, response.status_message)
                    self.assertTrue(self.delete('robot').success)
            response = self.spawn('robot', None, pose(*AWAY), namespace='a\x01b')
            self.assertFalse(response.success)
            self.assertIn('robot_namespace', response.status_message)
            self.assertEqual(self.world().model_names, ['ground_plane', 'neighbour'])

    def test_numbers(self):
        """Extreme numbers are rejected, or leave finite states."""
        self.assertTrue(self.spawn('box', BOX, pose(*AWAY)).success)
        services = {
            name: proxy(name, kind)
            for name, kind in {
                'set_model_state': SetModelState,
                'apply_body_wrench': ApplyBodyWrench,
                'apply_joint_effort': ApplyJointEffort,
                'set_link_properties': SetLinkProperties,
                'set_model_configuration': SetModelConfiguration,
                'get_physics_properties': GetPhysicsProperties,
                'set_physics_properties': SetPhysicsProperties,
            }.items()
        }
        with self._neighbour_drives_on():
            for number in HUGE:
                with self.subTest(number):
                    self._send_number(services, number)
                self.assertTrue(proxy('get_model_state', GetModelState)('box', '').success)
            physics = services['get_physics_properties']()
            for step in (-0.001, 0.0, *HUGE):
                with self.subTest(step=step):
                    response = services['set_physics_properties'](
                        step, physics.max_update_rate, physics.gravity, physics.ode_config
                    )
                    self.assertFalse(response.success, response)
            self.assertEqual(services['get_physics_properties']().time_step, physics.time_step)

    def _send_number(self, services, number):
        finite = math.isfinite(number)
        spawned = self.spawn('far', BOX, pose(number, *AWAY[1:]))
        if spawned.success:
            self.delete('far')
        self.assertFalse(spawned.success and not finite)
        for state in (
            ModelState('box', pose(number, *AWAY[1:]), Twist(), ''),
            ModelState('box', pose(*AWAY), Twist(linear=Vector3(number, 0, 0)), ''),
        ):
            self.assertFalse(services['set_model_state'](state).success and not finite)
        wrench = Wrench(force=Vector3(0, 0, number))
        answer = services['apply_body_wrench'](
            'box::body', '', pose().position, wrench, rospy.Time(), rospy.Duration(0.01)
        )
        self.assertFalse(answer.success and not finite)
        answer = services['apply_joint_effort'](
            'no_such_joint', number, rospy.Time(), rospy.Duration(0.01)
        )
        self.assertFalse(answer.success)
        answer = services['set_link_properties'](
            'box::body', pose(0, 0, 0), True, number, 1, 0, 0, 1, 0, 1
        )
        self.assertFalse(answer.success and not finite)
        answer = services['set_model_configuration']('neighbour', '', ['no_such_joint'], [number])
        self.assertFalse(answer.success and not finite)


if __name__ == '__main__':
    rospy.init_node('test_hostile', disable_rostime=True)
    rostest.rosrun('rosbots_description', 'hostile', HostileTest, sys.argv)
