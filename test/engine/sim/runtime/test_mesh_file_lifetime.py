"""Converted mesh files exist as long as a model uses them."""

import gc
import shutil

import pytest
from gazebo_msgs.srv import DeleteModelRequest, SpawnModelRequest
from geometry_msgs.msg import Pose as InitialPose
from support import mesh_spec
from support.bench import Bench

from rosbots_description.sim.core.errors import ModelError
from rosbots_description.sim.core.transforms import Pose

MESH_COLLISION = """<inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0"
iyz="0"/></inertial><collision><geometry><mesh filename="file://{}"/></geometry></collision>"""


@pytest.fixture
def scratch(tmp_path, monkeypatch):
    """Return the folder of temporary files."""
    folder = tmp_path / 'scratch'
    folder.mkdir()
    monkeypatch.setattr('tempfile.tempdir', str(folder))
    return folder


def files_in(folder):
    return [path for path in folder.rglob('*') if path.is_file()]


def test_mesh_files_are_removed_with_the_last_model_that_uses_them(world, tmp_path, scratch):
    for i in range(20):
        spec = mesh_spec(tmp_path / f'part{i}.obj', 1 + i)
        for name in ('one', 'other'):
            world.spawn(spec, name, Pose((0.0, 0.0, 5.0)))
        world.delete('one')
        assert len(files_in(scratch)) == 1
        world.reset_simulation()
        world.delete('other')
        assert files_in(scratch) == []


def test_spawn_by_service_keeps_files_only_as_long_as_its_model(world, tmp_path, monkeypatch):
    monkeypatch.setattr('tempfile.tempdir', str(tmp_path))
    xml = f'<robot name="part"><link name="a">{MESH_COLLISION}</link></robot>'
    mesh_spec(tmp_path / 'part.obj')
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
def test_rebuild_needs_only_the_converted_mesh_or_its_source(world, tmp_path, scratch, harm):
    source = tmp_path / 'part.obj'
    model = world.spawn(mesh_spec(source), 'part', Pose((0.0, 0.0, 0.5)))
    world.run(400)
    at_rest = model.pose
    if harm == 'source':
        source.unlink()
    else:
        shutil.rmtree(scratch)
    world.reset_simulation()
    world.run(400)
    assert model.pose == at_rest
    world.rebuild([model])


def test_rejected_model_leaves_no_mesh_file(world, tmp_path, scratch, monkeypatch):
    spec = mesh_spec(tmp_path / 'part.obj')

    def fails(*_):
        raise ModelError('no')

    monkeypatch.setattr(world.engine, 'add', fails)
    with pytest.raises(ModelError):
        world.spawn(spec, 'part', Pose())
    gc.collect()  # the exception references the files
    assert files_in(scratch) == []
    assert 'part' not in world.models
