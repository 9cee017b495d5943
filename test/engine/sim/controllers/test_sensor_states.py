"""Sensors of a robot, reported by controllers."""

import pytest
from support.controllers import POSITION, arm, refused, start_controller

IMU = (
    '<gazebo reference="link3"><sensor name="imu" type="imu"><update_rate>200</update_rate>'
    '</sensor></gazebo></robot>'
)
WRENCH = (
    '<gazebo><plugin name="wrist" filename="libgazebo_ros_ft_sensor.so">'
    '<jointName>joint2</jointName><topicName>wrist</topicName></plugin></gazebo></robot>'
)
IMUS = 'imu_sensor_controller/ImuSensorController'
WRENCHES = 'force_torque_sensor_controller/ForceTorqueSensorController'
WEIGHT = 0.6 * 9.8  # [N] of the last link


def started(world, kind, extra, parameters):
    """Return the arm, at rest and held upright, and its running controller."""
    bot = world.spawn(arm(POSITION, lambda text: text.replace('</robot>', extra)), name='arm')
    return bot, start_controller(bot, 'sensors', kind, parameters)


def test_an_imu_is_reported_at_the_rate(world):
    _, controller = started(world, IMUS, IMU, {'publish_rate': 50})
    readings = []
    controller.outputs['imu'].connect(readings.append)
    world.run(1000)
    assert 47 <= len(readings) <= 50
    assert readings[-1].linear_acceleration[2] == pytest.approx(9.8, abs=0.05)
    assert controller.frames == {'imu': 'link3'}
    assert controller.topic_names == {'imu': 'imu'}
    assert controller.namespace == '/arm'


def test_a_wrench_is_reported_at_the_rate(world):
    _, controller = started(world, WRENCHES, WRENCH, {'publish_rate': 20})
    readings = []
    controller.outputs['wrist'].connect(readings.append)
    world.run(1000)
    assert 17 <= len(readings) <= 20
    assert readings[-1].force[2] == pytest.approx(-WEIGHT, rel=0.05)


def test_sensors_are_read_only_while_a_running_controller_has_readers(world):
    bot, controller = started(world, IMUS, IMU, {'publish_rate': 50})
    sensor = bot.sensor('imu')
    assert sensor.readings.readers == 0
    controller.outputs['imu'].connect(print)
    assert sensor.readings.readers == 1
    bot.plugin('gazebo_ros_control').manager.switch([], ['sensors'])
    assert sensor.readings.readers == 0


def test_a_restored_controller_goes_on(world):
    _, controller = started(world, IMUS, IMU, {'publish_rate': 50})
    readings = []
    controller.outputs['imu'].connect(readings.append)
    world.run(100)
    saved = world.save_state()
    readings.clear()
    world.run(100)
    first = readings.copy()
    readings.clear()
    world.restore(saved)
    world.run(100)
    assert first
    assert readings == first


def test_a_robot_without_sensors_gets_upstreams_answer(world):
    assert refused(started, world, IMUS, '</robot>', {'publish_rate': 50}) == (
        'This controller requires a hardware interface of type '
        "'hardware_interface::ImuSensorInterface'. Make sure this is registered in the "
        'hardware_interface::RobotHW class.',
        "Initializing controller 'sensors' failed",
    )


def test_a_rate_is_needed(world):
    assert refused(started, world, IMUS, IMU, {})[0] == "Parameter 'publish_rate' not set"
