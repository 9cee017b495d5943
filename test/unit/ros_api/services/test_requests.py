"""Checks and conversions of requests: rejections, wrenches, joint limits, real-time factor."""

import math
from types import SimpleNamespace

import pytest
from gazebo_msgs.msg import ModelState, ODEJointProperties
from gazebo_msgs.srv import (
    SetJointPropertiesRequest,
    SetModelConfigurationRequest,
    SpawnModelRequest,
)
from support import package_directory
from support.fake_engine import FakeEngine

from rosbots_description.ros_api.messages.validity import RequestError, require_finite
from rosbots_description.ros_api.reconfigure.physics import PARAMETERS, settings
from rosbots_description.ros_api.server.server import Server
from rosbots_description.ros_api.services.joints import changed_spec, set_joint_properties
from rosbots_description.ros_api.services.links import world_wrench
from rosbots_description.ros_api.services.physics import get_physics_properties
from rosbots_description.ros_api.topics.performance import RealTimeFactor
from rosbots_description.sim.core.errors import SimError
from rosbots_description.sim.core.transforms import Pose, from_rpy
from rosbots_description.sim.description.model_spec import (
    Inertial,
    JointSpec,
    LinkSpec,
    ModelSpec,
)
from rosbots_description.sim.description.physics_settings import PhysicsSettings, check_physics
from rosbots_description.sim.runtime.world import World

HINGE = JointSpec('hinge', 'revolute', 'a', 'b', lower=-1.0, upper=1.0)
QUARTER = from_rpy(0.0, 0.0, math.pi / 2)


@pytest.mark.parametrize('number', [math.nan, math.inf, -math.inf])
def test_error_names_a_number_that_is_not_finite(number):
    message = ModelState()
    message.twist.angular.y = number
    with pytest.raises(RequestError, match=f'twist.angular.y is {number}; it must be a finite'):
        require_finite(message)


def test_error_names_the_index_in_a_list():
    request = SetModelConfigurationRequest(joint_positions=[0.0, math.nan])
    with pytest.raises(RequestError, match=r'joint_positions\[1\] is nan'):
        require_finite(request)


def test_texts_and_finite_numbers_are_accepted():
    require_finite(SpawnModelRequest(model_name='nan', model_xml='inf'))


def test_wrench_without_a_frame_is_in_world_axes_with_the_point_as_lever_arm():
    body = Pose((5.0, 0.0, 0.0), QUARTER)
    force, torque = world_wrench((1.0, 0.0, 0.0), (0.0, 0.0, 1.0), (0.0, 2.0, 0.0), None, body)
    assert force == (1.0, 0.0, 0.0)
    assert torque == pytest.approx((0.0, 0.0, -1.0))


def test_wrench_in_a_frame_is_rotated_and_acts_at_its_origin():
    frame, body = Pose((1.0, 0.0, 0.0), QUARTER), Pose((0.0, 0.0, 0.0))
    force, torque = world_wrench((1.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 2.0, 0.0), frame, body)
    assert force == pytest.approx((0.0, 1.0, 0.0))
    # The rotated torque, -2 by the point's lever arm, +1 by the frame's.
    assert torque == pytest.approx((0.0, 1.0, -1.0))


def test_limits_and_damping_of_a_joint_change_independently():
    assert changed_spec(HINGE, {'upper': 2.0}).upper == 2.0
    assert changed_spec(HINGE, {'upper': 2.0}).lower == -1.0
    assert changed_spec(HINGE, {'damping': 0.5}).damping == 0.5
    assert changed_spec(HINGE, {}) == HINGE
    assert changed_spec(HINGE, {'lower': -1e16, 'upper': 1e16}).lower is None


@pytest.mark.parametrize(
    ('changes', 'words'),
    [
        ({'lower': 1.5}, 'loStop 1.5'),
        ({'upper': -2.0}, 'hiStop -2'),
        ({'damping': -1.0}, 'damping'),
    ],
)
def test_crossed_limits_and_negative_damping_are_rejected(changes, words):
    with pytest.raises(RequestError, match=words):
        changed_spec(HINGE, changes)


def _set_joint(**fields):
    world = World(make_engine=FakeEngine)
    links = LinkSpec('a', inertial=Inertial(1.0)), LinkSpec('b', inertial=Inertial(1.0))
    joint = world.spawn(ModelSpec('m', links, (HINGE,)), 'm', Pose()).joint('hinge')
    joint.set_motor(1.0, 2.0)
    server = Server(world, None, None, package_directory, lambda _: None, None)
    request = SetJointPropertiesRequest('hinge', ODEJointProperties(**fields))
    try:
        set_joint_properties(server, request)
    except RequestError as error:
        return joint, str(error)
    return joint, ''


def test_given_motor_and_limits_are_applied():
    assert _set_joint(vel=[3.0])[0].motor == (3.0, 2.0)
    assert _set_joint(fmax=[4.0, 5.0])[0].motor == (1.0, 4.0)
    joint, _ = _set_joint(vel=[3.0], hiStop=[1.5])
    assert (joint.motor, joint.spec.upper) == ((3.0, 2.0), 1.5)


@pytest.mark.parametrize(
    ('fields', 'words'),
    [
        (
            {'fmax': [-1.0], 'damping': [0.5]},
            "fmax of joint 'hinge' is -1; it must not be negative [N m or N]",
        ),
        ({'vel': [3.0], 'damping': [-1.0]}, 'damping'),
        ({'fmax': [3.0], 'loStop': [2.0]}, 'loStop 2'),
    ],
)
def test_rejected_change_of_a_joint_changes_nothing(fields, words):
    joint, sentence = _set_joint(**fields)
    assert words in sentence
    assert (joint.motor, joint.spec) == ((1.0, 2.0), HINGE)


def test_real_time_factor_survives_a_reset():
    factor = RealTimeFactor(10.0, 100.0)
    assert factor.update(11.0, 102.0) == 0.5
    assert factor.update(11.0, 103.0) == 0.0
    assert factor.update(0.1, 104.0) == 0.0
    assert factor.update(2.1, 105.0) == 2.0
    assert factor.update(2.2, 105.0) == 0.0


@pytest.mark.parametrize(
    ('changes', 'words'),
    [
        ({'step_size': 0.0}, 'step_size is 0; it must be from 1e-09 to 10'),
        ({'step_size': 11.0}, 'step_size is 11'),
        ({'max_update_rate': -1.0}, 'max_update_rate is -1; .* 0 is as fast as possible'),
        ({'max_update_rate': 1e-5}, 'at least 0.001'),
        ({'gravity': (0.0, math.nan, 0.0)}, 'gravity is .* finite'),
        ({'gravity': (0.0, -1.1e6, 0.0)}, 'gravity is .* at most 1e[+]06'),
        ({'erp': math.inf}, 'erp is inf'),
        ({'sor_pgs_iters': 10_001}, 'sor_pgs_iters is 10001'),
        ({'sor_pgs_precon_iters': 10_001}, 'sor_pgs_precon_iters is 10001'),
        ({'max_contacts': 4_000_000_000}, 'max_contacts is'),
    ],
)
def test_invalid_settings_are_rejected(changes, words):
    with pytest.raises(SimError, match=words):
        check_physics(PhysicsSettings(**changes))


def test_unusual_settings_are_accepted():
    check_physics(PhysicsSettings())
    check_physics(PhysicsSettings(gravity=(1e6, -1e6, 1e6)))
    check_physics(
        PhysicsSettings(
            step_size=10.0,
            max_update_rate=0.0,
            gravity=(0.0, 0.0, 0.0),
            sor_pgs_iters=0,
            max_contacts=0,
        )
    )


def test_every_reconfigure_parameter_has_a_value_and_its_type():
    world = SimpleNamespace(physics=PhysicsSettings(), paused=False)
    live = settings(get_physics_properties(SimpleNamespace(world=world), None))
    assert {name: type(value) for name, value in live.items()} == {
        p.name: type(p.default) for p in PARAMETERS
    }
    assert (live['sor_pgs_iters'], live['gravity_z']) == (50, -9.8)
