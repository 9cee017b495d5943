"""World files are written whole or not at all, and over no other file unasked."""

import os
import re
import stat

import pytest
from support.refusals import sentence_of

from rosbots_description.sim.core import SimError
from rosbots_description.sim.resources import new_file, write_world


@pytest.mark.parametrize(('mask', 'mode'), [(0o022, 0o644), (0o027, 0o640)])
def test_a_file_is_written_with_the_permissions_that_the_umask_leaves(tmp_path, mask, mode):
    before = os.umask(mask)
    write_world(str(tmp_path / 'a.world'), 'text')
    os.umask(before)
    assert (tmp_path / 'a.world').read_text() == 'text'
    assert stat.S_IMODE((tmp_path / 'a.world').stat().st_mode) == mode


def test_a_file_that_is_there_is_overwritten_only_if_asked(tmp_path):
    path = tmp_path / 'a.sdf'
    path.write_text('old')
    with pytest.raises(SimError, match='it exists already'):
        write_world(str(path), 'new')
    assert path.read_text() == 'old'
    write_world(str(path), 'new', overwrite=True)
    assert path.read_text() == 'new'


@pytest.mark.parametrize(
    ('path', 'reason'),
    [
        ('here.world', 'not an absolute path'),
        ('/tmp/../etc/passwd', 'ends in .world or .sdf'),
        ('/nowhere/at/all.world', 'No such file or directory'),
        ('/dev/null/a.world', 'Not a directory'),
        ('/tmp/a\0.world', 'cannot be written: '),
        (f'/tmp/{"a" * 300}.world', 'File name too long'),
    ],
)
def test_a_path_that_is_not_fit_is_refused_in_one_sentence(path, reason):
    assert re.search(reason, sentence_of(SimError, write_world, path, 'text'))


def test_no_folder_is_overwritten(tmp_path):
    (tmp_path / 'a.world').mkdir()
    with pytest.raises(SimError, match='it exists already'):
        write_world(str(tmp_path / 'a.world'), 'text', overwrite=True)


@pytest.mark.parametrize('overwrite', [False, True])
def test_a_write_that_fails_leaves_no_half_file(tmp_path, monkeypatch, overwrite):
    if overwrite:
        (tmp_path / 'a.world').write_text('old')

    def full(*_):
        raise OSError(28, 'No space left on device')

    monkeypatch.setattr(new_file.os, 'fsync', full)
    with pytest.raises(SimError, match='No space left on device'):
        write_world(str(tmp_path / 'a.world'), 'new', overwrite)
    assert [path.read_text() for path in tmp_path.iterdir()] == (['old'] if overwrite else [])


def test_no_planted_link_is_followed(tmp_path):
    kept = tmp_path / 'kept'
    kept.write_text('kept')
    for name, target in (('there', kept), ('nowhere', tmp_path / 'absent')):
        (tmp_path / f'{name}.world').symlink_to(target)
        with pytest.raises(SimError, match='it exists already'):
            write_world(str(tmp_path / f'{name}.world'), 'text')
    write_world(str(tmp_path / 'there.world'), 'text', overwrite=True)
    assert kept.read_text() == 'kept'
    assert not (tmp_path / 'absent').exists()
