"""Compiled models, and the limits of the engine."""

from contextlib import closing
from dataclasses import replace
from pathlib import Path

import pytest
from support import box_urdf, urdf_spec
from support.refusals import sentence_of

from rosbots_description.sim.core.errors import ModelError
from rosbots_description.sim.description.model_spec import (
    FIXED,
    REVOLUTE,
    Box,
    Collision,
    Inertial,
    JointSpec,
    LinkSpec,
    ModelSpec,
    Surface,
    Visual,
)
from rosbots_description.sim.formats.sdf.sdf import load_sdf
from rosbots_description.sim.meshes.engine_files import EngineFiles
from rosbots_description.sim.physics.bullet import size_limits
from rosbots_description.sim.physics.bullet.compiler import compile_model
from rosbots_description.sim.resources.search_path import ModelSearch

TETRAHEDRON = 'v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\n'
MASS = Inertial(1.0, ixx=1.0, iyy=1.0, izz=1.0)
MESH_LINK = """<link name="a"><inertial><mass value="1"/>
  <inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
  <collision><geometry><mesh filename="{file}"/></geometry></collision></link>"""
BOLT = '<link name="world"/><joint name="j" type="{}"><parent link="world"/><child link="a"/>{}'
LIMIT = '<axis xyz="0 0 1"/><limit effort="1" velocity="1" lower="0" upper="1"/></joint>'


@pytest.fixture(name='meshes')
def fixture_meshes():
    with closing(EngineFiles()) as meshes:
        yield meshes


def chain(joints):
    """Return a model whose links form a chain."""
    return ModelSpec(
        'chain',
        tuple(LinkSpec(f'l{i}', inertial=MASS) for i in range(joints + 1)),
        tuple(JointSpec(f'j{i}', REVOLUTE, f'l{i}', f'l{i + 1}') for i in range(joints)),
    )


def rough(surfaces, joints=0):
    """Return a chain whose first link has collisions with different surfaces."""
    shapes = tuple(
        Collision(f'c{i}', Box((0.1, 0.1, 0.1)), surface=Surface(mu=1.0 + i / 1000))
        for i in range(surfaces)
    )
    spec = chain(joints)
    return replace(spec, links=(replace(spec.links[0], collisions=shapes), *spec.links[1:]))


def loose(count):
    return ModelSpec('loose', tuple(LinkSpec(f'l{i}', inertial=MASS) for i in range(count)))


def seen(count):
    shapes = tuple(Visual(f'v{i}', Box((0.1, 0.1, 0.1))) for i in range(count))
    return ModelSpec('seen', (LinkSpec('link', inertial=MASS, visuals=shapes),))


@pytest.mark.parametrize(
    'made, most, message',
    [
        (chain, size_limits.MAX_JOINTS, 'a kinematic tree of the model has more than 127 joints'),
        (rough, size_limits.MAX_JOINTS + 1, 'has 128 collisions with surfaces of their own and 0'),
        (
            lambda count: rough(count, joints=100),
            28,
            '28 collisions with surfaces of their own and 100 joints; the physics engine supports '
            '127 of both: give the collisions of a link the same mu',
        ),
        (loose, size_limits.MAX_LINKS, 'has 501 links that fixed joints do not merge; at most 500'),
        (seen, size_limits.MAX_SHAPES, 'has 5001 collisions and visuals; at most 5000 are'),
    ],
)
def test_model_beyond_a_limit_of_the_engine_is_rejected(meshes, made, most, message):
    compile_model(made(most), meshes)
    sentence = sentence_of(ModelError, compile_model, made(most + 1), meshes)
    assert message in sentence
    assert sentence.startswith(f"model '{made(1).name}': ")


def test_error_begins_with_the_location_of_the_description(meshes):
    too_many = loose(size_limits.MAX_LINKS + 1).links
    with pytest.raises(ModelError, match=r'^robot_description, line 1: the model has 501 links'):
        compile_model(replace(urdf_spec(box_urdf('1 1 1', 1.0)), links=too_many), meshes)
    text = '<sdf version="1.6">\n<model name="m"><link name="l"/></model></sdf>'
    spec, _ = load_sdf(text, 'm', source='m.sdf', find_model=ModelSearch())
    with pytest.raises(ModelError, match=r"^m.sdf, line 2: model 'm': the model has 501 links"):
        compile_model(replace(spec, links=too_many), meshes)


@pytest.mark.parametrize(
    ('extra', 'kind'),
    [
        ('', 'hull'),
        ('<gazebo><static>true</static></gazebo>', 'surface'),
        (BOLT.format('fixed', '</joint>'), 'surface'),
        (BOLT.format('revolute', LIMIT), 'hull'),
    ],
)
def test_mesh_is_a_hull_if_movable_and_exact_if_static(tmp_path, meshes, extra, kind):
    source = tmp_path / 'm.obj'
    source.write_text(TETRAHEDRON)
    model = compile_model(urdf_spec(MESH_LINK.format(file=source) + extra), meshes)
    (file,) = model.files
    assert Path(file).name.startswith(f'{kind}_')
    text = ''.join(body.text for tree in model.trees for body in tree.bodies)
    assert f'filename="{file}"' in text
    assert model.size == len(text) + Path(file).stat().st_size


def test_files_exist_as_long_as_their_model(tmp_path, meshes):
    source = tmp_path / 'm.obj'
    source.write_text(TETRAHEDRON)
    model = compile_model(urdf_spec(MESH_LINK.format(file=source)), meshes)
    path = Path(str(model.files[0]))  # Path keeps the object itself from Python 3.12 on
    assert model.has_files
    path.unlink()
    assert not model.has_files
    del model
    model = compile_model(urdf_spec(MESH_LINK.format(file=source)), meshes)
    path = Path(str(model.files[0]))  # Path keeps the object itself from Python 3.12 on
    assert path.exists()
    del model
    assert not path.exists()


def test_fixed_joints_count_as_joints(meshes):
    spec = chain(size_limits.MAX_JOINTS + 1)
    with pytest.raises(ModelError, match='more than 127 joints'):
        compile_model(
            replace(spec, joints=tuple(replace(joint, type=FIXED) for joint in spec.joints)), meshes
        )
