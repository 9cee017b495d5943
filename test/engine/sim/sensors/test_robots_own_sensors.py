"""The sensors of the robot's xacro see what they are there for, and do not change how it drives."""

from contextlib import ExitStack

import numpy as np
import pytest
from support import robot_urdf
from support.sensing import collected

from rosbots_description.sim.physics.bullet import contacts
from rosbots_description.sim.public.world import World

STANDING = 1000  # steps after which the robot stands
# Where it is spawned, close above its wheels' place [m].
HEIGHT = -0.1
ALL = ('camera', 'imu', 'laser', 'bumper')


@pytest.fixture
def spawn():
    """Return a function (world, arguments, place) -> world and robot, which stands."""
    with ExitStack() as worlds:

        def spawn_robot(name='empty', arguments=ALL, x=0.0, **more):
            world = worlds.enter_context(World.from_file(name))
            text = robot_urdf(**dict.fromkeys(arguments, 'true'), **more)
            robot = world.spawn(text, 'rosbots', x=x, z=HEIGHT)
            world.run(STANDING)
            return world, robot

        yield spawn_robot


def readings(robot, plugin, output):
    return collected(robot.plugin(plugin).outputs[output])


def test_it_drives_as_without_sensors(spawn):
    places = []
    for arguments in ((), ALL):
        world, robot = spawn(arguments=arguments)
        robot.plugin('diff_drive').command(0.5, 0.4)
        world.run(2000)
        places.append(robot.pose)
    assert places[0] == places[1]
    assert places[0].position[0] > 0.5


def test_the_laser_sees_the_half_plane_ahead_and_nothing_of_the_robot(spawn):
    world, robot = spawn()
    scans = readings(robot, 'laser', 'scan')
    world.run(100)
    assert np.isinf(scans[-1].ranges).all()
    world, robot = spawn('rooms')
    scans = readings(robot, 'laser', 'scan')
    world.run(100)
    ranges = scans[-1].ranges
    assert len(ranges) == 361
    # The wall to the right, the one behind the door ahead, and the one to the left, from the laser.
    assert (ranges[0], ranges[180], ranges[360]) == pytest.approx((3.0725, 8.45, 2.8525), abs=0.01)


def test_the_imu_feels_its_weight_upwards(spawn):
    world, robot = spawn()
    found = readings(robot, 'imu_sensor', 'imu')
    world.run(100)
    assert found[-1].linear_acceleration == pytest.approx((0.0, 0.0, 9.8), abs=0.02)


def test_the_bumper_feels_a_wall_with_both_decks_and_nothing_before(spawn, monkeypatch):
    # Each point lies in the box of one shape, so no costly distances to meshes are needed.
    monkeypatch.setattr(contacts, '_to_triangles', None)
    world, robot = spawn('rooms', x=7.9)
    found = readings(robot, 'bumper', 'contacts')
    robot.plugin('diff_drive').command(0.5, 0.0)
    world.run(500)
    assert len(found) == 25
    assert not any(found)
    world.run(2000)
    touches = {(touch.first.rpartition('__')[2], touch.second) for touch in found[-1]}
    assert touches == {
        (f'{deck}_link_collision{number}', 'walls::link::east')
        for deck, number in (('base', ''), ('base_second', '_5'))
    }


def test_camera_sees_the_line_in_front_of_the_robot(spawn):
    world, robot = spawn('line', ('camera',), camera_pitch='0.6')
    pictures = readings(robot, 'camera', 'image')
    world.run(50)
    picture = pictures[-1]
    pixels = np.frombuffer(picture.pixels, np.uint8).reshape(picture.height, picture.width, 3)
    red, _, blue = pixels[-1].astype(int).T
    yellow = np.flatnonzero(red - blue > 100)
    # The lowest row shows the ground 0.45 m before the lens, which stands 0.11 m left of the line.
    assert 150 < yellow.mean() < 240
    assert 20 < len(yellow) == np.ptp(yellow) + 1 < 60


def test_the_depth_camera_measures_the_distance_of_a_wall(spawn):
    world, robot = spawn('rooms', ('camera', 'depth'), x=7.0, camera_pitch='0')
    clouds = readings(robot, 'openni_kinect', 'points')
    world.run(200)
    forward = clouds[-1].points[120, 160, 2]
    assert forward == pytest.approx(9.0 - 7.0 - 0.49 - 0.0788, abs=0.01)
