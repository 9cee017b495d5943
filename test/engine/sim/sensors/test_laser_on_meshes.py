"""Rays hit the triangles of meshes from both sides."""

import math
import threading

import numpy as np
import pytest
from support.sensing import robot_text

from rosbots_description.sim.core.transforms import Pose, compose, from_rpy, rotate
from rosbots_description.sim.public.world import World
from rosbots_description.sim.sensors.rays import mesh as ray_mesh
from rosbots_description.sim.sensors.rays.mesh import EmbreeTree, RayMesh

EXACT = 1e-4  # [m]
ROBOT = robot_text('laser_nonoise')
ROOM = """<sdf version="1.6"><model name="m"><static>{static}</static><pose>{pose}</pose>
<link name="l"><collision name="c"><pose>0.1 0 0 0 0 0.2</pose><laser_retro>7</laser_retro>
<geometry><mesh><uri>{uri}</uri><scale>1 1 {scale}</scale></mesh></geometry></collision></link>
</model></sdf>"""


def box(x, y, z):
    """Return the triangles (12, 3, 3) of a cuboid."""
    sides = []
    for axis in range(3):
        for side in (-1.0, 1.0):
            corners = np.array([(side, a, b) for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))])
            corners = np.roll(corners, axis, axis=1) * (x / 2.0, y / 2.0, z / 2.0)
            sides += [corners[[0, 1, 2]], corners[[0, 2, 3]]]
    return np.array(sides)


def ring(inner, outer, height, sections):
    """Return the triangles of the walls of a hollow cylinder about z, which is open at its ends."""
    angles = np.linspace(0.0, 2.0 * math.pi, sections + 1)
    walls = []
    for radius in (inner, outer):
        circle = np.stack([radius * np.cos(angles), radius * np.sin(angles), 0.0 * angles], axis=1)
        up = np.array((0.0, 0.0, height / 2.0))
        low, high = circle - up, circle + up
        for i in range(sections):
            walls += [(low[i], low[i + 1], high[i + 1]), (low[i], high[i + 1], high[i])]
    return np.array(walls)


# None of them has its middle at the origin.
ASIDE = np.array((0.7, -0.2, 0.1))  # [m]
MESHES = {'box': box(2.0, 3.0, 1.0) + ASIDE, 'ring': ring(2.0, 2.5, 1.5, 200) + ASIDE}


@pytest.fixture(params=['with Embree', 'without Embree'])
def caster(request, monkeypatch):
    """Return which caster rays use; without Embree, as where it cannot be installed."""
    if request.param == 'with Embree':
        pytest.importorskip('embreex')
    else:
        monkeypatch.setattr(ray_mesh, 'find_spec', lambda name: None)
    return request.param


@pytest.fixture(scope='module')
def folder(tmp_path_factory):
    """Return a folder with the meshes."""
    made = tmp_path_factory.mktemp('meshes')
    for name, triangles in MESHES.items():
        corners = ''.join(
            'v {:.17g} {:.17g} {:.17g}\n'.format(*corner) for corner in triangles.reshape(-1, 3)
        )
        faces = ''.join(f'f {i} {i + 1} {i + 2}\n' for i in range(1, 3 * len(triangles), 3))
        (made / f'{name}.obj').write_text(corners + faces)
    return made


def reference(triangles, origins, ways):
    """Return distances to the nearest of all triangles, in double precision."""
    a, b, c = (triangles[:, i][None] for i in range(3))
    ways, origins = ways[:, None], origins[:, None]
    with np.errstate(all='ignore'):
        p = np.cross(ways, c - a)
        per = 1.0 / ((b - a) * p).sum(-1)
        t = origins - a
        u, q = (t * p).sum(-1) * per, np.cross(t, b - a)
        v, met = (ways * q).sum(-1) * per, ((c - a) * q).sum(-1) * per
    inside = (u > -1e-12) & (v > -1e-12) & (u + v < 1.0 + 1e-12) & (met >= 0.1)
    return np.where(inside, met, np.inf).min(axis=1)


@pytest.mark.parametrize('pose', ['4 0.5 0.3 0 0 0.4', '0 0 0.2 0 0 1', '9 -3 0 0.1 0.5 -2'])
@pytest.mark.parametrize('scale', ['1', '-2'])
@pytest.mark.parametrize('name', ['box', 'ring'])
def test_ray_hits_are_on_the_triangles_of_a_mesh(folder, caster, name, scale, pose):
    with World() as world:
        robot = world.spawn(ROBOT)
        model = world.spawn(
            ROOM.format(static=1, pose=pose, uri=folder / f'{name}.obj', scale=scale)
        )
        sensor = robot.sensor('head_hokuyo_sensor')
        scan = sensor.read()
        frame = model.links['l'].collisions['c'].pose
        place = sensor.pose
    corners = (MESHES[name] * (1.0, 1.0, float(scale))).reshape(-1, 3)
    placed = [compose(frame, Pose(tuple(corner))).position for corner in corners.tolist()]
    ways = np.array([rotate(place.orientation, way) for way in sensor.fan.ways.T.tolist()])
    expected = reference(
        np.array(placed).reshape(-1, 3, 3), np.repeat([place.position], len(ways), axis=0), ways
    )
    assert np.isfinite(expected).sum() > 20
    edges = np.isinf(expected) != np.isinf(scan.ranges)
    assert edges.sum() <= 2  # where a ray grazes
    met = np.isfinite(expected) & ~edges
    assert np.abs(scan.ranges[met] - expected[met]).max() < EXACT
    assert set(scan.intensities[met]) == {7.0}


def test_moving_mesh_is_hit_at_its_pose(folder, caster):
    with World() as world:
        sensor = world.spawn(ROBOT).sensor('head_hokuyo_sensor')
        model = world.spawn(
            ROOM.format(static=0, pose='0 0 0 0 0 0', uri=folder / 'box.obj', scale=1)
        )
        for x in (3.0, 500.0, 20.0):
            model.set_pose(Pose((x, 0.0, 0.0), from_rpy(0.0, 0.0, -0.2)))
            scan = sensor.read()
            if x > 30.0:
                assert np.isinf(scan.ranges).sum() == 720
            else:  # the box reaches from -0.3 to 1.7 m along x, in a frame 0.1 m on
                front = x + 0.1 * math.cos(0.2) - 0.3 - 0.12
                ahead = scan.ranges[336:340].mean() * math.cos(0.1 - 0.095)
                assert ahead == pytest.approx(front, abs=0.01)


def test_readings_are_the_same_with_and_without_embree(monkeypatch):
    """Of 20 000 small triangles in all directions, and of 720 rays from all around."""
    pytest.importorskip('embreex')
    random = np.random.default_rng(5)
    knots = random.normal(size=(400, 3)) * (0.3, 0.3, 0.1)  # a crowd of small triangles
    vertices = (knots[:, None] + random.normal(size=(400, 150, 3)) * 0.02).reshape(-1, 3)
    faces = np.arange(len(vertices)).reshape(-1, 3)
    ways = random.normal(size=(720, 3))
    ways /= np.linalg.norm(ways, axis=1)[:, None]
    starts = random.normal(size=(720, 3)) * 2.0
    ways[::2] = -starts[::2] / np.linalg.norm(starts[::2], axis=1)[:, None]
    with_it = EmbreeTree(vertices, faces).distances(starts, ways)
    monkeypatch.setattr(ray_mesh, 'find_spec', lambda name: None)
    without = ray_mesh.caster(vertices, faces).distances(starts, ways)
    hit = np.isfinite(without)
    assert 200 < hit.sum() < 720
    apart = np.abs(without[hit] - with_it[hit]) > EXACT
    assert apart.sum() + ((with_it < 1e6) != hit).sum() <= 2  # where a ray grazes


@pytest.mark.parametrize('sensor_first', [True, False])
def test_meshes_are_built_from_the_spawn_on(folder, monkeypatch, sensor_first):
    """The first scan, in the world's loop, finds them ready, or waits for them."""
    builders = []
    start = threading.Thread.start
    monkeypatch.setattr(threading.Thread, 'start', lambda one: builders.append(one) or start(one))
    room = ROOM.format(static=1, pose='0 0 0 0 0 0', uri=folder / 'box.obj', scale=1)
    with World() as world:
        for text in (ROBOT, room) if sensor_first else (room, ROBOT):
            world.spawn(text)
        assert [one.name for one in builders] == ['ray meshes']
        builders[0].join()
        monkeypatch.setattr(RayMesh, '__init__', None)  # nothing is built any more
        assert np.isfinite(world.models['lbot'].sensor('head_hokuyo_sensor').read().ranges).any()


def test_missing_mesh_is_reported_once_and_not_hit(folder, tmp_path, caplog):
    file = tmp_path / 'box.obj'
    file.write_bytes((folder / 'box.obj').read_bytes())
    with World() as world:
        world.spawn(ROOM.format(static=1, pose='4 0 0 0 0 0', uri=file, scale=1))
        file.unlink()
        sensor = world.spawn(ROBOT).sensor('head_hokuyo_sensor')
        for _ in range(2):
            assert np.isinf(sensor.read().ranges).all()
            world.spawn(ROBOT, f'r{_}', x=50.0)
    assert caplog.text.count('rays do not see a mesh') == 1
