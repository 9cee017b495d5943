"""The plugins of the recorded robots have the topics and services that they had in Gazebo."""

import logging
from contextlib import closing
from types import SimpleNamespace
from typing import NamedTuple

import pytest
import rospy
from dynamic_reconfigure.server import Server as ReconfigureServer
from support.sensing import RECORDED, ROBOTS
from support.wire import Wire

from rosbots_description.ros_api.adapters import adapter
from rosbots_description.sim.formats.urdf.urdf import load_urdf
from rosbots_description.sim.public.world import World

SCAN, IMU, BUMPER = 'sensor_msgs/LaserScan', 'sensor_msgs/Imu', 'gazebo_msgs/ContactsState'
RANGE, ODOMETRY, JOINTS = 'sensor_msgs/Range', 'nav_msgs/Odometry', 'sensor_msgs/JointState'
IMAGE, INFO, CLOUD = 'sensor_msgs/Image', 'sensor_msgs/CameraInfo', 'sensor_msgs/PointCloud2'
WRENCH, TF = 'geometry_msgs/WrenchStamped', 'tf2_msgs/TFMessage'
RELATIVE = ('>/scan<', '>scan<')
OWN = '<robotNamespace>robo</robotNamespace>'
OWN_IMU = ('<topicName>', f'{OWN}<topicName>')
BASE_FRAME, LASER_FRAME = (f'<frameName>{one}_link</frameName>' for one in ('base', 'laser'))
RATE = '<updateRate>100.0</updateRate>'
# Where Gazebo was recorded image_transport's plugin of compressed pictures was not installed.
COMPRESSED = 'sensor_msgs/CompressedImage'
CAMERA = {'image_raw': IMAGE, 'image_raw/compressed': COMPRESSED, 'camera_info': INFO}
DEPTH = {
    'rgb/image_raw': IMAGE,
    'rgb/image_raw/compressed': COMPRESSED,
    'rgb/camera_info': INFO,
    'depth/image_raw': IMAGE,
    'depth/camera_info': INFO,
    'depth/points': CLOUD,
}
SETTINGS = {'set_camera_info', 'set_parameters'}
TRUTH = dict.fromkeys(
    ('/gt', *(f'/gt_{end}' for end in ('badframe', 'default', 'lumped', 'noise', 'off', 'wheel'))),
    ODOMETRY,
)


def within(folder, names):
    """Return names, or the keys of a table of names, below a folder."""
    if isinstance(names, dict):
        return {f'{folder}/{name}': value for name, value in names.items()}
    return {f'{folder}/{name}' for name in names}


@pytest.fixture
def wire(monkeypatch):
    """Return topics without a master, with the names of services in `services`."""
    made, made.services = Wire(monkeypatch), set()

    def offer(name, *_):
        if name in made.services:
            raise rospy.ServiceException(f'{name} is there already')
        made.services.add(name)
        return SimpleNamespace(shutdown=lambda: made.services.remove(name))

    def reconfigure(server, _type, _callback, name):
        server.descr_topic = server.update_topic = SimpleNamespace(unregister=lambda: None)
        server.set_service = offer(f'{name}/set_parameters')

    monkeypatch.setattr(rospy, 'Service', offer)
    monkeypatch.setattr(ReconfigureServer, '__init__', reconfigure)
    return made


@pytest.fixture
def world():
    with closing(World.empty()) as made:
        yield made


def spawn(world, wire, robot, namespace='/', old='', new='', name='bot'):
    """Spawn a recorded robot, and return its open adapters; `old` is replaced by `new`."""
    file = ROBOTS / f'{robot}.urdf'
    text = (file if file.exists() else RECORDED / 'robots' / file.name).read_text(encoding='utf-8')
    if old:
        assert old in text
        text = text.replace(old, new)
    model = world.spawn(load_urdf(text, name, robot_namespace=namespace)[0], name)
    return [wire.join(plugin) for plugin in model.plugins.values()]


class Case(NamedTuple):
    """A robot, and what it offers; `edit` replaces a text of its description."""

    robot: str
    topics: dict[str, str]
    services: frozenset[str] = frozenset()
    namespace: str = '/'
    edit: tuple[str, str] = ('', '')


@pytest.mark.parametrize(
    'case',
    [
        Case('laser_nonoise', {'/scan': SCAN}),
        Case('laser_nonoise', {'/scan': SCAN}, namespace='', edit=RELATIVE),
        Case('laser_nonoise', {'/scan': SCAN}, edit=RELATIVE),
        Case('laser_nonoise', {'/nsx/scan': SCAN}, namespace='nsx', edit=RELATIVE),
        Case('laser_nonoise', {'/nsy/scan': SCAN}, namespace='/nsy/', edit=RELATIVE),
        Case('laser_nonoise', {'/robo/scan': SCAN}, edit=('<topicName>/', f'{OWN}<topicName>')),
        Case('laser_nonoise', {'/world': SCAN}, edit=('<topicName>/scan</topicName>', '')),
        Case('laser_block', {'/cloud': 'sensor_msgs/PointCloud'}),
        Case('range', {'/sonar': RANGE}),
        Case('range_noise_ir', {'/robo/sonar': RANGE}),
        Case('imu_sensor', {'/bot/imu/data': IMU}, namespace=''),
        Case('imu_sensor', {'/imu/data': IMU}),
        Case('imu_sensor', {'/nsx/imu/data': IMU}, namespace='/nsx'),
        Case('imu_sensor', {'/robo/imu/data': IMU}, namespace='', edit=OWN_IMU),
        Case('imu_sensor', {'/robo/imu/data': IMU}, namespace='/other', edit=OWN_IMU),
        Case('imu_sensor', {'/imu': IMU}, namespace='', edit=('>imu/data<', '>/imu<')),
        Case(
            'imu_sensor',
            {'/bot/imu_data': IMU},
            namespace='',
            edit=('<topicName>imu/data</topicName>', ''),
        ),
        Case('imu_sensor', {}, namespace='', edit=('<frameName>imu_link</frameName>', '')),
        Case('imu_model', {'/imu': IMU}, {'/imu_service'}, ''),
        Case('imu_model', {'/nsx/imu': IMU}, {'/nsx/imu_service'}, '/nsx'),
        Case(
            'imu_model',
            {'/default_imu': IMU},
            {'/default_imu'},
            '/nsx',
            ('<topicName>imu</topicName><serviceName>imu_service</serviceName>', ''),
        ),
        Case('bumper', {'/bumper': BUMPER}),
        Case('bumper', {'/nsx/bumper': BUMPER}, namespace='/nsx'),
        Case('bumper', {'/robo/bumper': BUMPER}, edit=('<bumperTopic', f'{OWN}<bumperTopic')),
        Case('bumper_defaults', {'/bumper_states': BUMPER}),
        Case('camera_320', within('/camera1', CAMERA), within('/camera1', SETTINGS)),
        Case(
            'camera_320', within('/nsx/camera1', CAMERA), within('/nsx/camera1', SETTINGS), '/nsx'
        ),
        Case(
            'multicamera',
            within('/multisense/left', CAMERA) | within('/multisense/right', CAMERA),
            within('/multisense/left', SETTINGS) | within('/multisense/right', SETTINGS),
        ),
        Case('openni_kinect', within('/camera', DEPTH), within('/camera', SETTINGS)),
        Case(
            'openni_kinect', within('/nsx/camera', DEPTH), within('/nsx/camera', SETTINGS), '/nsx'
        ),
        Case('depth_camera', within('/camera', DEPTH), within('/camera', SETTINGS)),
        Case('arm_ft', {'/ft_elbow': WRENCH, '/ft_shoulder': WRENCH, '/joint_states': JOINTS}),
        Case('skid4_p3d', {'/joint_states': JOINTS, '/odom': ODOMETRY, '/tf': TF, **TRUTH}),
        Case('planar', {'/odom': ODOMETRY, '/tf': TF}),
        Case('tricycle', {'/joint_states': JOINTS, '/odom': ODOMETRY, '/tf': TF}),
        Case('hog', {'/tf': TF}),
        Case('force', {}),
    ],
)
def test_names_and_types_agree_with_the_recording(world, wire, case):
    spawn(world, wire, case.robot, case.namespace, *case.edit)
    types = {name: topic.message_class._type for name, topic in wire.publishers.items()}
    assert (types, wire.services) == (case.topics, case.services)


@pytest.mark.parametrize(
    ('robot', 'topics'),
    [
        ('force', {'/force'}),
        ('planar', {'/cmd_vel'}),
        ('skid4_p3d', {'/cmd_vel'}),
        ('tricycle', {'/cmd_vel'}),
        ('arm_ft', {'/set_joint_trajectory'}),
        ('hog', {'/tf', '/tf_static'}),
    ],
)
def test_commands_have_the_recorded_names(world, wire, robot, topics):
    spawn(world, wire, robot)
    assert set(wire.subscribers) == topics


def test_empty_namespace_of_a_tricycle_is_the_name_of_the_model(world, wire):
    tag = 'tricycle_drive.so">'
    spawn(world, wire, 'tricycle', '/', tag, f'{tag}<robotNamespace></robotNamespace>')
    assert set(wire.subscribers) == {'/bot/cmd_vel'}


@pytest.mark.parametrize(
    ('robot', 'latched'),
    [
        ('camera_320', {'/camera1/image_raw', '/camera1/image_raw/compressed'}),
        ('openni_kinect', {'/camera/rgb/image_raw', '/camera/rgb/image_raw/compressed'}),
        ('laser_nonoise', set()),
        ('imu_sensor', set()),
        ('bumper', set()),
        ('range', set()),
    ],
)
def test_only_images_are_latched(world, wire, robot, latched):
    spawn(world, wire, robot)
    assert {name for name, topic in wire.publishers.items() if topic.options['latch']} == latched


@pytest.mark.parametrize(
    ('robot', 'removed', 'frame'),
    [
        ('laser_nonoise', '', 'pre/laser_link'),
        ('imu_sensor', '', 'imu_link'),
        ('laser_nonoise', LASER_FRAME, 'world'),
        ('imu_model', '', 'base_footprint'),
        ('bumper', '', 'pre/base_link'),
        ('bumper_defaults', '', 'pre/world'),
        ('range', '', 'pre/laser_link'),
    ],
)
def test_tf_prefix_applies_to_all_frames_except_those_of_imus(
    world, wire, monkeypatch, robot, removed, frame
):
    monkeypatch.setattr(adapter, 'find_tf_prefix', lambda _: 'pre')
    spawn(world, wire, robot, '/', removed)
    (topic,) = wire.publishers.values()
    topic.read()
    world.run(100)
    assert topic.sent[-1].header.frame_id == frame


@pytest.mark.parametrize(
    ('robot', 'topic'),
    [
        ('camera_320', '/camera1/image_raw'),
        ('openni_kinect', '/camera/depth/points'),
        ('multicamera', '/multisense/right/image_raw'),
        ('imu_model', '/imu'),
    ],
)
def test_two_robots_of_the_same_names_share_topics_and_the_first_has_the_services(
    world, wire, caplog, robot, topic
):
    spawn(world, wire, robot)
    services = wire.services.copy()
    (second,) = spawn(world, wire, robot, name='other')
    assert wire.services == services
    assert "model 'other', plugin" in caplog.text
    assert 'are those of another plugin; names of its own, or a robot_namespace' in caplog.text
    wire.publishers[topic].read()
    second.refresh()
    world.run(100)
    sent = len(wire.publishers[topic].sent)
    assert sent == 2 * len({message.header.stamp for message in wire.publishers[topic].sent}) > 0


@pytest.mark.parametrize(
    ('robot', 'removed', 'message'),
    [
        ('bumper', BASE_FRAME, 'bumper plugin missing <frameName>, defaults to world'),
        ('range', LASER_FRAME, 'Range plugin missing <frameName>, defaults to /world'),
        ('laser_block', LASER_FRAME, 'Block laser plugin missing <frameName>, defaults to /world'),
        ('arm_ft', RATE, 'ft_sensor plugin missing <updateRate>, defaults to 0.0'),
    ],
)
def test_defaults_are_logged_as_information_not_as_warnings(
    world, wire, caplog, robot, removed, message
):
    caplog.set_level(logging.INFO, 'rosbots_description')
    spawn(world, wire, robot, '/', removed)
    levels = {record.getMessage(): record.levelname for record in caplog.records}
    assert levels[message] == 'INFO'
    assert 'WARNING' not in levels.values()
