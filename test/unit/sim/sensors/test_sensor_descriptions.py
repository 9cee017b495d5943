"""What the elements of sensors say, their defaults in SDF and Gazebo, and their limits."""

import logging
import math
from types import SimpleNamespace

import pytest
from lxml import etree
from support.sensing import collected

from rosbots_description.sim.core import PluginError, from_rpy
from rosbots_description.sim.formats.xml.values import to_element
from rosbots_description.sim.rendering import Picture
from rosbots_description.sim.runtime import Output
from rosbots_description.sim.sensors.camera import CameraSensor
from rosbots_description.sim.sensors.camera_outputs import CameraInfo
from rosbots_description.sim.sensors.camera_plugins import CALIBRATION_TAGS, CameraPlugin, Channel
from rosbots_description.sim.sensors.noise import GaussianNoise, RandomSteps, gaussian, read_noise
from rosbots_description.sim.sensors.numbers import count, number
from rosbots_description.sim.sensors.ray import read_sweep
from rosbots_description.sim.sensors.rays.fan import Sweep


def element(text):
    return to_element(etree.fromstring(text))


@pytest.mark.parametrize(
    ('text', 'value'),
    [
        ('<a><b>1.3962634</b></a>', 1.39626),
        ('<a><b>-0.00012345678</b></a>', -0.000123457),
        ('<a><b>123456.7</b></a>', 123457.0),
        ('<a><b value="2">3</b></a>', 2.0),
        ('<a/>', 0.123456789),
    ],
)
def test_numbers_have_six_digits_as_in_gazebo(text, value):
    assert number(element(text), 'b', 0.123456789) == value


@pytest.mark.parametrize(
    ('text', 'expected'),
    [('1', 1), ('9', 9), ('2.7', 2), ('0.9', None), ('9.1', None), ('-1', None)],
)
def test_counts_are_from_1_to_a_limit(text, expected):
    given = element(f'<a><b>{text}</b></a>')
    if expected is None:
        with pytest.raises(PluginError, match='it takes a number from 1 to 9'):
            count(given, 'b', 5, 9)
    else:
        assert count(given, 'b', 5, 9) == expected
    assert count(element('<a/>'), 'b', 5, 9) == 5


@pytest.mark.parametrize(
    ('text', 'expected'),
    [
        (
            '<h><samples>5</samples><min_angle>-1</min_angle><max_angle>2</max_angle></h>',
            Sweep(5, 5, -1.0, 2.0),
        ),
        ('<h><samples>4</samples><resolution>0.5</resolution></h>', Sweep(4, 2, 0.0, 0.0)),
        ('<h><samples>4</samples><resolution>2.4</resolution></h>', Sweep(4, 9, 0.0, 0.0)),
        ('<h><min_angle>-1.570796</min_angle></h>', Sweep(7, 7, -1.5708, 0.0)),  # of six digits
        ('<h><samples>1000000</samples></h>', Sweep(1_000_000, 1_000_000, 0.0, 0.0)),
        ('<h><samples>2</samples><resolution>0.5</resolution></h>', Sweep(2, 1, 0.0, 0.0)),
        ('<h/>', Sweep(7, 7, 0.0, 0.0)),
        (
            '<h><max_angle>100</max_angle><min_angle>-100</min_angle></h>',
            Sweep(7, 7, -100.0, 100.0),
        ),
    ],
)
def test_sweep_has_as_many_rays_and_ranges_as_its_element_says(text, expected):
    assert read_sweep(element(text), 7) == expected


@pytest.mark.parametrize(
    'text',
    [
        '<h><samples>1000010</samples></h>',
        '<h><resolution>0.1</resolution></h>',
        '<h><samples>1000000</samples><resolution>1.1</resolution></h>',
        '<h><max_angle>100.1</max_angle></h>',
        '<h><min_angle>-100.1</min_angle></h>',
    ],
)
def test_sweep_beyond_a_limit_is_refused(text):
    with pytest.raises(PluginError, match='line 1'):
        read_sweep(element(text), 7)
    assert read_sweep(None, 7) == Sweep(7, 7, 0.0, 0.0)


@pytest.mark.parametrize(
    ('text', 'expected'),
    [
        ('<noise type="gaussian"><mean>0.1</mean><stddev>0.2</stddev></noise>', (0.1, 0.2)),
        ('<noise><type>gaussian_quantized</type><stddev>0.2</stddev></noise>', (0.0, 0.2)),
        ('<noise type="gaussian"><mean>0.1</mean></noise>', (0.1, 0.0)),
        ('<noise type="none"><stddev>0.2</stddev></noise>', (0.0, 0.0)),
    ],
)
def test_noise_is_gaussian_or_none(text, expected):
    found = read_noise(element(text))
    assert found == GaussianNoise(*expected)
    assert bool(found) == any(expected)


@pytest.mark.parametrize('seed', [-1, 2**65 - 1])
def test_any_integer_is_a_seed_of_which_64_bits_count(seed):
    first, other = (
        RandomSteps(SimpleNamespace(seed=number), 'a').at(5).random()
        for number in (2**64 - 1, seed)
    )
    assert first == other


def test_noise_of_a_mean_alone_or_a_deviation_alone_is_noise():
    assert GaussianNoise(0.1, 0.0)
    assert GaussianNoise(0.0, 0.1)
    assert not GaussianNoise()
    assert gaussian(0.0, 'x') == GaussianNoise()
    for wrong in (-0.1, math.inf, math.nan):
        with pytest.raises(PluginError, match='it must be at least 0'):
            gaussian(wrong, 'x')


def camera(inside=''):
    """Return a <camera> as its sensor reads it."""
    sensor = object.__new__(CameraSensor)
    sensor.model, sensor.called = SimpleNamespace(name='m'), 'camera'
    return sensor._camera(element(f'<camera name="left">{inside}</camera>'))


def test_camera_has_the_defaults_of_sdf():
    name, pose, lens, encoding = camera()
    assert (name, encoding) == ('left', 'rgb8')
    assert (pose.position, pose.orientation) == ((0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0))
    assert (lens.width, lens.height, lens.field_of_view) == (320, 240, 1.047)
    assert (lens.near, lens.far, lens.encoding) == (0.1, 100.0, 'rgb8')
    assert lens.distortion == (0.0, 0.0, 0.0, 0.0, 0.0)
    assert lens.centre == (0.5, 0.5)
    assert (lens.crop, lens.noise_mean, lens.noise_stddev) == (False, 0.0, 0.0)


def test_camera_is_as_its_element_says():
    _, pose, lens, encoding = camera(
        '<pose>1 2 3 0.1 0.2 0.3</pose><horizontal_fov>2</horizontal_fov><image><width>8</width>'
        '<height>6</height><format>L8</format></image><clip><near>1</near><far>2</far></clip>'
        '<noise type="gaussian"><mean>0.1</mean><stddev>0.2</stddev></noise><distortion>'
        '<k1>-.1</k1><k2>.2</k2><k3>.3</k3><p1>.4</p1><p2>.5</p2><center>0.25 0.75</center>'
        '</distortion>'
    )
    assert (pose.position, pose.orientation) == ((1.0, 2.0, 3.0), from_rpy(0.1, 0.2, 0.3))
    assert (lens.width, lens.height, lens.field_of_view, encoding) == (8, 6, 2.0, 'mono8')
    assert (lens.near, lens.far, lens.noise_mean, lens.noise_stddev) == (1.0, 2.0, 0.1, 0.2)
    assert lens.distortion == (-0.1, 0.2, 0.3, 0.4, 0.5)
    assert (lens.centre, lens.crop) == ((0.25, 0.75), True)  # barrel distortion


@pytest.mark.parametrize(
    ('inside', 'sentence'),
    [
        ('<horizontal_fov>0.0009</horizontal_fov>', 'more than 0 and less than pi'),
        ('<horizontal_fov>3.141</horizontal_fov>', 'more than 0 and less than pi'),
        ('<clip><near>0</near></clip>', 'near must be above 0 and below far'),
        ('<clip><near>2</near><far>2</far></clip>', 'near must be above 0 and below far'),
        ('<horizontal_fov>nan</horizontal_fov>', 'it takes a finite number'),
        ('<noise><type>gaussian</type><stddev>nan</stddev></noise>', 'it takes a finite number'),
        ('<image><width>8193</width></image>', 'from 1 to 8192'),
        ('<image><height>0</height></image>', 'from 1 to 8192'),
    ],
)
def test_camera_that_cannot_be_is_refused(inside, sentence):
    with pytest.raises(PluginError, match=sentence):
        camera(inside)


def test_focal_length_is_that_of_published_camera_info_messages():
    lens = camera(
        '<horizontal_fov>1.3962634</horizontal_fov><image><width>800</width></image>'
    ).lens
    assert lens.focal_length == pytest.approx(476.7030836014194, abs=1e-12)


@pytest.mark.parametrize('field', [0.001, 3.1405])
def test_any_field_of_view_of_a_pinhole_is_accepted(field):
    assert camera(f'<horizontal_fov>{field}</horizontal_fov>').lens.field_of_view == field


LENS = camera(
    '<horizontal_fov>1.5708</horizontal_fov><distortion><k1>-.1</k1><k2>.2</k2><k3>.3'
    '</k3><p1>.4</p1><p2>.5</p2></distortion>'
).lens


UNIT_ROW = (0.0, 0.0, 1.0, 0.0)  # the last one of a projection


def calibration(baseline=0.0, takes_distortion=False, **values):
    plugin = object.__new__(CameraPlugin)
    plugin._values = dict.fromkeys(CALIBRATION_TAGS, 0.0) | values
    plugin._takes_distortion, plugin.frame, plugin.log_prefix = takes_distortion, 'eye', ''
    return plugin.info(LENS, baseline)


def test_calibration_is_that_of_a_pinhole_in_the_middle():
    # A field of a right angle: the focal length is half of the width. The middle is Gazebo's.
    focal, x, y = pytest.approx(160.0, rel=1e-5), 160.5, 120.5
    assert calibration(takes_distortion=True) == CameraInfo(
        320,
        240,
        'plumb_bob',
        (-0.1, 0.2, 0.4, 0.5, 0.3),
        (focal, 0.0, x, 0.0, focal, y, 0.0, 0.0, 1.0),
        (1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0),
        (focal, 0.0, x, 0.0, 0.0, focal, y, 0.0, 0.0, 0.0, 1.0, 0.0),
        (0, 0),
        (0, 0, 0, 0, False),
        'eye',
    )


def test_calibration_takes_what_tags_say(caplog):
    focal = LENS.focal_length * (1.0 + 1.5e-6)
    info = calibration(
        0.07,
        Cx=1.0,
        Cy=2.0,
        focalLength=focal,
        distortionK1=0.1,
        distortionK2=0.2,
        distortionK3=0.3,
        distortionT1=0.4,
        distortionT2=0.5,
    )
    assert info.distortion == (0.1, 0.2, 0.4, 0.5, 0.3)
    assert info.intrinsics == (focal, 0.0, 1.0, 0.0, focal, 2.0, 0.0, 0.0, 1.0)
    # The baseline [m] is that of the right camera of two: Tx = -f b.
    assert info.projection == (focal, 0.0, 1.0, -focal * 0.07, 0.0, focal, 2.0, 0.0, *UNIT_ROW)
    assert 'does not fit <horizontal_fov>' in caplog.text


@pytest.mark.parametrize('share', [1.0 - 0.5e-6, 1.0 + 0.5e-6])
def test_a_focal_length_that_fits_up_to_rounding_is_not_complained_about(caplog, share):
    caplog.set_level(logging.DEBUG)
    calibration(focalLength=share * LENS.focal_length)
    assert caplog.text == ''


def test_no_compressed_image_is_sent_of_a_picture_without_a_jpeg():
    """It was requested before the reader connected."""
    plugin = SimpleNamespace(
        frame='eye', output=lambda _: Output(lambda: None), info=lambda *_: None
    )
    channel = Channel(plugin, SimpleNamespace(lens=LENS, encoding='rgb8'), '', 0.0)
    found = collected(channel.compressed)
    channel.send(Picture(1, None, None))
    channel.send(Picture(2, None, None, b'file'))
    assert [(image.stamp_ns, image.data) for image in found] == [(2, b'file')]
