"""Hector's IMU and satellite navigation agree with mechanics and geodesy."""

import math
from dataclasses import replace

import numpy as np
import pytest
from support.sensing import collected, timed

from rosbots_description.ros_api.adapters.imus import fix_message
from rosbots_description.sim.core.errors import NotFoundError
from rosbots_description.sim.core.transforms import Pose, Twist, from_rpy, multiply, rotate
from rosbots_description.sim.public.world import World

ROBOT = """<robot name="r"><link name="base"><inertial><mass value="1"/><inertia ixx="1" ixy="0"
ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link><link name="mast"><inertial><mass value=".001"/>
<inertia ixx="1e-6" ixy="0" ixz="0" iyy="1e-6" iyz="0" izz="1e-6"/></inertial></link>
<joint name="j" type="fixed"><parent link="base"/><child link="mast"/>
<origin xyz="0 0 2" rpy="0 0 .5"/></joint>
<gazebo><plugin name="p" filename="libhector_gazebo_ros_{library}.so">{tags}</plugin></gazebo>
</robot>"""
GRAVITY = 9.8  # [m/s^2]


@pytest.fixture
def world():
    with World() as made:
        yield made


def spawn(world, library, output, tags='', **pose):
    """Return model, plugin, and a list to which an output appends its readings."""
    model = world.spawn(ROBOT.format(library=library, tags=tags), 'r', **pose)
    plugin = model.plugin('p')
    return model, plugin, collected(plugin.outputs[output])


def test_fix_is_on_the_ellipsoid_with_x_north_and_y_west(world):
    _, plugin, found = spawn(world, 'gps', 'fix', x=100.0, y=50.0, z=3.0)
    plugin.report()
    fix = found[0]
    # A degree there, by the usual series of WGS 84: 111227.13 m to the north, 71844.36 m east.
    assert fix.latitude == pytest.approx(49.9 + 100.0 / 111227.13, abs=1e-9)
    assert fix.longitude == pytest.approx(8.9 - 50.0 / 71844.36, abs=1e-8)
    assert fix.altitude == pytest.approx(3.0)
    assert (fix.status, fix.service, fix.variances) == (0, 0, (0.0, 0.0, 0.0))


def test_heading_rotates_position_and_velocity(world):
    tags = (
        '<referenceLatitude>0</referenceLatitude><referenceLongitude>0</referenceLongitude>'
        '<referenceHeading>90</referenceHeading><referenceAltitude>7</referenceAltitude>'
    )
    model, plugin, found = spawn(world, 'gps', 'fix', tags, y=100.0)
    velocities = collected(plugin.outputs['velocity'])
    model.set_twist(Twist((0.0, 2.0, 0.5), (0.0, 0.0, 0.0)))
    plugin.report()
    assert found[0][:3] == pytest.approx((100.0 / 110574.3, 0.0, 7.0), abs=1e-7)
    assert velocities[0] == pytest.approx((2.0, 0.0, 0.5))


def test_fix_has_a_rate_of_4_hz_on_a_reduced_link_too(world):
    _, plugin, _ = spawn(world, 'gps', 'fix', '<bodyName>mast</bodyName>')
    found = timed(world, plugin.outputs['fix'])
    world.run(750)
    assert [time for time, _ in found] == [250, 500, 750]
    assert found[0][1].altitude == pytest.approx(2.0 - GRAVITY * 0.25**2 / 2, abs=0.01)


def test_message_has_its_covariance(world):
    tags = '<drift>3 3 3</drift><gaussianNoise>4 0 1</gaussianNoise><service>1</service>'
    _, plugin, found = spawn(world, 'gps', 'fix', tags)
    plugin.report()
    message = fix_message(found[0])
    assert list(message.position_covariance[::4]) == [25.0, 9.0, 10.0]
    assert (message.position_covariance_type, message.status.service) == (2, 1)


def test_drift_and_noise_have_their_deviation_and_correlation_time():
    """Over many seeds, as one drift is nearly constant."""
    tags = (
        '<accelDrift>.3</accelDrift><accelDriftFrequency>0.1</accelDriftFrequency>'
        '<yawDrift>.1</yawDrift><accelOffset>1 0 0</accelOffset>'
    )
    drifts = []
    for seed in range(150):
        with World() as world:
            world.seed = seed
            plugin = spawn(world, 'imu', 'imu', tags)[1]
            drifts.append([plugin._accel.drift(time) for time in (0.0, 10.0, 100.0)])
            assert plugin._accel.bias(5.0) - plugin._accel.drift(5.0) == pytest.approx((1, 0, 0))
    now, later, last = np.array(drifts).transpose(1, 0, 2).reshape(3, -1)
    for drift in (now, later, last):
        assert drift.std() == pytest.approx(0.3, rel=0.1)
    assert (now * later).mean() == pytest.approx(0.3**2 * math.exp(-1.0), abs=0.02)
    assert (now * last).mean() == pytest.approx(0.0, abs=0.02)


def test_drift_of_the_velocity_is_integrated_into_the_position(world):
    tags = '<velocityDrift>.5</velocityDrift><driftFrequency>0.001</driftFrequency>'
    plugin = spawn(world, 'gps', 'fix', tags)[1]
    model, step = plugin._speed, 0.5
    moved = sum(
        math.exp(-0.001 * (100.0 - time)) * model.drift(time) * step
        for time in np.arange(0.25, 100.0, step)
    )
    assert model.integrated_drift(100.0, plugin._position.frequency) == pytest.approx(
        moved, rel=1e-3
    )


@pytest.mark.parametrize(
    ('tags', 'mount'),
    [('', 0.0), ('<bodyName>mast</bodyName>', 0.5), ('<rpyOffset>0 0 .5</rpyOffset>', 0.5)],
)
def test_falling_imu_measures_orientation_and_rate_and_no_acceleration(world, tags, mount):
    model, _, found = spawn(world, 'imu', 'imu', tags)
    attitude = from_rpy(0.0, 0.3, 0.4)
    model.set_pose(Pose((0.0, 0.0, 50.0), attitude))
    model.set_twist(Twist((0.0, 0.0, 0.0), (0.0, 0.0, 1.0)))
    world.run(3)
    reading = found[-1]
    assert reading.orientation == pytest.approx(
        multiply(attitude, from_rpy(0.0, 0.0, mount)), abs=0.005
    )
    assert rotate(reading.orientation, reading.angular_velocity) == pytest.approx(
        (0.0, 0.0, 1.0), abs=0.005
    )
    assert np.linalg.norm(reading.linear_acceleration) < 2.1  # of the mast, 2 m off the axis


def test_imu_at_rest_measures_gravity_and_its_errors_tilt_the_orientation(world):
    tags = (
        '<accelOffset>.49 0 0</accelOffset><yawOffset>.2</yawOffset><rateOffset>0 0 1'
        '</rateOffset><rateScaleError>2 2 2</rateScaleError><accelGaussianNoise>.98 .98 0'
        '</accelGaussianNoise><yawGaussianNoise>.1</yawGaussianNoise>'
    )
    _, plugin, found = spawn(world, 'imu', 'imu', tags)
    biases = collected(plugin.outputs['bias'])
    plugin.report()
    reading, bias = found[-1], biases[-1]
    assert reading.angular_velocity == pytest.approx((0.0, 0.0, 1.0))
    assert reading.linear_acceleration[2] == pytest.approx(GRAVITY)
    # A bias of 0.05 g along x looks like a pitch of -0.05 rad.
    assert reading.orientation == pytest.approx(
        multiply(from_rpy(0.0, 0.0, 0.2), from_rpy(0.0, -0.05, 0.0)), abs=1e-4
    )
    assert reading.variances == pytest.approx((0.01, 0.01, 0.01, 0, 0, 0, 0.98**2, 0.98**2, 0))
    assert bias.linear_acceleration == (0.49, 0.0, 0.0)
    assert bias.angular_velocity == (0.0, 0.0, 1.0)
    assert bias.orientation == pytest.approx(reading.orientation)


def test_calibration_removes_the_drift_until_it_returns(world):
    plugin = spawn(world, 'imu', 'imu', '<rateDrift>.5</rateDrift>')[1]
    world.run(1000)
    assert plugin._rate.frequency == pytest.approx([1.0 / 3600.0] * 3)  # the default: an hour
    drift = plugin._rate.drift(1.0)
    plugin.calibrate()
    assert np.abs(drift).min() > 0.0
    assert plugin._rate.drift(1.0) == pytest.approx((0.0, 0.0, 0.0))
    world.reset_simulation()
    assert plugin._rate.drift(1.0) == pytest.approx(drift)


def test_readings_repeat_with_the_seed_at_any_start_of_reading():
    def reading(seed, begin):
        with World.empty() as world:
            world.seed = seed
            tags = '<accelDrift>.3</accelDrift><rateGaussianNoise>.1</rateGaussianNoise>'
            model = world.spawn(ROBOT.format(library='imu', tags=tags), 'r')
            world.run(begin)
            found = collected(model.plugin('p').outputs['imu'])
            world.run(20 - begin)
            return found[-1]

    assert reading(1, 0) == reading(1, 10)
    assert reading(1, 0) != reading(2, 0)


def test_tilt_is_unknown_without_gravity(world):
    plugin = spawn(world, 'imu', 'imu', '<accelOffset>1 1 1</accelOffset>')[1]
    world.physics = replace(world.physics, gravity=(0.0, 0.0, 0.0))
    plugin.outputs['imu'].latch()
    plugin.report()
    reading = plugin.outputs['imu'].newest
    assert reading.variances[:2] == (-1.0, -1.0)
    assert reading.orientation == pytest.approx((0.0, 0.0, 0.0, 1.0))


@pytest.mark.parametrize(
    ('library', 'tags', 'sentence'),
    [
        ('imu', '<accelDrift>1 2</accelDrift>', "<accelDrift> is '1 2'; it takes 3 finite numbers"),
        ('imu', '<yawDrift>nan</yawDrift>', "<yawDrift> is 'nan'; it takes a finite number"),
        ('imu', '<rateGaussianNoise>-1</rateGaussianNoise>', "is '-1'; it must not be negative"),
        ('imu', '<bodyName>nobody</bodyName>', 'bodyName: nobody does not exist'),
        (
            'gps',
            '<referenceLatitude>95</referenceLatitude>',
            '<referenceLatitude> is 95; it must lie between -89.999 and 89.999',
        ),
        ('gps', '<status>300</status>', '<status> is 300; it must lie between -1 and 2'),
        (
            'gps',
            '<updateRate>fast</updateRate>',
            "<updateRate> is 'fast'; it takes a finite number",
        ),
    ],
)
def test_invalid_plugin_is_left_out_with_an_error(world, library, tags, sentence, caplog):
    model = world.spawn(ROBOT.format(library=library, tags=tags), 'r')
    assert sentence in caplog.text
    with pytest.raises(NotFoundError):
        model.plugin('p')
    world.run(3)


def test_old_names_of_the_heading_errors_are_reported(world, caplog):
    spawn(world, 'imu', 'imu', '<headingDrift>1</headingDrift>')
    assert (
        'not read by this plugin: <headingDrift> (the tags of the heading begin with yaw'
        in caplog.text
    )
