"""The built-in models: made by their script, of the documented sizes, and cheap."""

import subprocess
import sys

import numpy as np
import pytest
from support import ROOT

from rosbots_description.sim.core import compose
from rosbots_description.sim.description import Material, Mesh
from rosbots_description.sim.formats.sdf.world_file import load_world
from rosbots_description.sim.meshes import extent, read_mesh
from rosbots_description.sim.meshes.loader import GREY
from rosbots_description.sim.resources import ModelSearch

MODELS = ROOT / 'src' / 'rosbots_description' / 'models'
MAX_TRIANGLES = 1100
ANYWHERE = 0.03  # [m] by which an outline may differ from the documented one
AS_FILE = 0.015  # [m] by which the extents of a mesh file may differ

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
# The mesh files of Gazebo's models, and their extents as they are, without <scale> and <pose> [m].
# Those of the persons are as ours.
MESH_FILES = {
    'brick_box_3x1x3/meshes/simple_box.dae': ((-0.5, -0.5, -0.5), (0.5, 0.5, 0.5)),
    'cafe_table/meshes/cafe_table.dae': ((-0.457, -0.457, 0.0), (0.457, 0.457, 0.775)),
    'cardboard_box/meshes/cardboard_box.dae': ((-0.199, -0.199, 0.0), (0.199, 0.199, 0.397)),
    'checkerboard_plane/meshes/checkerboard_plane.dae': ((-1.0, -1.0, 0.0), (1.0, 1.0, 0.0)),
    'cinder_block/meshes/cinder_block.dae': ((-0.217, -0.102, 0.0), (0.217, 0.102, 0.203)),
    'coke_can/meshes/coke_can.dae': ((-0.038, -0.039, 0.182), (0.029, 0.028, 0.306)),
    'construction_barrel/meshes/construction_barrel.dae': ((-0.51, -0.51, 0.0), (0.51, 0.51, 1.55)),
    'construction_cone/meshes/construction_cone.dae': (
        (-0.025, -0.025, 0.0),
        (0.025, 0.025, 0.109),
    ),
    'drc_practice_blue_cylinder/meshes/cylinder.dae': (
        (-0.279, -0.279, 0.0),
        (0.279, 0.279, 0.863),
    ),
    'drc_practice_orange_jersey_barrier/meshes/jersey_barrier.dae': (
        (-0.304, -0.931, 0.0),
        (0.304, 0.87, 1.05),
    ),
    'drc_practice_white_jersey_barrier/meshes/jersey_barrier.dae': (
        (-0.304, -0.931, 0.0),
        (0.304, 0.87, 1.05),
    ),
    'drc_practice_yellow_parking_block/meshes/block.dae': (
        (-0.08, -0.902, 0.0),
        (0.08, 0.902, 0.102),
    ),
    'dumpster/meshes/dumpster.dae': ((-0.835, -0.512, 0.0), (0.835, 0.512, 1.181)),
    'fire_hydrant/meshes/fire_hydrant.dae': ((-0.212, -0.212, 0.0), (0.212, 0.212, 0.929)),
    'first_2015_trash_can/meshes/trash_can.dae': ((-0.285, -0.319, 0.0), (0.28, 0.319, 0.737)),
    'gas_station/meshes/gas_station.dae': ((-10.286, -24.177, 0.0), (10.286, 5.809, 8.983)),
    'jersey_barrier/meshes/jersey_barrier.dae': ((-2.033, -0.406, 0.0), (2.033, 0.406, 1.143)),
    'lamp_post/meshes/lamp_post.dae': ((-0.081, -1.025, 0.0), (0.081, 0.035, 3.091)),
    'mailbox/meshes/mailbox.dae': ((-0.065, -0.161, 0.0), (0.069, 0.195, 1.067)),
    'person_standing/meshes/standing.dae': ((-0.248, -0.281, -0.019), (0.248, 0.102, 1.891)),
    'person_walking/meshes/walking.dae': ((-0.173, -0.375, 0.02), (0.173, 0.275, 1.928)),
    'postbox/meshes/postbox.dae': ((-0.341, -0.342, 0.0), (0.341, 0.342, 1.524)),
    'stop_sign/meshes/stop_sign.dae': ((-0.297, -0.012, 0.0), (0.297, 0.011, 1.818)),
    # Without the 1.147 that stands on the table.
    'table_marble/meshes/table_lightmap.dae': ((-5.225, -4.297, -2.586), (5.225, 3.316, 0.12)),
}
# What stands on Gazebo's table of marble is left out; feet do not fill their box.
PARTLY = {'table_marble': 0.3, 'person_standing': 0.1, 'person_walking': 0.1}


def include(name):
    text = (
        f'<sdf version="1.7"><world name="w"><include><uri>model://{name}</uri></include>'
        '</world></sdf>'
    )
    world = load_world(text, 'w.world', find_model=ModelSearch())
    return world.models[0]


def bounds(spec, pose, kind):
    corners = [
        extent(shape.geometry, compose(compose(pose, link.pose), shape.pose))
        for link in spec.links
        for shape in getattr(link, kind)
    ]
    return (
        np.min([low for low, _ in corners], axis=0),
        np.max([high for _, high in corners], axis=0),
    )


def test_the_script_makes_these_files_and_no_others(tmp_path):
    subprocess.run([sys.executable, ROOT / 'tools' / 'make_models.py', tmp_path], check=True)
    made = {path.relative_to(tmp_path): path.read_bytes() for path in tmp_path.rglob('*.*')}
    kept = {
        path.relative_to(MODELS): path.read_bytes()
        for path in MODELS.rglob('*.*')
        if path.parent.name not in ('ground_plane', 'sun')
    }
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
            assert GREY not in {part.rgba for part in mesh.parts}
        else:
            assert visual.material.rgba != Material().rgba


def saved(address, scale='1 1 1', directories=()):
    """Return the model of a world that Gazebo saved, which names a file of the database."""
    shape = f'<geometry><mesh><uri>model://{address}</uri><scale>{scale}</scale></mesh></geometry>'
    text = f"""<sdf version="1.7"><world name="w"><model name="saved"><static>1</static>
        <link name="link"><collision name="collision">{shape}</collision>
        <visual name="visual">{shape}</visual></link></model></world></sdf>"""
    return load_world(text, 'w.world', find_model=ModelSearch(directories)).models[0]


@pytest.mark.parametrize('address', MESH_FILES)
def test_a_saved_world_finds_the_mesh_files_with_their_documented_sizes(address, caplog):
    spec, pose = saved(address)
    for kind in ('visuals', 'collisions'):
        np.testing.assert_allclose(bounds(spec, pose, kind), MESH_FILES[address], atol=AS_FILE)
    assert caplog.text == ''


def test_every_mesh_file_is_documented():
    assert {str(path.relative_to(MODELS)) for path in MODELS.rglob('*.dae')} == {*MESH_FILES}


def test_a_saved_world_scales_a_mesh_file_as_the_model_does():
    spec, pose = saved('construction_cone/meshes/construction_cone.dae', '10 10 10')
    np.testing.assert_allclose(
        bounds(spec, pose, 'collisions'), DOCUMENTED['construction_cone'][:2], atol=ANYWHERE
    )


def test_a_mesh_file_of_the_user_comes_before_the_built_in_one(tmp_path):
    own = tmp_path / 'fire_hydrant' / 'meshes'
    own.mkdir(parents=True)
    built_in = MODELS / 'brick_box_3x1x3' / 'meshes' / 'simple_box.dae'
    (own / 'fire_hydrant.dae').write_bytes(built_in.read_bytes())
    spec, _ = saved('fire_hydrant/meshes/fire_hydrant.dae', directories=[tmp_path])
    assert spec.links[0].visuals[0].geometry.path == str(own / 'fire_hydrant.dae')


@pytest.mark.parametrize('address', ['bus_stop/meshes/bench.dae', 'fire_hydrant/meshes/none.dae'])
def test_a_mesh_file_that_nobody_has_is_named_once_with_the_cure(address, caplog):
    spec, _ = saved(address)
    assert not spec.links[0].visuals
    assert not spec.links[0].collisions
    sentences = [record.getMessage() for record in caplog.records if address in record.getMessage()]
    assert len(sentences) == 1
    assert 'GAZEBO_MODEL_PATH' in sentences[0]
