"""What a window shows of a sensor's message."""

import io
import math
import struct

import numpy as np
import pytest
from gazebo_msgs.msg import ContactsState, ContactState
from geometry_msgs.msg import Point32, Vector3, WrenchStamped
from PIL import Image as Encoder
from sensor_msgs.msg import (
    CompressedImage,
    Image,
    Imu,
    LaserScan,
    PointCloud,
    PointCloud2,
    PointField,
    Range,
)

from rosbots_description.ros_api.messages import clouds, shown_reading
from rosbots_description.sim.core import SimError
from rosbots_description.sim.sensors.shown_readings import GREATEST, MAX_RAYS


def image(encoding, values, **changes):
    """Return a picture of an array (height, width) or (height, width, channels)."""
    values = np.asarray(values)
    message = Image(
        height=values.shape[0],
        width=values.shape[1],
        encoding=encoding,
        step=values.nbytes // values.shape[0],
        data=values.tobytes(),
    )
    for name, value in changes.items():
        setattr(message, name, value)
    return message


def cloud(points, **changes):
    """Return a cloud of points (height, width, 3) without colours."""
    points = np.asarray(points, np.float32)
    height, width, _ = points.shape
    message = PointCloud2(
        height=height, width=width, point_step=12, row_step=12 * width, data=points.tobytes()
    )
    message.header.frame_id = 'eye'
    message.fields = [
        PointField(name, 4 * i, PointField.FLOAT32, 1) for i, name in enumerate('xyz')
    ]
    for name, value in changes.items():
        setattr(message, name, value)
    return message


@pytest.mark.parametrize(
    ('encoding', 'pixel', 'shown'),
    [
        ('rgb8', [1, 2, 3], [1, 2, 3]),
        ('bgr8', [1, 2, 3], [3, 2, 1]),
        ('rgba8', [1, 2, 3, 9], [1, 2, 3]),
        ('bgra8', [1, 2, 3, 9], [3, 2, 1]),
        ('mono8', [7], [7, 7, 7]),
    ],
)
def test_pictures_have_their_colours(encoding, pixel, shown):
    values = np.zeros((2, 3, len(pixel)), np.uint8)
    values[1, 2] = pixel
    picture = shown_reading(image(encoding, values)).picture
    assert picture.shape == (2, 3, 3)
    assert picture[1, 2].tolist() == shown
    assert picture[0].max() == 0


@pytest.mark.parametrize(
    ('encoding', 'kind', 'big'),
    [('32FC1', '<f4', 0), ('32FC1', '>f4', 1), ('16UC1', '<u2', 0), ('mono16', '>u2', 1)],
)
def test_distances_are_shown_from_black_to_white(encoding, kind, big):
    values = np.array([[0.0, 2.0], [4.0, 1.0]]).astype(kind)
    picture = shown_reading(image(encoding, values, is_bigendian=big)).picture
    assert picture[:, :, 0].tolist() == [[0, 127], [255, 63]]


def test_distances_that_are_none_are_black():
    picture = shown_reading(image('32FC1', np.float32([[math.nan, math.inf, 1.0]]))).picture
    assert picture[0, :, 0].tolist() == [0, 0, 255]


def test_rows_may_be_longer_than_their_pixels():
    values = np.arange(16, dtype=np.uint8).reshape(2, 8)
    picture = shown_reading(image('mono8', values, width=3)).picture
    assert picture[:, :, 0].tolist() == [[0, 1, 2], [8, 9, 10]]


def test_a_large_picture_is_made_smaller():
    values = np.arange(2 * 1300, dtype=np.uint16).reshape(2, 1300).astype(np.uint8)
    picture = shown_reading(image('mono8', values)).picture
    assert picture.shape == (1, 434, 3)
    assert picture[0, 2, 0] == 6
    assert max(picture.shape) <= GREATEST


def test_a_compressed_picture_is_decoded():
    values, file = np.full((4, 5, 3), (200, 100, 0), np.uint8), io.BytesIO()
    Encoder.fromarray(values).save(file, 'PNG')
    message = CompressedImage(format='png', data=file.getvalue())
    assert np.array_equal(shown_reading(message).picture, values)


@pytest.mark.parametrize(
    ('message', 'sentence'),
    [
        (image('yuv422', np.zeros((2, 2), np.uint8)), "encoding 'yuv422' is not shown; those that"),
        (image('rgb8', np.zeros((2, 2), np.uint8)), '4 bytes are no picture of 2 x 2 pixels of 3'),
        (image('mono8', np.zeros((2, 2), np.uint8), height=9), '4 bytes are no picture of 2 x 9'),
        (image('mono8', np.zeros((2, 2), np.uint8), width=0), '4 bytes are no picture of 0 x 2'),
        (CompressedImage(format='h264', data=b'x'), "format 'h264' cannot be decoded"),
        (PointCloud2(), 'no fields x, y and z'),
        (cloud([[[1, 2, 3]]], width=5), '12 bytes are no 5 x 1 points of 12 bytes'),
        (cloud([[[1, 2, 3]]], height=5), '12 bytes are no 1 x 5 points of 12 bytes'),
        (cloud([[[1, 2, 3]]], point_step=4), 'its fields are no points of 4 bytes'),
    ],
)
def test_what_cannot_be_shown_is_told(message, sentence):
    with pytest.raises(SimError, match=sentence):
        shown_reading(message)


def test_rays_end_where_they_meet_something():
    scan = LaserScan(
        angle_min=0.0,
        angle_increment=math.pi / 2,
        range_min=0.1,
        range_max=5.0,
        ranges=[1.0, 2.0, math.inf, math.nan, 0.05],
    )
    scan.header.frame_id = 'laser'
    reading = shown_reading(scan)
    assert reading.frame == 'laser'
    np.testing.assert_allclose(reading.points, [[1, 0, 0], [0, 2, 0]], atol=1e-6)
    np.testing.assert_array_equal(reading.lines[:, 1], reading.points)
    assert not reading.lines[:, 0].any()
    assert reading.words == '2 of 5 rays meet something, the nearest at 1.000 m'


def test_a_scan_that_meets_nothing_has_no_rays():
    reading = shown_reading(LaserScan(range_max=1.0, ranges=[math.inf] * 3))
    assert (reading.points.shape, reading.lines.shape) == ((0, 3), (0, 2, 3))
    assert reading.words == '0 of 3 rays meet something'


def test_rays_are_limited():
    scan = LaserScan(angle_increment=0.001, range_max=5.0, ranges=[1.0] * 2500)
    reading = shown_reading(scan)
    assert (len(reading.points), len(reading.lines)) == (2500, 834)
    assert len(reading.lines) <= MAX_RAYS


@pytest.mark.parametrize(('distance', 'rays'), [(0.5, 1), (math.inf, 0)])
def test_a_range_is_a_ray_ahead(distance, rays):
    reading = shown_reading(Range(range=distance))
    assert reading.lines.tolist() == [[[0, 0, 0], [distance, 0, 0]]] * rays


def test_clouds_are_their_finite_points():
    reading = shown_reading(cloud([[[1, 2, 3], [math.nan, 0, 0]], [[4, 5, 6], [7, 8, 9]]]))
    assert reading.points.tolist() == [[1, 2, 3], [4, 5, 6], [7, 8, 9]]
    assert (reading.frame, reading.colours, reading.words) == ('eye', None, '4 points')


@pytest.mark.parametrize('name', ['rgb', 'rgba'])
def test_clouds_have_their_colours(name):
    data = struct.pack('<fff4xI12x', 1.0, 2.0, 3.0, 0x102030)
    message = cloud(np.zeros((1, 1, 3)), point_step=32, row_step=32, data=data)
    message.fields.append(PointField(name, 16, PointField.FLOAT32, 1))
    reading = shown_reading(message)
    assert reading.points.tolist() == [[1, 2, 3]]
    assert reading.colours.tolist() == [[0x10, 0x20, 0x30]]


@pytest.mark.parametrize('shape', [(1, 60_000), (240, 250)])
def test_large_clouds_are_thinned(shape):
    reading = shown_reading(cloud(np.ones((*shape, 3))))
    assert clouds.MAX_POINTS / 2 < len(reading.points) <= clouds.MAX_POINTS


def test_old_clouds_are_shown_too():
    message = PointCloud(points=[Point32(1, 2, 3), Point32(math.inf, 0, 0)])
    assert shown_reading(message).points.tolist() == [[1, 2, 3]]
    assert shown_reading(PointCloud()).points.shape == (0, 3)


def test_contacts_are_points_with_normals():
    state = ContactState(
        collision1_name='a',
        collision2_name='b',
        contact_positions=[Vector3(1, 2, 3)],
        contact_normals=[Vector3(0, 0, 1)],
    )
    state.total_wrench.force = Vector3(0, 3, 4)
    reading = shown_reading(ContactsState(states=[state, state]))
    np.testing.assert_allclose(reading.lines, [[[1, 2, 3], [1, 2, 3.1]]] * 2)
    assert reading.points.tolist() == [[1, 2, 3]] * 2
    assert reading.words == 'a and b: 5.00 N'
    empty = shown_reading(ContactsState())
    assert (empty.points.shape, empty.lines.shape, empty.words) == ((0, 3), (0, 2, 3), 'no contact')


def test_many_contacts_are_told_briefly():
    states = [ContactState(collision1_name=f'{i:02}', collision2_name='b') for i in range(20)]
    assert shown_reading(ContactsState(states=states)).words.splitlines()[-1] == 'and 12 more'


def test_other_sensors_are_tables_of_numbers():
    imu = Imu()
    imu.linear_acceleration = Vector3(0.0, 0.5, 9.81)
    rows = dict(shown_reading(imu).rows)
    assert rows == {
        'linear_acceleration': '0 0.5 9.81',
        'orientation': '0 0 0 0',
        'angular_velocity': '0 0 0',
    }
    assert ('wrench force', '0 0 0') in shown_reading(WrenchStamped()).rows
