"""Converted mesh files exist as long as a model uses them."""

import gc
import shutil

import pytest
from gazebo_msgs.srv import DeleteModelRequest, SpawnModelRequest
from geometry_msgs.msg import Pose as InitialPose
from support import box_urdf, urdf_spec
from support.bench import Bench

from rosbots_description.sim.core.errors import ModelError
from rosbots_description.sim.core.transforms import Pose

MESH_COLLISION = """<inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0"
iyz="0"/></inertial><collision><geometry><mesh filename="file://{}"/></geometry></collision>"""
TETRAHEDRON = 'v 0 0 0\nv {0} 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n'


def mesh_spec(path, size):
    path.write_text(TETRAHEDRON.format(size))
    return urdf_spec(
        box_urdf('1 1 1', 1.0).replace('<box size="1 1 1"/>', f'<mesh filename="file://{path}"/>')
    )


def test_mesh_files_are_removed_with_the_last_model_that_uses_them(world, tmp_path, monkeypatch):
    monkeypatch.setattr('tempfile.tempdir', str(tmp_path / 'scratch'))
    (tmp_path / 'scratch').mkdir()

    def files():
        return [path for path in (tmp_path / 'scratch').rglob('*') if path.is_file()]

    for i in range(20):
        spec = mesh_spec(tmp_path / f'part{i}.obj', 1 + i)
        for name in ('one', 'other'):
            world.spawn(spec, name, Pose((0.0, 0.0, 5.0)))
        world.delete('one')
        assert len(files()) == 1
        world.reset_simulation()
        world.delete('other')
        assert files() == []


def test_spawn_by_service_keeps_files_only_as_long_as_its_model(world, tmp_path, monkeypatch):
    monkeypatch.setattr('tempfile.tempdir', str(tmp_path))
    xml = f'<robot name="part"><link name="a">{MESH_COLLISION}</link></robot>'
    mesh_spec(tmp_path / 'part.obj', 1)
    bench = Bench(world)
    for _ in range(3):
        assert bench.call(
            'spawn_urdf_model',
            SpawnModelRequest('part', xml.format(tmp_path / 'part.obj'), '/', InitialPose(), ''),
        ).success
        (folder,) = tmp_path.glob('rosbots_meshes_*')
        assert len(list(folder.iterdir())) == 1
        assert bench.call('delete_model', DeleteModelRequest('part')).success
        assert list(folder.iterdir()) == []


@pytest.mark.parametrize('harm', ['source', 'folder'])
def test_rebuild_needs_only_the_converted_mesh_or_its_source(world, tmp_path, monkeypatch, harm):
    monkeypatch.setattr('tempfile.tempdir', str(tmp_path / 'scratch'))
    (tmp_path / 'scratch').mkdir()
    source = tmp_path / 'part.obj'
    model = world.spawn(mesh_spec(source, 1), 'part', Pose((0.0, 0.0, 0.5)))
    world.run(400)
    at_rest = model.pose
    if harm == 'source':
        source.unlink()
    else:
        shutil.rmtree(tmp_path / 'scratch')
    world.reset_simulation()
    world.run(400)
    assert model.pose == at_rest
    world.rebuild([model])


def test_rejected_model_leaves_no_mesh_file(world, tmp_path, monkeypatch):
    monkeypatch.setattr('tempfile.tempdir', str(tmp_path / 'scratch'))
    (tmp_path / 'scratch').mkdir()
    spec = mesh_spec(tmp_path / 'part.obj', 1)

    def fails(*_):
        raise ModelError('no')

    monkeypatch.setattr(world.engine, 'add', fails)
    with pytest.raises(ModelError):
        world.spawn(spec, 'part', Pose())
    gc.collect()  # the exception references the files
    assert [path for path in (tmp_path / 'scratch').rglob('*') if path.is_file()] == []
    assert 'part' not in world.models
