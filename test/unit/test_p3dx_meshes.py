"""The meshes of gazebo_plugins that public robots refer to."""

import subprocess
import sys
from collections import Counter

import numpy as np
import pytest
from support import ROOT

from rosbots_description.sim.meshes import read_mesh

MESHES = ROOT / 'companions' / 'gazebo_plugins' / 'test' / 'multi_robot_scenario' / 'meshes'
ANYWHERE = 0.001  # [m] by which an extent may differ from the documented one
MAX_TRIANGLES = 300

# Half extents of upstream's meshes [m]; all are centred.
DOCUMENTED = {
    'laser/hokuyo.dae': (0.025, 0.025, 0.035),
    'p3dx/back_rim.stl': (0.0615, 0.1375, 0.0197),
    'p3dx/back_sonar.stl': (0.0611, 0.1379, 0.0185),
    'p3dx/center_hubcap.stl': (0.016, 0.0211, 0.0159),
    'p3dx/center_wheel.stl': (0.0382, 0.0159, 0.0382),
    'p3dx/chassis.stl': (0.2149, 0.1386, 0.0861),
    'p3dx/front_rim.stl': (0.0615, 0.1375, 0.0197),
    'p3dx/front_sonar.stl': (0.0611, 0.1379, 0.0185),
    'p3dx/left_hubcap.stl': (0.0522, 0.015, 0.0523),
    'p3dx/left_wheel.stl': (0.0912, 0.0203, 0.0912),
    'p3dx/right_hubcap.stl': (0.0522, 0.015, 0.0523),
    'p3dx/right_wheel.stl': (0.0912, 0.0203, 0.0912),
    'p3dx/swivel.stl': (0.0367, 0.0323, 0.0277),
    'p3dx/top.stl': (0.2211, 0.1906, 0.0026),
}


def test_the_script_makes_these_files_and_no_others(tmp_path):
    subprocess.run([sys.executable, ROOT / 'tools' / 'make_p3dx_meshes.py', tmp_path], check=True)
    made = {str(path.relative_to(tmp_path)): path.read_bytes() for path in tmp_path.rglob('*.*')}
    kept = {str(path.relative_to(MESHES)): path.read_bytes() for path in MESHES.rglob('*.*')}
    assert kept == made
    assert set(made) == set(DOCUMENTED)


@pytest.mark.parametrize('name', DOCUMENTED)
def test_a_mesh_has_the_documented_extents_and_few_triangles(name):
    vertices, faces = read_mesh(str(MESHES / name)).triangles()
    np.testing.assert_allclose(vertices.max(axis=0), DOCUMENTED[name], atol=ANYWHERE)
    np.testing.assert_allclose(vertices.min(axis=0), np.negative(DOCUMENTED[name]), atol=ANYWHERE)
    assert len(faces) <= MAX_TRIANGLES


@pytest.mark.parametrize('name', DOCUMENTED)
def test_a_mesh_is_closed_and_faces_outwards(name):
    vertices, faces = read_mesh(str(MESHES / name)).triangles()
    corners = vertices[faces]
    _, numbers = np.unique(corners.reshape(-1, 3).round(6), axis=0, return_inverse=True)
    a, b, c = numbers.reshape(-1, 3).T.tolist()
    edges = Counter(zip(a + b + c, b + c + a, strict=True))
    assert all(edges[end, start] == edges[start, end] for start, end in list(edges))
    assert np.einsum('ij,ij', corners[:, 0], np.cross(corners[:, 1], corners[:, 2])) > 0.0
