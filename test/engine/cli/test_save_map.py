"""save_map on world files: what it writes, and what it says where it cannot."""

import pytest
from support import ROOT

from rosbots_description.cli import save_map

CRATE = """<sdf version="1.6"><world name="w"><model name="crate"><static>1</static>
  <pose>0.5 0.5 0.5 0 0 0</pose>
  <link name="body"><collision name="c"><geometry><box><size>1 1 1</size></box></geometry>
  </collision></link></model></world></sdf>"""


@pytest.fixture
def world(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    path = tmp_path / 'crate.world'
    path.write_text(CRATE)
    return str(path)


def test_a_world_file_is_mapped_without_ros(world, tmp_path, capsys):
    assert (
        save_map.main(['crate.yaml', '--world', world, '--resolution', '0.5', '--margin', '0.5'])
        == 0
    )
    assert capsys.readouterr() == ('a map of 4 x 4 cells, 4 of them occupied: crate.yaml\n', '')
    assert sorted(path.name for path in tmp_path.iterdir()) == [
        'crate.pgm',
        'crate.world',
        'crate.yaml',
    ]


def test_models_that_are_left_out_are_named(world, capsys):
    assert save_map.main(['crate', '--world', world, '--without', 'crate']) == 0
    assert capsys.readouterr().out.endswith(' 0 of them occupied: crate.yaml\nleft out: crate\n')


@pytest.mark.parametrize(
    ('arguments', 'said'),
    [
        (['--world', 'nowhere.world'], "no world file 'nowhere.world'"),
        (['--without', 'nobody'], "there is no model 'nobody'; models: crate"),
        (['--resolution', '-1'], 'a map takes a finite height, a positive resolution'),
        (['--resolution', '1e-9'], 'choose a coarser resolution'),
        (['--height', 'nan'], 'a map takes a finite height'),
        ([], 'cannot be written: it exists already'),
    ],
)
def test_what_cannot_be_mapped_is_said_in_one_sentence(world, tmp_path, capsys, arguments, said):
    (tmp_path / 'crate.pgm').touch()
    named = [] if '--world' in arguments else ['--world', world]
    assert save_map.main(['crate', *named, *arguments]) == 1
    out, err = capsys.readouterr()
    assert out == ''
    assert err.startswith('save_map: ')
    assert said in err
    assert err.count('\n') == 1
    assert not (tmp_path / 'crate.yaml').exists()


def test_ready_map_of_rosbots_navigation_is_that_of_its_world(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    scanner = '0.51'  # [m], its height above the ground
    assert save_map.main(['rooms', '--world', 'worlds/rooms.world', '--height', scanner]) == 0
    for name in ('rooms.pgm', 'rooms.yaml'):
        ready = ROOT / 'companions' / 'rosbots_navigation' / 'maps' / name
        assert (tmp_path / name).read_bytes() == ready.read_bytes()
