"""Force-based movement: forces proportional to the error of velocity, expiry, odometry."""

import math

import pytest

from rosbots_description.sim.core.transforms import Pose, from_rpy, yaw_of
from rosbots_description.sim.formats.urdf.urdf import load_urdf

MASS, INERTIA = 10.0, 2.0  # [kg], [kg m^2]
GAIN, YAW_GAIN = 100.0, 40.0  # [N s/m], [N m s/rad]
STEP = 0.001  # [s]
YAW = 0.7  # of the spawn pose [rad]
GAINS = (
    f'<x_velocity_p_gain>{GAIN}</x_velocity_p_gain><y_velocity_p_gain>{GAIN}</y_velocity_p_gain>'
    f'<yaw_velocity_p_gain>{YAW_GAIN}</yaw_velocity_p_gain>'
)
HECTOR, RIDGEBACK = 'gazebo_ros_force_based_move', 'ridgeback_ros_force_based_move'


def box(library=HECTOR, base='base_link', tags='', gains=GAINS):
    """Return a model without gravity that only the plugin moves."""
    return load_urdf(
        f"""<robot name="box"><link name="base_link"><inertial><mass value="{MASS}"/>
        <inertia ixx="2" iyy="2" izz="{INERTIA}" ixy="0" ixz="0" iyz="0"/></inertial></link>
        <gazebo reference="base_link"><turnGravityOff>true</turnGravityOff></gazebo>
        <gazebo><plugin name="move" filename="lib{library}.so">
        <robotBaseFrame>{base}</robotBaseFrame>{gains}{tags}
        </plugin></gazebo></robot>""",
        'box',
    )[0]


def approached(wanted, gain, inertia, steps):
    """Return the velocity by v' = k (wanted - v) / m in explicit steps from rest."""
    return wanted * (1.0 - (1.0 - gain * STEP / inertia) ** steps)


def test_the_velocity_approaches_the_command_in_the_models_own_axes(world):
    model = world.spawn(box(), 'box', Pose((0.0, 0.0, 1.0), from_rpy(0.0, 0.0, YAW)))
    model.plugin('move').command(0.5, 0.0, 0.2)
    world.run(50)
    x, y = (approached(wanted, GAIN, MASS, 50) for wanted in (0.5, 0.2))
    cos, sin = math.cos(YAW), math.sin(YAW)
    assert model.twist.linear == pytest.approx(
        (cos * x - sin * y, sin * x + cos * y, 0.0), abs=1e-6
    )
    model.plugin('move').command(0.0, 0.4)
    world.run(2000)
    assert model.twist.linear == pytest.approx((0.0, 0.0, 0.0), abs=1e-4)
    assert model.twist.angular == pytest.approx((0.0, 0.0, 0.4), abs=1e-4)


def test_the_yaw_rate_approaches_the_command(world):
    model = world.spawn(box(), 'box', Pose((0.0, 0.0, 1.0)))
    model.plugin('move').command(0.0, 0.4)
    world.run(50)
    assert model.twist.angular[2] == pytest.approx(approached(0.4, YAW_GAIN, INERTIA, 50), rel=1e-5)


def test_gains_have_upstreams_defaults(world):
    model = world.spawn(box(gains=''), 'box', Pose((0.0, 0.0, 1.0)))
    model.plugin('move').command(0.5, 0.4, 0.2)
    world.run(1)
    x, y = (approached(wanted, 10_000.0, MASS, 1) for wanted in (0.5, 0.2))
    assert model.twist.linear == pytest.approx((x, y, 0.0), rel=1e-5)
    assert model.twist.angular[2] == pytest.approx(approached(0.4, 100.0, INERTIA, 1), rel=1e-5)


@pytest.mark.parametrize(
    ('library', 'tags', 'moves'),
    [
        (HECTOR, '', True),
        (RIDGEBACK, '', False),
        (RIDGEBACK, '<cmdVelTimeOut>30</cmdVelTimeOut>', True),
    ],
)
def test_a_command_of_ridgebacks_plugin_expires(world, library, tags, moves):
    model = world.spawn(box(library, tags=tags), 'box', Pose((0.0, 0.0, 1.0)))
    model.plugin('move').command(0.5, 0.0)
    world.run(249)
    assert model.twist.linear[0] > 0.4
    world.run(2000)
    assert (model.twist.linear[0] > 0.4) == moves


def test_odometry_begins_at_the_spawn_pose(world):
    start = Pose((2.0, 3.0, 1.0), from_rpy(0.0, 0.0, YAW))
    model = world.spawn(box(), 'box', start)
    plugin = model.plugin('move')
    readings = []
    plugin.odometry.connect(readings.append)
    plugin.command(0.5, 0.1)
    world.run(1000)
    (x, y, z), orientation = readings[-1].pose
    assert (x, y) == pytest.approx((0.5 * 0.9, 0.02), abs=0.03)  # the time constant is 0.1 s
    assert z == pytest.approx(0.0, abs=1e-6)
    assert yaw_of(orientation) == pytest.approx(0.1 * (1.0 - INERTIA / YAW_GAIN), abs=0.005)
    assert readings[-1].twist.linear == pytest.approx((0.5, 0.0, 0.0), abs=0.01)
    assert len(readings) == 19  # 20 Hz, each one step late, as in Gazebo


def test_a_base_that_does_not_exist_leaves_the_plugin_out(world, caplog):
    model = world.spawn(box(base='nowhere'), 'box', Pose())
    assert not model.plugins
    assert 'robotBaseFrame: nowhere does not exist' in caplog.text
