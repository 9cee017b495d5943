"""Point clouds of Velodyne lasers are as upstream's, with exact rays."""

import logging
import math

import numpy as np
import pytest
from sensor_msgs.point_cloud2 import read_points
from support.sensing import box_sdf

from rosbots_description.ros_api.adapters.ray_sensors import ring_cloud_message
from rosbots_description.sim.public.world import World

ROBOT = """<sdf version="1.6"><model name="car"><static>1</static><link name="l">
<sensor name="velodyne" type="{kind}"><update_rate>10</update_rate><ray><scan>
<horizontal><samples>8</samples><resolution>1</resolution><min_angle>-1.5</min_angle>
<max_angle>1.5</max_angle></horizontal>
<vertical><samples>3</samples><resolution>1</resolution><min_angle>-0.2</min_angle>
<max_angle>0.2</max_angle></vertical></scan><range><min>0.3</min><max>20</max></range></ray>
<plugin name="plugin" filename="libgazebo_ros_velodyne_{library}.so">{tags}</plugin>
</sensor></link></model></sdf>"""
WALL = box_sdf('.2 4 9', 'wall', more='<laser_retro>7</laser_retro>')
YAWS, PITCHES = np.linspace(-1.5, 1.5, 8), np.linspace(-0.2, 0.2, 3)


@pytest.fixture
def world():
    with World() as made:
        made.spawn(WALL, x=2.1)  # a plane at x = 2
        yield made


def cloud_of(world, tags='', library='laser', kind='ray'):
    robot = world.spawn(ROBOT.format(tags=tags, library=library, kind=kind), 'car')
    plugin = robot.plugin('plugin')
    plugin.cloud.latch()
    plugin.process(plugin.sensor.read())
    return plugin.cloud.newest


@pytest.mark.parametrize(('library', 'kind'), [('laser', 'ray'), ('gpu_laser', 'gpu_ray')])
def test_points_are_on_the_surface_ordered_by_azimuth_and_ring(world, library, kind):
    points, is_dense = cloud_of(world, library=library, kind=kind)
    met = [(yaw, pitch) for yaw in YAWS if abs(2 * math.tan(yaw)) < 2 for pitch in PITCHES]
    expected = [
        (2.0, 2.0 * math.tan(yaw), 2.0 * math.tan(pitch) / math.cos(yaw)) for yaw, pitch in met
    ]
    found = points[0]
    assert np.column_stack([found[axis] for axis in 'xyz']) == pytest.approx(
        np.array(expected), abs=1e-5
    )
    assert found['ring'].tolist() == [0, 1, 2] * (len(met) // 3)
    assert set(found['intensity']) == {7.0}
    assert is_dense


def test_organised_cloud_has_a_column_for_each_ring_and_nan_without_a_hit(world):
    points, is_dense = cloud_of(world, '<organize_cloud>true</organize_cloud>')
    assert points.shape == (8, 3)
    assert not is_dense
    assert np.isnan(points['x']).all(axis=1).tolist() == [
        bool(abs(2 * math.tan(yaw)) >= 2) for yaw in YAWS
    ]
    assert (points['ring'] == (0, 1, 2)).all()


@pytest.mark.parametrize(
    ('tags', 'least', 'most'),
    [
        ('<min_range>2.2</min_range>', 2.2, 20.0),
        ('<max_range>2.2</max_range>', 0.3, 2.2),
        ('<max_range>99</max_range><min_range>0</min_range>', 0.3, 20.0),
    ],
)
def test_points_are_within_the_tighter_limits(world, tags, least, most):
    points = cloud_of(world, tags)[0][0]
    ranges = [
        2.0 / math.cos(yaw) / math.cos(pitch)
        for yaw in YAWS
        if abs(math.tan(yaw)) < 1
        for pitch in PITCHES
    ]
    found = np.sqrt(points['x'] ** 2 + points['y'] ** 2 + points['z'] ** 2)
    assert found == pytest.approx([one for one in ranges if least < one < most], abs=1e-5)


def test_surfaces_of_low_intensity_are_left_out_and_noise_has_its_deviation(world):
    assert cloud_of(world, '<min_intensity>7.5</min_intensity>')[0].size == 0
    world.delete('car')
    clean = cloud_of(world)[0][0]['x']
    world.delete('car')
    noisy = [cloud_of(world, '<gaussianNoise>0.01</gaussianNoise>')[0][0]['x']]
    plugin = world.models['car'].plugin('plugin')
    for _ in range(60):
        world.run(1)
        plugin.process(plugin.sensor.read())
        noisy.append(plugin.cloud.newest.points[0]['x'])
    along = np.array(noisy) - clean
    assert along.std() == pytest.approx(0.0085, rel=0.1)  # 0.01 times a mean cosine of 0.85
    assert plugin.cloud.newest.points[0]['x'].tolist() != noisy[0].tolist()


def test_the_message_has_upstreams_fields(world):
    message = ring_cloud_message(cloud_of(world))
    assert [(field.name, field.offset, field.datatype) for field in message.fields] == [
        ('x', 0, 7),
        ('y', 4, 7),
        ('z', 8, 7),
        ('intensity', 12, 7),
        ('ring', 16, 4),
        ('time', 18, 7),
    ]
    assert (message.point_step, message.height, message.row_step) == (22, 1, 22 * message.width)
    x, _, _, intensity, ring, time = next(iter(read_points(message)))
    assert (x, intensity, ring, time) == (pytest.approx(2.0), 7.0, 0, 0.0)


def test_the_namespace_is_the_prefix_of_the_frame(world):
    frame = '<frameName>top</frameName>'
    cloud_of(world, f'{frame}<robotNamespace>/car1</robotNamespace>')
    assert world.models['car'].plugin('plugin').params.values['frameName'] == '/car1/top'
    world.delete('car')
    cloud_of(world, f'{frame}<robotNamespace>/</robotNamespace>')
    assert world.models['car'].plugin('plugin').params.values['frameName'] == 'top'


def test_empty_range_of_limits_is_reported(world, caplog):
    with caplog.at_level(logging.WARNING):
        points, _ = cloud_of(world, '<min_range>5</min_range><max_range>3</max_range>')
    assert points.size == 0
    assert 'finds no points: <min_range> leaves those beyond 5 m' in caplog.text


@pytest.mark.parametrize(
    'tags',
    [
        '<gaussianNoise>nan</gaussianNoise>',
        '<min_range>x</min_range>',
        '<gaussianNoise>-1</gaussianNoise>',
    ],
)
def test_plugin_with_an_invalid_number_is_left_out_with_an_error(world, tags, caplog):
    robot = world.spawn(ROBOT.format(tags=tags, library='laser', kind='ray'), 'car')
    assert robot.plugins == {}
    assert 'gaussianNoise' in caplog.text or 'min_range' in caplog.text
