"""Search for worlds by name, and error messages for missing or invalid ones."""

import logging
import os

import pytest
from support import ROOT
from support.refusals import sentence_of

from rosbots_description.ros_api.node import packages
from rosbots_description.ros_api.node.world_loading import own_worlds, read_world
from rosbots_description.sim.core import reporting_to
from rosbots_description.sim.core.errors import ModelError, NotFoundError

WORLD = '<sdf version="1.6"><world name="{}">{}</world></sdf>'
DOOR = (
    '<sdf version="1.6"><model name="door"><static>true</static><link name="leaf"/></model></sdf>'
)


@pytest.fixture(autouse=True)
def places(monkeypatch, tmp_path):
    """Limit the search path to our package; return a function that adds packages."""
    monkeypatch.delenv('GAZEBO_RESOURCE_PATH', raising=False)
    monkeypatch.delenv('GAZEBO_MODEL_PATH', raising=False)
    monkeypatch.chdir(tmp_path)

    def set_packages(*folders):
        monkeypatch.setenv('ROS_PACKAGE_PATH', os.pathsep.join([str(ROOT), *map(str, folders)]))
        packages._packages.cache_clear()
        packages.exported_directories.cache_clear()

    set_packages()
    yield set_packages
    monkeypatch.undo()
    packages._packages.cache_clear()
    packages.exported_directories.cache_clear()


def write(path, text):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding='utf-8')
    return path


def exporting(folder, attributes):
    """Write a package that exports `attributes`, e.g. 'gazebo_media_path="${prefix}"'."""
    write(
        folder / 'package.xml',
        f"""<package format="2">
      <name>{folder.name}</name><version>1.0.0</version><description>x</description>
      <maintainer email="a@b.example">a</maintainer><license>BSD</license>
      <exec_depend>gazebo_ros</exec_depend>
      <export><gazebo_ros {attributes}/></export>
    </package>""",
    )


@pytest.mark.parametrize('name', ['worlds/empty.world', 'empty.world', 'empty'])
def test_our_own_worlds_are_found_by_name(name):
    world = read_world(name)
    assert [model.name for model, _ in world.models] == ['ground_plane']
    assert [light.name for light in world.lights] == ['sun']


def test_all_our_own_worlds_can_be_read():
    assert own_worlds() == [
        f'worlds/{name}.world' for name in ('empty', 'line', 'maze', 'room', 'rooms', 'shapes')
    ]
    for name in own_worlds():
        assert read_world(name).faults == ()


def test_our_own_worlds_are_found_without_a_ros_package(tmp_path, monkeypatch, places):
    write(
        tmp_path / 'theirs' / 'package.xml', '<package><name>rosbots_description</name></package>'
    )
    for path in ('', str(tmp_path / 'theirs')):
        monkeypatch.setenv('ROS_PACKAGE_PATH', path)
        packages._packages.cache_clear()
        assert read_world('worlds/shapes.world').models


def test_a_path_is_used_as_given(tmp_path):
    write(tmp_path / 'mine.world', WORLD.format('mine', ''))
    assert read_world(str(tmp_path / 'mine.world')).name == 'mine'
    assert read_world('mine.world').name == 'mine'


def test_the_resource_path_comes_before_our_own_worlds(tmp_path, monkeypatch):
    write(tmp_path / 'share' / 'worlds' / 'empty.world', WORLD.format('theirs', ''))
    monkeypatch.setenv('GAZEBO_RESOURCE_PATH', f'/nowhere::{tmp_path}/share')
    assert read_world('worlds/empty.world').name == 'theirs'


def test_exported_worlds_and_models_of_packages_are_found(tmp_path, places):
    folder = tmp_path / 'packages' / 'houses'
    exporting(folder, 'gazebo_media_path="${prefix}" gazebo_model_path="${prefix}/models"')
    include = '<include><uri>model://door</uri></include>'
    write(folder / 'worlds' / 'house.world', WORLD.format('house', include))
    write(folder / 'models' / 'door' / 'model.sdf', DOOR)
    places(folder)
    world = read_world('worlds/house.world')
    assert [model.name for model, _ in world.models] == ['door']


def test_files_of_packages_are_found_along_the_exported_media_path(tmp_path, places):
    folder = tmp_path / 'packages' / 'shops'
    exporting(folder, 'gazebo_media_path="${prefix}"')
    mesh = write(folder / 'models' / 'shelf.obj', 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3')
    shelf = """<model name="shelf"><link name="l"><visual name="v"><geometry><mesh>
      <uri>file://models/shelf.obj</uri></mesh></geometry></visual></link></model>"""
    write(folder / 'worlds' / 'shop.world', WORLD.format('shop', shelf))
    places(folder)
    ((shelf, _),) = read_world('worlds/shop.world').models
    assert shelf.links[0].visuals[0].geometry.path == str(mesh)
    assert shelf.left_out == ()


@pytest.mark.parametrize(
    'flaw',
    [
        ('a@b.example', 'you@todo'),
        ('<version>1.0.0</version>', ''),
        ('<name>houses', '<name>A B'),
        ('<license>BSD</license>', ''),
    ],
)
def test_exports_of_a_manifest_that_catkin_rejects_are_found(tmp_path, places, flaw):
    folder = tmp_path / 'packages' / 'houses'
    exporting(folder, 'gazebo_media_path="${prefix}"')
    manifest = folder / 'package.xml'
    manifest.write_text(manifest.read_text().replace(*flaw))
    places(tmp_path / 'packages')
    assert packages.exported_directories('gazebo_media_path') == (str(folder),)


@pytest.mark.parametrize('text', ['<package><name>houses', '<package/>', ''])
def test_unreadable_manifest_is_one_error_message(tmp_path, places, text):
    write(tmp_path / 'packages' / 'houses' / 'package.xml', text)
    places(tmp_path / 'packages')
    with pytest.raises(NotFoundError, match=r'a package\.xml on ROS_PACKAGE_PATH is broken'):
        packages.find_package('houses')


def test_models_in_the_users_own_folder_are_found(tmp_path, monkeypatch):
    monkeypatch.setenv('HOME', str(tmp_path))
    write(tmp_path / '.gazebo' / 'models' / 'door' / 'model.sdf', DOOR)
    assert packages.find_model('door') == str(tmp_path / '.gazebo' / 'models' / 'door')


def test_error_about_an_unknown_world_lists_the_known_ones():
    sentence = sentence_of(NotFoundError, read_world, 'worlds/mud.world')
    assert "'worlds/mud.world'" in sentence
    assert 'GAZEBO_RESOURCE_PATH' in sentence
    assert 'worlds/shapes.world' in sentence


@pytest.mark.parametrize(
    ('text', 'message'),
    [
        ('<sdf version="1.6"><world name="w"><model', 'line 1'),
        ('<sdf version="1.6"/>', '<world>'),
        ('<robot name="r"/>', '<robot>'),
        ('', 'empty'),
    ],
)
def test_error_about_an_invalid_world_names_its_file(tmp_path, text, message):
    path = write(tmp_path / 'broken.world', text)
    sentence = sentence_of(ModelError, read_world, str(path))
    assert str(path) in sentence
    assert message in sentence


def test_messages_while_reading_are_kept_for_the_node(tmp_path, caplog):
    include = '<include><uri>model://nowhere</uri></include>'
    path = write(tmp_path / 'w.world', WORLD.format('w', include))
    faults = []
    with reporting_to(faults.append):
        read_world(str(path))
    assert caplog.records == []
    assert [fault.severity for fault in faults] == [logging.ERROR]
    assert 'model://nowhere' in str(faults[0])
