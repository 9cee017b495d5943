"""Plugins of velodyne_simulator and hector_gazebo have upstream's topics, services and frames."""

from contextlib import closing
from io import BytesIO
from types import SimpleNamespace

import pytest
import rospy
from std_srvs.srv import EmptyRequest
from support.wire import Wire

from rosbots_description.ros_api.adapters import adapter
from rosbots_description.sim.public.world import World

ROBOT = """<robot name="r"><link name="base"><inertial><mass value="1"/><inertia ixx="1" ixy="0"
ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>{}</robot>"""
LASER = """<gazebo reference="base"><sensor name="velodyne" type="ray"><update_rate>10</update_rate>
<ray><scan><horizontal><samples>9</samples><min_angle>-1</min_angle><max_angle>1</max_angle>
</horizontal><vertical><samples>4</samples><min_angle>-1.5</min_angle><max_angle>-1</max_angle>
</vertical></scan><range><min>0.1</min><max>9</max></range></ray>
<plugin name="p" filename="libgazebo_ros_velodyne_laser.so">{}</plugin></sensor></gazebo>"""
HECTOR = '<gazebo><plugin name="p" filename="libhector_gazebo_ros_{}.so">{}</plugin></gazebo>'
CLOUD, IMU, FIX = 'sensor_msgs/PointCloud2', 'sensor_msgs/Imu', 'sensor_msgs/NavSatFix'
VECTOR = 'geometry_msgs/Vector3Stamped'
NAMESPACE = '<robotNamespace>/car</robotNamespace>'


@pytest.fixture
def wire(monkeypatch):
    made, made.services = Wire(monkeypatch), {}

    def offer(name, _type, answer):
        made.services[name] = answer
        return SimpleNamespace(shutdown=lambda: None)

    monkeypatch.setattr(rospy, 'Service', offer)
    monkeypatch.setattr(adapter, 'find_tf_prefix', lambda _: 'pre')
    return made


@pytest.mark.parametrize(
    ('text', 'expected', 'services'),
    [
        (LASER.format(''), {'/points': (CLOUD, 'world', 2)}, set()),
        (LASER.format('<frameName>top</frameName>'), {'/points': (CLOUD, 'pre/top', 2)}, set()),
        (
            LASER.format(f'{NAMESPACE}<frameName>top</frameName><topicName>cloud</topicName>'),
            {'/car/cloud': (CLOUD, 'car/top', 2)},
            set(),
        ),
        (
            HECTOR.format('imu', ''),
            {'/imu': (IMU, 'base', 250), '/imu/bias': (IMU, 'base', 250)},
            {'/imu/calibrate'},
        ),
        (
            HECTOR.format(
                'imu',
                f'{NAMESPACE}<topicName>imu/data</topicName><frameId>i</frameId>'
                '<serviceName>zero</serviceName><updateRate>50</updateRate>',
            ),
            {'/car/imu/data': (IMU, 'i', 12), '/car/imu/data/bias': (IMU, 'i', 12)},
            {'/car/zero'},
        ),
        (
            HECTOR.format('gps', ''),
            {'/fix': (FIX, 'world', 1), '/fix_velocity': (VECTOR, 'world', 1)},
            set(),
        ),
        (
            HECTOR.format(
                'gps',
                f'{NAMESPACE}<frameId>mast</frameId><topicName>/gps</topicName>'
                '<velocityTopicName>v</velocityTopicName><updateRate>10</updateRate>',
            ),
            {'/gps': (FIX, 'mast', 2), '/car/v': (VECTOR, 'mast', 2)},
            set(),
        ),
    ],
)
def test_topics_frames_and_rates_are_those_of_upstream(wire, text, expected, services):
    with closing(World.empty()) as world:
        (plugin,) = world.spawn(ROBOT.format(text), 'r', z=1.0).plugins.values()
        joined = wire.join(plugin)
        joined.server.loop.call = lambda command: command()
        for topic in wire.publishers.values():
            topic.read()
        world.run(250)
        found = {
            name: (topic.message_class._type, topic.sent[-1].header.frame_id, len(topic.sent))
            for name, topic in wire.publishers.items()
        }
        for topic in wire.publishers.values():
            topic.sent[-1].serialize(BytesIO())
            assert topic.sent[-1].header.stamp.to_nsec() > 0
        for answer in wire.services.values():
            answer(EmptyRequest())
    assert set(wire.services) == services
    assert found == expected
