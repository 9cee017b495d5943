"""The built-in models: made by their script, of the documented sizes, and cheap."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from rosbots_description.sim.core import compose
from rosbots_description.sim.description import Material, Mesh
from rosbots_description.sim.formats.sdf.world_file import load_world
from rosbots_description.sim.meshes import extent, read_mesh
from rosbots_description.sim.resources import ModelSearch

ROOT = Path(__file__).resolve().parents[2]
MODELS = ROOT / 'src' / 'rosbots_description' / 'models'
MAX_TRIANGLES = 500
ANYWHERE = 0.03  # [m] by which an outline may differ from the documented one

# Extents of Gazebo's models, as included at the origin [m]: low and high corner; their mass [kg],
# None: static.
DOCUMENTED = {
    'asphalt_plane': ((-10, -10, -0.05), (10, 10, 0.05), None),
    'beer': ((-0.055, -0.055, 0.0), (0.055, 0.055, 0.23), 0.39),
    'bookshelf': ((-0.46, -0.395, 0.0), (0.46, 0.01, 1.2), None),
    'brick_box_3x1x3': ((-1.5, -0.5, 0.0), (1.5, 0.5, 3.0), None),
    'cabinet': ((-0.225, -0.245, 0.0), (0.245, 0.245, 1.02), None),
    'cafe_table': ((-0.457, -0.457, 0.0), (0.457, 0.457, 0.775), None),
    'cardboard_box': ((-0.25, -0.2, 0.0), (0.25, 0.2, 0.3), 2.0),
    'checkerboard_plane': ((-1.0, -1.0, 0.0), (1.0, 1.0, 0.0), None),
    'cinder_block': ((-0.217, -0.102, 0.0), (0.217, 0.102, 0.203), 5.0),
    'coke_can': ((-0.034, -0.034, 0.003), (0.033, 0.033, 0.126), 0.39),
    'construction_barrel': ((-0.51, -0.51, 0.0), (0.51, 0.51, 1.55), 500.0),
    'construction_cone': ((-0.251, -0.251, 0.0), (0.251, 0.251, 1.089), 1.0),
    'drc_practice_blue_cylinder': ((-0.279, -0.279, 0.0), (0.279, 0.279, 0.863), None),
    'drc_practice_orange_jersey_barrier': ((-0.304, -0.931, 0.0), (0.304, 0.87, 1.05), None),
    'drc_practice_white_jersey_barrier': ((-0.304, -0.931, 0.0), (0.304, 0.87, 1.05), None),
    'drc_practice_yellow_parking_block': ((-0.08, -0.902, 0.0), (0.08, 0.902, 0.102), None),
    'dumpster': ((-1.253, -0.768, 0.0), (1.253, 0.768, 1.772), 1.0),
    'fire_hydrant': ((-0.212, -0.212, 0.0), (0.212, 0.212, 0.929), None),
    'first_2015_trash_can': ((-0.285, -0.319, 0.0), (0.28, 0.319, 0.737), 4.83076),
    'gas_station': ((-10.286, -24.177, 0.0), (10.286, 5.809, 8.983), None),
    'grey_wall': ((-3.75, -0.1, 0.0), (3.75, 0.1, 2.8), None),
    'jersey_barrier': ((-2.033, -0.406, 0.0), (2.033, 0.406, 1.143), None),
    'lamp_post': ((-0.244, -3.076, 0.0), (0.244, 0.106, 9.272), None),
    'mailbox': ((-0.065, -0.161, 0.0), (0.069, 0.195, 1.067), 1.0),
    # The boxes that have the inertia of Gazebo's.
    'person_standing': ((-0.25, -0.275, 0.0), (0.25, 0.075, 1.9), 80.0),
    'person_walking': ((-0.175, -0.375, 0.0), (0.175, 0.375, 1.9), 80.0),
    'postbox': ((-0.341, -0.342, 0.0), (0.341, 0.342, 1.524), None),
    'stop_sign': ((-0.297, -0.012, 0.0), (0.297, 0.011, 1.818), None),
    'table': ((-0.75, -0.4, 0.0), (0.75, 0.4, 1.015), None),
    'table_marble': ((-1.306, -1.074, 0.0), (1.306, 0.829, 0.965), None),
}
# What stands on Gazebo's table of marble is left out; feet do not fill their box.
PARTLY = {'table_marble': 0.3, 'person_standing': 0.1, 'person_walking': 0.1}


def include(name):
    text = f'<sdf version="1.7"><world name="w"><include><uri>model://{name}</uri></include>' \
        '</world></sdf>'
    world = load_world(text, 'w.world', find_model=ModelSearch())
    return world.models[0]


def bounds(spec, pose, kind):
    corners = [extent(shape.geometry, compose(compose(pose, link.pose), shape.pose))
               for link in spec.links for shape in getattr(link, kind)]
    return (np.min([low for low, _ in corners], axis=0),
            np.max([high for _, high in corners], axis=0))


def test_the_script_makes_these_files_and_no_others(tmp_path):
    subprocess.run([sys.executable, ROOT / 'tools' / 'make_models.py', tmp_path], check=True)
    made = {path.relative_to(tmp_path): path.read_bytes() for path in tmp_path.rglob('*.*')}
    kept = {path.relative_to(MODELS): path.read_bytes() for path in MODELS.rglob('*.*')
            if path.parent.name not in ('ground_plane', 'sun')}
    assert kept == made
    assert {path.parts[0] for path in made} == set(DOCUMENTED)


@pytest.mark.parametrize('name', DOCUMENTED)
def test_a_model_has_the_documented_size_and_mass(name, caplog):
    spec, pose = include(name)
    low, high, mass = DOCUMENTED[name]
    assert caplog.text == ''
    margin = PARTLY.get(name, ANYWHERE)
    np.testing.assert_allclose(bounds(spec, pose, 'visuals'), (low, high), atol=margin)
    if spec.links[0].collisions:
        np.testing.assert_allclose(bounds(spec, pose, 'collisions'), (low, high), atol=margin)
    assert spec.static == (mass is None)
    if mass is not None:
        assert spec.links[0].inertial.mass == pytest.approx(mass)


@pytest.mark.parametrize('name', DOCUMENTED)
def test_a_model_is_coloured_and_low_in_triangles(name):
    spec, _ = include(name)
    for visual in spec.links[0].visuals:
        if isinstance(visual.geometry, Mesh):
            mesh = read_mesh(visual.geometry.path)
            assert 10 < sum(len(part.faces) for part in mesh.parts) <= MAX_TRIANGLES
        else:
            assert visual.material.rgba != Material().rgba
