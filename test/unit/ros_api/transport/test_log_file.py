"""The log file of a node, where there is room for one and where there is none."""

import logging
import os
from pathlib import Path

import pytest

from rosbots_description.ros_api.transport.log_file import (
    disable_log_file,
    log_file,
    tolerate_full_disk,
    write_error,
)


@pytest.fixture
def log_to():
    """Return a function that gives the root logger a file and returns how to log to that alone."""
    added = []

    def add(path):
        handler = logging.FileHandler(path, encoding='ascii')
        logging.getLogger().addHandler(handler)
        added.append(handler)
        tolerate_full_disk()
        return lambda text, *args: handler.handle(
            logging.makeLogRecord({'msg': text, 'args': args}))

    yield add
    for handler in added:
        logging.getLogger().removeHandler(handler)


@pytest.mark.parametrize(('arguments', 'path'), [
    ([], '/logs/gazebo.log'),
    (['gui:=false', '__name:=other'], '/logs/other.log'),
    (['__log:=/a/b.log', '__name:=other'], '/a/b.log'),
])
def test_the_file_is_the_one_that_rospy_takes(monkeypatch, arguments, path):
    monkeypatch.setenv('ROS_LOG_DIR', '/logs')
    assert log_file('/gazebo', arguments) == Path(path)


def test_a_file_that_can_be_written_has_a_folder_afterwards_and_is_not_touched(tmp_path):
    assert write_error(tmp_path / 'new' / 'a.log') is None
    assert list(tmp_path.iterdir()) == [tmp_path / 'new']
    assert list((tmp_path / 'new').iterdir()) == []


@pytest.mark.parametrize(('path', 'reason'), [
    ('file/a.log', 'Not a directory'), ('file/log/a.log', 'Not a directory'),
    ('folder', 'Is a directory'),
])
def test_what_stands_in_the_way_is_named(tmp_path, path, reason):
    (tmp_path / 'file').write_text('')
    (tmp_path / 'folder').mkdir()
    assert write_error(tmp_path / path) == reason


def test_nowhere_is_a_file_in_the_very_folder_of_logs(monkeypatch):
    monkeypatch.setenv('ROS_LOG_DIR', '/logs')
    path = log_file('gazebo', disable_log_file())
    assert (str(path), os.environ['ROS_LOG_DIR']) == ('/dev/null', '/dev')


def test_a_full_disk_is_told_of_once(log_to, capsys):
    log = log_to('/dev/full')
    log('first')
    log('second')
    (line,) = capsys.readouterr().err.splitlines()
    assert 'log file /dev/full cannot be written (No space left on device)' in line


def test_a_fault_of_ours_is_shown_as_python_shows_it(log_to, tmp_path, capsys):
    log_to(tmp_path / 'a.log')('%d', 'no number')
    assert 'Logging error' in capsys.readouterr().err


def test_every_text_can_be_logged(log_to, tmp_path, capsys):
    log_to(tmp_path / 'a.log')('größe \udcff')
    assert (tmp_path / 'a.log').read_text(encoding='utf-8') == 'größe \\udcff\n'
    assert capsys.readouterr().err == ''
