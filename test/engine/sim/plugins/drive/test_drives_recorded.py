"""Side effects of drive plugins, as recorded in Gazebo."""

from contextlib import closing

import numpy as np
import pytest
from support.recorded import DATA

from rosbots_description.sim.core.transforms import Pose
from rosbots_description.sim.formats.urdf.urdf import load_urdf
from rosbots_description.sim.public.world import World

FREE = 0.07  # by this share Gazebo's free wheels change their speeds all the time
STEERED = 0.008  # [rad] in a period of the plugin, after which it may stop


@pytest.fixture
def world():
    with closing(World.empty()) as made:
        yield made


def spawn(world, name, z=0.0):
    """Return the plugin of a recorded robot, and lists of the readings of its outputs."""
    text = (DATA / 'robots' / f'{name}.urdf').read_text(encoding='utf-8')
    model = world.spawn(load_urdf(text, name, robot_namespace='/')[0], name, Pose((0.0, 0.0, z)))
    found = {}
    for output, readings in next(iter(model.plugins.values())).outputs.items():
        readings.connect(found.setdefault(output, []).append)
    return next(iter(model.plugins.values())), found


def test_planar_move_in_the_air_sinks_by_gravity_in_each_step(world):
    plugin, found = spawn(world, 'planar', z=0.3)
    world.run(2122)
    pose, twist = plugin.model.state()
    assert pose.position == pytest.approx((0.0, 0.0, 0.27921), abs=1e-5)  # as recorded
    assert twist.linear == pytest.approx((0.0, 0.0, -0.0098))
    assert found['odometry'][-1].pose.position[2] == 0.0
    assert found['odometry_transform'][-1].pose.position[2] == pytest.approx(0.2795, abs=5e-4)


def test_twist_of_planar_move_is_in_the_axes_at_the_end_of_the_step(world):
    plugin, found = spawn(world, 'planar', z=0.3)
    plugin.command(0.3, 0.4, 0.1)
    world.run(1000)
    linear, angular = found['odometry'][-1].twist
    assert linear == pytest.approx((0.30102, 0.096873, 0.0), abs=1e-4)  # as recorded
    assert angular[2] == pytest.approx(0.4, abs=1e-6)


def test_joint_speeds_and_encoders_of_a_steered_tricycle_agree_with_the_recording(world):
    plugin, found = spawn(world, 'tricycle', z=0.02)
    plugin.command(0.5, 0.5)
    world.run(4500)
    states = found['joint_states'][-1]
    assert states.names == ('steer_joint', 'front_joint', 'left_joint', 'right_joint')
    assert states.positions[0] == pytest.approx(0.4878, abs=STEERED)
    assert states.velocities[1:] == pytest.approx((5.0185, 3.2903, 5.4055), rel=FREE)
    linear, angular = found['odometry'][-1].twist
    assert np.hypot(linear[0], linear[1]) == pytest.approx(0.4347, rel=FREE)
    assert angular[2] == pytest.approx(-0.4229, rel=1.5 * FREE)  # the wrong way round, as recorded
    assert {(one.parent, one.child) for one in found['wheel_transform']} == {
        ('base_footprint', 'steer_joint'),
        ('fork_link', 'front_joint'),
        ('base_footprint', 'left_joint'),
        ('base_footprint', 'right_joint'),
    }
