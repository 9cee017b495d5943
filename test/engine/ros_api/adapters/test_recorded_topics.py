"""The plugins of the recorded robots have the topics and services that they had in Gazebo."""

import logging
from contextlib import closing
from types import SimpleNamespace

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


@pytest.mark.parametrize(
    ('robot', 'edit', 'namespace', 'topics', 'services'),
    [
        ('laser_nonoise', None, '/', {'/scan': SCAN}, set()),
        ('laser_nonoise', RELATIVE, '', {'/scan': SCAN}, set()),
        ('laser_nonoise', RELATIVE, '/', {'/scan': SCAN}, set()),
        ('laser_nonoise', RELATIVE, 'nsx', {'/nsx/scan': SCAN}, set()),
        ('laser_nonoise', RELATIVE, '/nsy/', {'/nsy/scan': SCAN}, set()),
        (
            'laser_nonoise',
            ('<topicName>/', f'{OWN}<topicName>'),
            '/other',
            {'/robo/scan': SCAN},
            set(),
        ),
        ('laser_nonoise', ('<topicName>/scan</topicName>', ''), '/', {'/world': SCAN}, set()),
        ('laser_block', None, '/', {'/cloud': 'sensor_msgs/PointCloud'}, set()),
        ('range', None, '/', {'/sonar': RANGE}, set()),
        ('range_noise_ir', None, '/', {'/robo/sonar': RANGE}, set()),
        ('imu_sensor', None, '', {'/bot/imu/data': IMU}, set()),
        ('imu_sensor', None, '/', {'/imu/data': IMU}, set()),
        ('imu_sensor', None, '/nsx', {'/nsx/imu/data': IMU}, set()),
        ('imu_sensor', ('<topicName>', f'{OWN}<topicName>'), '', {'/robo/imu/data': IMU}, set()),
        (
            'imu_sensor',
            ('<topicName>', f'{OWN}<topicName>'),
            '/other',
            {'/robo/imu/data': IMU},
            set(),
        ),
        ('imu_sensor', ('>imu/data<', '>/imu<'), '', {'/imu': IMU}, set()),
        ('imu_sensor', ('<topicName>imu/data</topicName>', ''), '', {'/bot/imu_data': IMU}, set()),
        ('imu_sensor', ('<frameName>imu_link</frameName>', ''), '', {}, set()),
        ('imu_model', None, '', {'/imu': IMU}, {'/imu_service'}),
        ('imu_model', None, '/nsx', {'/nsx/imu': IMU}, {'/nsx/imu_service'}),
        (
            'imu_model',
            ('<topicName>imu</topicName><serviceName>imu_service</serviceName>', ''),
            '/nsx',
            {'/default_imu': IMU},
            {'/default_imu'},
        ),
        ('bumper', None, '/', {'/bumper': BUMPER}, set()),
        ('bumper', None, '/nsx', {'/nsx/bumper': BUMPER}, set()),
        (
            'bumper',
            ('<bumperTopicName>', f'{OWN}<bumperTopicName>'),
            '/',
            {'/robo/bumper': BUMPER},
            set(),
        ),
        ('bumper_defaults', None, '/', {'/bumper_states': BUMPER}, set()),
        ('camera_320', None, '/', within('/camera1', CAMERA), within('/camera1', SETTINGS)),
        (
            'camera_320',
            None,
            '/nsx',
            within('/nsx/camera1', CAMERA),
            within('/nsx/camera1', SETTINGS),
        ),
        (
            'multicamera',
            None,
            '/',
            {**within('/multisense/left', CAMERA), **within('/multisense/right', CAMERA)},
            within('/multisense/left', SETTINGS) | within('/multisense/right', SETTINGS),
        ),
        ('openni_kinect', None, '/', within('/camera', DEPTH), within('/camera', SETTINGS)),
        (
            'openni_kinect',
            None,
            '/nsx',
            within('/nsx/camera', DEPTH),
            within('/nsx/camera', SETTINGS),
        ),
        ('depth_camera', None, '/', within('/camera', DEPTH), within('/camera', SETTINGS)),
        (
            'arm_ft',
            None,
            '/',
            {'/ft_elbow': WRENCH, '/ft_shoulder': WRENCH, '/joint_states': JOINTS},
            set(),
        ),
        (
            'skid4_p3d',
            None,
            '/',
            {
                **{
                    f'/gt{end}': ODOMETRY
                    for end in ('', '_badframe', '_default', '_lumped', '_noise', '_off', '_wheel')
                },
                '/joint_states': JOINTS,
                '/odom': ODOMETRY,
                '/tf': TF,
            },
            set(),
        ),
        ('planar', None, '/', {'/odom': ODOMETRY, '/tf': TF}, set()),
        ('tricycle', None, '/', {'/joint_states': JOINTS, '/odom': ODOMETRY, '/tf': TF}, set()),
        ('hog', None, '/', {'/tf': TF}, set()),
        ('force', None, '/', {}, set()),
    ],
)
def test_names_and_types_agree_with_the_recording(
    world, wire, robot, edit, namespace, topics, services
):
    spawn(world, wire, robot, namespace, *(edit or ()))
    assert {name: topic.message_class._type for name, topic in wire.publishers.items()} == topics
    assert wire.services == services


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
    spawn(
        world,
        wire,
        'tricycle',
        '/',
        'tricycle_drive.so">',
        'tricycle_drive.so"><robotNamespace></robotNamespace>',
    )
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
        ('laser_nonoise', '<frameName>laser_link</frameName>', 'world'),
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
        (
            'bumper',
            '<frameName>base_link</frameName>',
            'bumper plugin missing <frameName>, defaults to world',
        ),
        (
            'range',
            '<frameName>laser_link</frameName>',
            'Range plugin missing <frameName>, defaults to /world',
        ),
        (
            'laser_block',
            '<frameName>laser_link</frameName>',
            'Block laser plugin missing <frameName>, defaults to /world',
        ),
        (
            'arm_ft',
            '<updateRate>100.0</updateRate>',
            'ft_sensor plugin missing <updateRate>, defaults to 0.0',
        ),
    ],
)
def test_defaults_are_logged_as_information_not_as_warnings(
    world, wire, caplog, robot, removed, message
):
    caplog.set_level(logging.INFO, 'rosbots_description.sim.plugins.parameters')
    spawn(world, wire, robot, '/', removed)
    levels = {record.getMessage(): record.levelname for record in caplog.records}
    assert levels[message] == 'INFO'
    assert 'WARNING' not in levels.values()
