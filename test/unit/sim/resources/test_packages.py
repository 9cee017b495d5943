"""Packages are found by their manifests, without ROS."""

import pytest
from support import ROOT

from rosbots_description.sim.resources import PackageSearch


@pytest.fixture(autouse=True)
def no_ros(monkeypatch):
    monkeypatch.delenv('ROS_PACKAGE_PATH', raising=False)


def make_package(folder, name):
    folder.mkdir(parents=True)
    (folder / 'package.xml').write_text(f'<package><name>{name}</name></package>')
    return str(folder)


def test_a_package_is_found_by_the_name_in_its_manifest_at_any_depth(tmp_path):
    wanted = make_package(tmp_path / 'deep' / 'down' / 'folder_of_another_name', 'wanted')
    make_package(tmp_path / 'wanted', 'unwanted')
    make_package(tmp_path / 'unwanted' / 'wanted', 'within_a_package')
    search = PackageSearch([tmp_path])
    assert search('wanted') == wanted
    assert search('unwanted') == str(tmp_path / 'wanted')
    assert search('nobodys') is None


def test_nested_and_ignored_packages_are_not_searched(tmp_path):
    make_package(tmp_path / 'outer', 'outer')
    make_package(tmp_path / 'outer' / 'inner', 'inner')
    make_package(tmp_path / 'ignored' / 'hidden', 'hidden')
    (tmp_path / 'ignored' / 'CATKIN_IGNORE').touch()
    search = PackageSearch([tmp_path])
    assert search('inner') is None
    assert search('hidden') is None


def test_order_of_search_is_enclosing_package_given_path_ros_path(tmp_path, monkeypatch):
    first = make_package(tmp_path / 'a' / 'robot', 'robot')
    second = make_package(tmp_path / 'b' / 'robot', 'robot')
    third = make_package(tmp_path / 'c' / 'robot', 'robot')
    monkeypatch.setenv('ROS_PACKAGE_PATH', str(tmp_path / 'c'))
    file = tmp_path / 'a' / 'robot' / 'urdf' / 'robot.urdf'
    assert PackageSearch([tmp_path / 'b'], inside=file)('robot') == first
    assert PackageSearch([tmp_path / 'b'])('robot') == second
    assert PackageSearch()('robot') == third


def test_a_directory_that_is_the_package_precedes_those_behind_it(tmp_path):
    clone = make_package(tmp_path / 'clone', 'wanted')
    make_package(tmp_path / 'workspace' / 'wanted', 'wanted')
    assert PackageSearch([clone, tmp_path / 'workspace'])('wanted') == clone


def test_this_package_is_always_found(tmp_path):
    assert PackageSearch()('rosbots_description') == str(ROOT)
    theirs = make_package(tmp_path / 'theirs', 'rosbots_description')
    assert PackageSearch([tmp_path])('rosbots_description') == theirs


def test_invalid_manifest_is_ignored(tmp_path):
    broken = tmp_path / 'broken'
    broken.mkdir()
    (broken / 'package.xml').write_text('<package><name>broken')
    assert PackageSearch([tmp_path])('broken') is None
