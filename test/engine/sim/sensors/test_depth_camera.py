"""Depths and points agree with Gazebo's."""

import numpy as np
import pytest
from support.cameras import EDGES, plugin_of
from support.pictures import FILES, spawn_robot
from support.sensing import collected, recordings, robot_text

from rosbots_description.ros_api.adapters.cameras import cloud_message, image_message

POINTS = recordings('depth')  # row, column, x, y, z [m], colour
PLANE_LOWEST = 1.971654  # [m] to the ground in the last row, before a wall at 2 m
DEPTH = 1e-4  # [m]


def depths_of(camera, dtype='<f4'):
    """Return the depth image, with the sizes and encoding of its message, and the cloud."""
    plugin = plugin_of(camera)
    images, clouds = collected(plugin.depth), collected(plugin.points)
    plugin.process(camera.read())
    (image,), (cloud,) = map(image_message, images), map(cloud_message, clouds)
    kind = image.encoding, image.step, cloud.height, cloud.width, cloud.is_dense
    points = np.frombuffer(cloud.data, '<f4').reshape(image.height, image.width, 8)
    return np.frombuffer(image.data, dtype).reshape(image.height, image.width), kind, points


def recorded_depths():
    with np.load(FILES / 'openni_kinect.npz') as file:
        return file[file.files[0]]


@pytest.mark.parametrize(
    ('robot', 'kind'),
    [
        ('openni_kinect', ('32FC1', 1280, 240, 320, False)),
        ('depth_camera', ('32FC1', 1280, 1, 76800, True)),
    ],
)
def test_depths_and_points_agree_with_the_recording(scene, robot, kind):
    _, camera = spawn_robot(scene, robot)
    depths, found, points = depths_of(camera)
    assert found == kind
    recorded = recorded_depths()
    away = np.abs(depths - recorded)
    assert (away[np.isfinite(recorded)] > DEPTH).mean() < EDGES
    if robot == 'openni_kinect':
        assert np.array_equal(np.isnan(depths), np.isnan(recorded))
    for row, column, *rest in POINTS[robot]:
        *place, red, green, blue = map(float, rest)
        seen = points[row, column]
        assert seen[:3] == pytest.approx(place, abs=DEPTH, nan_ok=True)
        assert list(seen.view('u1')[16:20]) == [red, green, blue, 0]


def test_millimetres_are_rounded_down_and_none_is_zero(scene):
    """As recorded but for 21 pixels, which are 1 mm off there, too."""
    cutoff = '<pointCloudCutoff>'
    short = f'<useDepth16UC1Format>true</useDepth16UC1Format>{cutoff}'
    text = robot_text('openni_kinect', cutoff, short)
    depths, kind, _ = depths_of(next(iter(scene.spawn(text).sensors.values())), '<u2')
    assert kind[:2] == ('16UC1', 640)
    expected = np.nan_to_num(recorded_depths() * np.float32(1000.0)).astype(int)
    assert np.abs(depths - expected).max() <= 1
    assert (depths != expected).mean() < 1e-3


def test_depth_of_a_wall_is_constant(scene):
    """The level camera of the recording is 2 m from a wall 1.5 m high."""
    for name in [name for name in scene.models if name != 'ground_plane']:
        scene.delete(name)
    scene.spawn(
        '<sdf version="1.6"><model name="w"><static>1</static><pose>2.1 0 .75 0 0 0</pose>'
        '<link name="l"><visual name="v"><geometry><box><size>.2 10 1.5</size></box>'
        '</geometry></visual></link></model></sdf>'
    )
    text = robot_text(
        'openni_kinect', 'xyz="0.2 0 0.4" rpy="0 0.1 0"', 'xyz="0 0 0.75" rpy="0 0 0"'
    )
    depths, _, _ = depths_of(next(iter(scene.spawn(text).sensors.values())))
    assert np.isnan(depths).sum() == np.isnan(depths[:30]).sum() == 9600
    assert depths[30:236] == pytest.approx(2.0, abs=DEPTH)
    assert depths[-1] == pytest.approx(PLANE_LOWEST, abs=DEPTH)
