"""Wrenches applied to links by the service."""

import math

import pytest
from gazebo_msgs.srv import ApplyBodyWrenchRequest
from geometry_msgs.msg import Vector3, Wrench
from rospy import Duration
from support import urdf_spec
from support.bench import NESTED, Bench, box_urdf, empty_world

from rosbots_description.sim.core.transforms import Pose, from_rpy
from rosbots_description.sim.formats.sdf.sdf import load_sdf

QUARTER = from_rpy(0.0, 0.0, math.pi / 2.0)


def test_wrench_may_be_given_in_the_frame_of_a_nested_model():
    with empty_world() as world:
        spec, _ = load_sdf(NESTED, 'outer', find_model=lambda _: None)
        world.spawn(spec, 'outer', Pose((0.0, 10.0, 1.0), QUARTER))
        box = world.spawn(urdf_spec(box_urdf('1 1 1', 2.0)), 'box', Pose((0.0, 0.0, 9.0)))
        answer = Bench(world).call(
            'apply_body_wrench',
            ApplyBodyWrenchRequest(
                body_name='box::box',
                reference_frame='outer::inner',
                wrench=Wrench(force=Vector3(2.0, 0.0, 0.0)),
                duration=Duration(1),
            ),
        )
        assert answer.success
        world.run(100)
        vx, vy, _ = box.twist.linear
    # a = F / m = 1 m/s^2 for 0.1 s; x of the inner model points along y of the world
    assert (vx, vy) == pytest.approx((0.0, 0.1), abs=1e-3)
