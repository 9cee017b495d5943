"""Rays meet the triangles of meshes, from both sides, wherever these are."""

import math
from contextlib import closing

import numpy as np
import pytest
import trimesh
from support.sensing import ROBOTS

from rosbots_description.sim.core.transforms import Pose, from_rpy
from rosbots_description.sim.public.world import World

EXACT = 1e-4  # [m]
ROBOT = (ROBOTS / 'laser_nonoise.urdf').read_text(encoding='utf-8')
ROOM = '''<sdf version="1.6"><model name="m"><static>{static}</static><pose>{pose}</pose>
<link name="l"><collision name="c"><pose>0.1 0 0 0 0 0.2</pose><laser_retro>7</laser_retro>
<geometry><mesh><uri>{uri}</uri><scale>1 1 {scale}</scale></mesh></geometry></collision></link>
</model></sdf>'''


@pytest.fixture(scope='module')
def folder(tmp_path_factory):
    """Return a folder with meshes, none of them with its middle at the origin."""
    made = tmp_path_factory.mktemp('meshes')
    for name, mesh in (('box', trimesh.creation.box((2.0, 3.0, 1.0))),
                       ('ring', trimesh.creation.annulus(2.0, 2.5, 1.5, sections=200))):
        mesh.apply_translation((0.7, -0.2, 0.1))
        mesh.export(made / f'{name}.stl')
    return made


def reference(mesh, origins, ways):
    """Return distances to the nearest of all triangles, in double precision."""
    a, b, c = (mesh.triangles[:, i][None] for i in range(3))
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
def test_a_mesh_is_met_where_its_triangles_are(folder, name, scale, pose):
    with closing(World()) as world:
        robot = world.spawn(ROBOT)
        model = world.spawn(ROOM.format(static=1, pose=pose, uri=folder / f'{name}.stl',
                                        scale=scale))
        sensor = robot.sensor('head_hokuyo_sensor')
        scan = sensor.read()
        frame = model.links['l'].collisions['c'].pose
        place = sensor.pose
    mesh = trimesh.load(folder / f'{name}.stl')
    mesh.apply_scale((1.0, 1.0, float(scale)))
    turn = trimesh.transformations.quaternion_matrix(np.roll(frame.orientation, 1))
    turn[:3, 3] = frame.position
    mesh.apply_transform(turn)
    turn = trimesh.transformations.quaternion_matrix(np.roll(place.orientation, 1))[:3, :3]
    ways = sensor.fan.ways.T @ turn.T
    expected = reference(mesh, np.repeat([place.position], len(ways), axis=0), ways)
    assert np.isfinite(expected).sum() > 20
    edges = np.isinf(expected) != np.isinf(scan.ranges)
    assert edges.sum() <= 2  # where a ray grazes
    met = np.isfinite(expected) & ~edges
    assert np.abs(scan.ranges[met] - expected[met]).max() < EXACT
    assert set(scan.intensities[met]) == {7.0}


def test_a_mesh_that_moves_is_met_where_it_is(folder):
    with closing(World()) as world:
        sensor = world.spawn(ROBOT).sensor('head_hokuyo_sensor')
        model = world.spawn(ROOM.format(static=0, pose='0 0 0 0 0 0', uri=folder / 'box.stl',
                                        scale=1))
        for x in (3.0, 500.0, 20.0):
            model.set_pose(Pose((x, 0.0, 0.0), from_rpy(0.0, 0.0, -0.2)))
            scan = sensor.read()
            if x > 30.0:
                assert np.isinf(scan.ranges).sum() == 720
            else:  # the box reaches from -0.3 to 1.7 m along x, in a frame 0.1 m on
                front = x + 0.1 * math.cos(0.2) - 0.3 - 0.12
                ahead = scan.ranges[336:340].mean() * math.cos(0.1 - 0.095)
                assert ahead == pytest.approx(front, abs=0.01)
