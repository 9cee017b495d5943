"""The links of the catkin workspace: what is right stays, as programs may be running from it."""

import pytest
from support import ROOT
from support.programs import bash

PACKAGES = ('gazebo_ros', 'rosbots_simulator')
CONFIGURED = ('CMakeLists.txt', 'package.xml', 'setup.py', 'src')  # what CMake reads of our robot


@pytest.fixture
def clone(tmp_path):
    for name in PACKAGES:
        (tmp_path / 'companions' / name / 'scripts').mkdir(parents=True)
        (tmp_path / 'companions' / name / 'package.xml').touch()
    for folder in ('scripts', 'test/rostest', 'tools'):
        (tmp_path / folder).mkdir(parents=True)
    return tmp_path


def run(clone, function):
    program = f'set -o pipefail; source {ROOT}/tools/setup/workspace.bash; {function}'
    done = bash(program, ROOT=str(clone), WORKSPACE=str(clone / '.ws'))
    assert done.returncode == 0, done.stderr
    return done.stdout


def link(clone):
    """Link the packages; return the targets of the links, by their paths in the workspace."""
    run(clone, 'link_packages')
    source = clone / '.ws' / 'src'
    return {
        str(path.relative_to(source)): path.readlink()
        for path in source.rglob('*')
        if path.is_symlink()
    }


def expected(clone):
    return {name: clone / 'companions' / name for name in PACKAGES} | {
        f'rosbots_description/{name}': clone / name for name in CONFIGURED
    }


def source_spaces(clone):
    return (clone / '.ws' / 'devel' / '.catkin').read_text(encoding='utf-8').split(';')


def test_links_that_are_right_are_not_made_anew(clone):
    assert link(clone) == expected(clone)
    source = clone / '.ws' / 'src'
    before = {path: path.lstat().st_ino for path in source.rglob('*')}
    (source / 'stale').symlink_to(clone / 'nowhere')
    (source / 'gazebo_ros').unlink()
    (source / 'gazebo_ros').symlink_to(clone / 'elsewhere')
    assert link(clone) == expected(clone)
    after = {path: path.lstat().st_ino for path in source.rglob('*')}
    del before[source / 'gazebo_ros'], after[source / 'gazebo_ros']
    assert after == before


def test_the_clone_is_a_source_space_and_no_link_leads_back_to_it(clone):
    link(clone)
    assert source_spaces(clone) == [str(clone), f'{clone}/.ws/src']
    assert all(clone != target for target in link(clone).values())


def test_a_moved_clone_is_linked_anew(clone):
    link(clone)
    moved = clone.rename(clone.with_name('moved'))
    assert link(moved) == expected(moved)
    assert source_spaces(moved) == [str(moved), f'{moved}/.ws/src']


def test_a_hidden_clone_is_linked_in_parts_and_shown_again(clone):
    link(clone)
    (clone / 'CATKIN_IGNORE').touch()
    parts = {
        f'rosbots_description/{name}': clone / name
        for name in ('companions', 'scripts', 'test', 'tools')
    }
    for _ in range(2):
        assert link(clone) == {name: clone / 'companions' / name for name in PACKAGES} | parts
        assert source_spaces(clone) == [f'{clone}/.ws/src']
    (clone / 'CATKIN_IGNORE').unlink()
    assert link(clone) == expected(clone)


def test_compiled_sources_do_not_make_the_workspace_stale(clone):
    before = run(clone, 'workspace_fingerprint')
    (clone / 'scripts' / '__pycache__').mkdir()
    (clone / 'scripts' / '__pycache__' / 'wander.pyc').touch()
    assert run(clone, 'workspace_fingerprint') == before
    (clone / 'scripts' / 'wander.py').touch()
    assert run(clone, 'workspace_fingerprint') != before
