"""Robots and worlds from files of any kind, with what is wrong with them."""

import logging
import re

import pytest
from support import ROOT, box_urdf
from support.refusals import sentence_of

from rosbots_description.sim import SimError, World
from rosbots_description.viewer import open_file

URDF = f'<robot name="crate">{box_urdf("1 1 1", 1.0)}</robot>'
MODEL = (
    '<sdf version="1.7"><model name="ball"><pose>1 2 7 0 0 0</pose><link name="l"><collision '
    'name="c"><geometry><sphere><radius>0.5</radius></sphere></geometry></collision></link>'
    '</model></sdf>'
)
WORLD = (
    '<sdf version="1.7"><world name="w"><include><uri>model://ground_plane</uri></include>'
    '<include><uri>model://nowhere</uri></include></world></sdf>'
)


def written(folder, name, text):
    path = folder / name
    path.write_text(text, encoding='utf-8')
    return path


@pytest.mark.parametrize(('name', 'text'), [('crate.urdf', URDF), ('ball.sdf', MODEL)])
def test_a_model_stands_on_the_ground(tmp_path, name, text):
    with open_file(written(tmp_path, name, text)) as world:
        robot = world.model(name.partition('.')[0])
        assert robot.pose.position[2] == pytest.approx(0.5)
        assert list(world.faults) == []
        world.reset_world()
        assert robot.pose.position[2] == pytest.approx(0.5)


def test_xacro_takes_arguments(tmp_path):
    text = URDF.replace('<robot', '<robot xmlns:xacro="http://www.ros.org/wiki/xacro"', 1).replace(
        'name="box"', 'name="$(arg link)"'
    )
    with open_file(written(tmp_path, 'a.xacro', text), {'link': 'given'}) as world:
        assert list(world.model('crate').links) == ['given']


def test_the_robot_of_this_package_has_all_its_parts():
    with open_file(ROOT / 'urdf' / 'rosbots.xacro') as world:
        assert world.model('rosbots').left_out == []
        assert any('not read by this plugin: <legacyMode>' in str(fault) for fault in world.faults)


def test_a_robot_that_is_fixed_to_the_world_stays_where_it_is_described(tmp_path):
    text = URDF.replace(
        '</robot>',
        '<link name="world"/><joint name="j" type="fixed">'
        '<parent link="world"/><child link="box"/></joint></robot>',
    )
    with open_file(written(tmp_path, 'a.urdf', text)) as world:
        assert world.model('crate').pose.position[2] == 0.0


@pytest.mark.parametrize('name', ['a.world', 'a.sdf'])
def test_a_world_file_is_opened_and_what_is_missing_named(tmp_path, name):
    with open_file(written(tmp_path, name, WORLD)) as world:
        assert list(world.models) == ['ground_plane']
        (fault,) = world.faults
        assert fault.line == 1
        assert 'line 1' in str(fault)
        assert 'GAZEBO_MODEL_PATH' in str(fault)


def test_included_worlds_are_opened_by_name():
    with open_file('room') as world:
        assert len(world.models) > 1


def test_meshes_beside_the_file_are_found(tmp_path):
    for there in ('cube.stl', 'missing.stl'):
        text = URDF.replace('<box size="1 1 1"/>', f'<mesh filename="{there}"/>')
        written(tmp_path, f'{there}.urdf', text)
    (tmp_path / 'cube.stl').write_text(
        'solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 1\n'
        'endloop\nendfacet\nendsolid s\n',
        encoding='utf-8',
    )
    with open_file(tmp_path / 'cube.stl.urdf'):
        pass
    with open_file(tmp_path / 'missing.stl.urdf') as world:
        assert any('missing.stl' in fault.what and fault.line for fault in world.faults)
        assert world.model('crate').left_out


def test_faults_are_collected_and_not_logged_meanwhile(tmp_path, caplog):
    text = URDF.replace(
        '</robot>', '<gazebo><plugin name="p" filename="libnone.so"/></gazebo></robot>'
    )
    with caplog.at_level(logging.WARNING):
        world = open_file(written(tmp_path, 'a.urdf', text))
    with world:
        assert any("unknown library 'libnone.so'" in str(fault) for fault in world.faults)
        assert caplog.records == []
        world.faults.report('later')
        assert caplog.messages == ['later']


@pytest.mark.parametrize(
    ('name', 'text', 'sentence'),
    [
        ('a.urdf', '<robot><', 'not well-formed'),
        ('a.urdf', '<robot name="r"/>', 'link'),
        ('a.urdf', '', 'not a model'),
        ('a.sdf', '<sdf version="1.7"/>', 'model'),
        ('a.world', '<sdf version="1.7"/>', '<world>'),
        ('a.txt', 'text', 'not a model'),
        (
            'a.xacro',
            '<robot xmlns:xacro="http://www.ros.org/wiki/xacro" name="r"><xacro:x/></robot>',
            'x',
        ),
    ],
)
def test_what_cannot_be_simulated_is_one_sentence(tmp_path, name, text, sentence):
    assert re.search(sentence, sentence_of(SimError, open_file, written(tmp_path, name, text)))


def test_a_file_that_does_not_exist_is_named(tmp_path):
    for name in ('nothing.urdf', 'nothing.world', 'nothing'):
        with pytest.raises(SimError, match=name):
            open_file(tmp_path / name)


def test_a_world_is_closed_when_its_model_cannot_be_read(tmp_path, monkeypatch):
    closed, close = [], World.close

    def note(world):
        closed.append(world)
        close(world)

    monkeypatch.setattr(World, 'close', note)
    with pytest.raises(SimError):
        open_file(written(tmp_path, 'a.urdf', '<robot/>'))
    assert len(closed) == 1
