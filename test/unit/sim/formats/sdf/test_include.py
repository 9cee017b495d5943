"""Models found on search paths, included and overridden; worlds found by name."""

import logging

import pytest
from support.refusals import sentence_of

from rosbots_description.sim.core.errors import ModelError, NotFoundError
from rosbots_description.sim.core.transforms import Pose
from rosbots_description.sim.formats.sdf.sdf import load_sdf
from rosbots_description.sim.resources.search_path import ModelSearch, find_world, path_directories

CONE = (
    '<sdf version="1.6"><model name="cone"><pose>0 0 7 0 0 0</pose>'
    '<link name="body"/></model></sdf>'
)


def put(directory, name, files, offers=(('1.6', 'model.sdf'),)):
    """Write the folder of a model, with model.config."""
    folder = directory / name
    folder.mkdir(parents=True)
    entries = ''.join(f'<sdf version="{version}">{file}</sdf>' for version, file in offers)
    (folder / 'model.config').write_text(f'<model>{entries}</model>', encoding='utf-8')
    for file, text in files.items():
        (folder / file).write_text(text, encoding='utf-8')


@pytest.fixture
def cone(tmp_path):
    """Return a folder with a model."""
    put(tmp_path, 'cone', {'model.sdf': CONE})
    return tmp_path


def spawn(include, directory, name='thing'):
    """Return the world of a file with this include."""
    text = f'<sdf version="1.6"><world name="w"><include>{include}</include></world></sdf>'
    return load_sdf(text, name, source='w.sdf', find_model=ModelSearch([directory]))


def inside(include, directory):
    """Return a model that includes another."""
    text = (
        f'<sdf version="1.7"><model name="m"><link name="base"/><include>{include}</include>'
        '</model></sdf>'
    )
    return load_sdf(text, 'm', source='m.sdf', find_model=ModelSearch([directory]))[0]


def test_spawned_include_has_the_requested_name(cone):
    spec, _ = spawn('<uri>model://cone</uri>', cone)
    assert (spec.name, [link.name for link in spec.links]) == ('thing', ['body'])


def test_pose_of_a_spawned_include_is_that_of_the_include_only(cone):
    posed = '<uri>model://cone</uri><pose>1 0 0 0 0 0</pose>'
    assert spawn(posed, cone)[1] == Pose((1.0, 0.0, 0.0))
    assert spawn('<uri>model://cone</uri>', cone)[1] == Pose()


def test_an_include_overrides_static_and_adds_plugins(cone):
    spec, _ = spawn(
        '<uri>model://cone</uri><static>true</static><plugin name="p" filename="lib.so"/>', cone
    )
    assert spec.static
    assert [plugin.filename for plugin in spec.plugins] == ['lib.so']


def test_include_can_make_a_static_model_movable(tmp_path):
    put(tmp_path, 'cone', {'model.sdf': CONE.replace('<link', '<static>1</static><link', 1)})
    spec, _ = spawn('<uri>model://cone</uri><static>0</static>', tmp_path)
    assert not spec.static
    assert spec.links[0].inertial.mass == 1.0


def test_a_model_included_in_a_model_is_posed_and_renamed_by_the_include(cone):
    spec = inside('<uri>model://cone</uri><name>left</name><pose>0 1 0 0 0 0</pose>', cone)
    assert spec.link('left::body').pose == Pose((0.0, 1.0, 0.0))


def test_model_included_without_pose_keeps_its_own(cone):
    assert inside('<uri>model://cone</uri>', cone).link('cone::body').pose.position[2] == 7.0


def test_newest_readable_version_of_a_model_is_used(tmp_path):
    files = {f'{name}.sdf': CONE.replace('body', name) for name in ('old', 'good', 'future')}
    put(tmp_path, 'cone', files, (('1.4', 'old.sdf'), ('1.6', 'good.sdf'), ('1.10', 'future.sdf')))
    assert spawn('<uri>model://cone</uri>', tmp_path)[0].links[0].name == 'good'


def test_model_sdf_is_used_in_a_folder_without_model_config(tmp_path):
    (tmp_path / 'cone').mkdir()
    (tmp_path / 'cone' / 'model.sdf').write_text(CONE, encoding='utf-8')
    assert spawn('<uri>model://cone</uri>', tmp_path)[0].links[0].name == 'body'


def test_models_in_subfolders_and_at_absolute_addresses_are_found(tmp_path):
    put(tmp_path / 'car', 'models/cone', {'model.sdf': CONE})
    for uri in ('model://car/models/cone', f'file://{tmp_path}/car/models/cone'):
        assert spawn(f'<uri>{uri}</uri>', tmp_path)[0].links[0].name == 'body'


def test_the_first_directory_of_the_path_wins(tmp_path):
    put(tmp_path / 'first', 'cone', {'model.sdf': CONE.replace('body', 'first')})
    put(tmp_path / 'second', 'cone', {'model.sdf': CONE})
    search = ModelSearch([tmp_path / 'first', lambda: [tmp_path / 'second']])
    assert list(search.directories()) == [str(tmp_path / 'first'), str(tmp_path / 'second')]
    assert search('cone') == str(tmp_path / 'first' / 'cone')


@pytest.mark.parametrize('uri', ['model:///cone', 'model:////cone/', 'model://cone/model.sdf'])
def test_any_number_of_slashes_may_follow_the_scheme(cone, uri):
    spec, _ = spawn(f'<uri>{uri}</uri>', cone)
    assert [link.name for link in spec.links] == ['body']


def test_meshes_are_found_relative_to_the_including_file(tmp_path):
    part = (
        '<link name="body"><visual name="v"><geometry><mesh><uri>part.obj</uri></mesh>'
        '</geometry></visual></link>'
    )
    model = CONE.replace('<link name="body"/>', part)
    mesh = 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n'
    put(tmp_path, 'cone', {'model.sdf': model, 'part.obj': mesh})
    spec, _ = spawn('<uri>model://cone</uri>', tmp_path)
    assert spec.links[0].visuals[0].geometry.path == str(tmp_path / 'cone' / 'part.obj')


def test_builtin_ground_plane_is_used_unless_the_path_has_one(tmp_path):
    assert spawn('<uri>model://ground_plane</uri>', tmp_path)[0].links[0].name == 'link'
    put(tmp_path, 'ground_plane', {'model.sdf': CONE})
    assert spawn('<uri>model://ground_plane</uri>', tmp_path)[0].links[0].name == 'body'


def test_omissions_of_an_included_file_are_reported_once_with_its_name(tmp_path, caplog):
    put(tmp_path, 'cone', {'model.sdf': CONE.replace('<link', '<battery>x</battery><link')})
    text = (
        '<sdf version="1.7"><model name="m"><link name="base"/>'
        '<include><uri>model://cone</uri><name>one</name></include>'
        '<include><uri>model://cone</uri><name>two</name></include></model></sdf>'
    )
    with caplog.at_level(logging.WARNING):
        load_sdf(text, 'm', source='m.sdf', find_model=ModelSearch([tmp_path]))
    assert [record.getMessage() for record in caplog.records] == [
        f'{tmp_path}/cone/model.sdf: not simulated: model/battery (line 1)'
    ]


def test_circular_includes_are_rejected(tmp_path):
    for name, other in (('one', 'two'), ('two', 'one')):
        include = f'<include><uri>model://{other}</uri></include>'
        put(tmp_path, name, {'model.sdf': CONE.replace('<link', f'{include}<link')})
    assert 'includes itself' in sentence_of(ModelError, spawn, '<uri>model://one</uri>', tmp_path)


@pytest.mark.parametrize(
    'include, part',
    [
        ('', 'an <include> without <uri>'),
        ('<uri>model://nowhere</uri>', "'model://nowhere' is not to be found along the model path"),
        ('<uri>model://../etc</uri>', "'..' is not accepted"),
        ('<uri>https://fuel.gazebosim.org/1.0/turtle</uri>', 'not fetched from the network'),
        ('<uri>file:///nowhere/at/all</uri>', "'/nowhere/at/all' does not exist"),
        ('<uri>model://sun</uri>', 'contains no <model>'),
        ('<uri>model://bare</uri>', 'neither model.config nor model.sdf'),
        ('<uri>model://dumb</uri>', 'names no description'),
        ('<uri>model://gone</uri>', 'cannot be read'),
    ],
)
def test_unresolved_include_is_rejected(tmp_path, include, part):
    (tmp_path / 'bare').mkdir()
    put(tmp_path, 'dumb', {}, (('1.6', '../../secret.sdf'),))
    put(tmp_path, 'gone', {})
    assert part in sentence_of(ModelError, spawn, include, tmp_path)


def test_world_is_found_as_given_and_on_the_search_path(tmp_path, monkeypatch):
    (tmp_path / 'share' / 'worlds').mkdir(parents=True)
    world = tmp_path / 'share' / 'worlds' / 'empty.world'
    world.write_text('<sdf/>', encoding='utf-8')
    monkeypatch.chdir(tmp_path)  # where no folder worlds/ is
    for name in ('worlds/empty.world', 'empty.world', 'empty', 'worlds/empty'):
        assert find_world(name, [tmp_path / 'nowhere', tmp_path / 'share']) == world
        assert find_world(name, [tmp_path / 'share' / 'worlds']) == world
    assert find_world(str(world)) == world
    monkeypatch.chdir(tmp_path / 'share')
    assert find_world('worlds/empty.world') == world


def test_error_about_a_missing_world_lists_the_searched_folders(tmp_path):
    with pytest.raises(NotFoundError, match=f"no world file 'mars.world'.*{tmp_path}"):
        find_world('mars.world', [tmp_path])


def test_search_path_is_split_at_colons_without_empty_parts():
    assert path_directories(':/a::/b:') == ['/a', '/b']
