"""The log file of a node, on a usable disk and on a full one."""

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
            logging.makeLogRecord({'msg': text, 'args': args})
        )

    yield add
    for handler in added:
        logging.getLogger().removeHandler(handler)


@pytest.mark.parametrize(
    ('arguments', 'path'),
    [
        ([], '/logs/gazebo.log'),
        (['gui:=false', '__name:=other'], '/logs/other.log'),
        (['__log:=/a/b.log', '__name:=other'], '/a/b.log'),
    ],
)
def test_path_is_that_of_rospy(monkeypatch, arguments, path):
    monkeypatch.setenv('ROS_LOG_DIR', '/logs')
    assert log_file('/gazebo', arguments) == Path(path)


def test_folder_of_a_writable_file_is_made_and_the_file_is_not(tmp_path):
    assert write_error(tmp_path / 'new' / 'a.log') is None
    assert list(tmp_path.iterdir()) == [tmp_path / 'new']
    assert list((tmp_path / 'new').iterdir()) == []


@pytest.mark.parametrize(
    ('path', 'reason'),
    [
        ('file/a.log', 'Not a directory'),
        ('file/log/a.log', 'Not a directory'),
        ('folder', 'Is a directory'),
    ],
)
def test_error_names_the_obstacle(tmp_path, path, reason):
    (tmp_path / 'file').write_text('')
    (tmp_path / 'folder').mkdir()
    assert write_error(tmp_path / path) == reason


def test_file_in_the_place_of_the_log_folder_is_an_error(monkeypatch):
    monkeypatch.setenv('ROS_LOG_DIR', '/logs')
    path = log_file('gazebo', disable_log_file())
    assert (str(path), os.environ['ROS_LOG_DIR']) == ('/dev/null', '/dev')


def test_full_disk_is_reported_once(log_to, capsys):
    log = log_to('/dev/full')
    log('first')
    log('second')
    (line,) = capsys.readouterr().err.splitlines()
    assert 'log file /dev/full cannot be written (No space left on device)' in line


def test_logging_error_is_shown_with_its_traceback(log_to, tmp_path, capsys):
    log_to(tmp_path / 'a.log')('%d', 'no number')
    assert 'Logging error' in capsys.readouterr().err


def test_every_text_can_be_logged(log_to, tmp_path, capsys):
    log_to(tmp_path / 'a.log')('größe \udcff')
    assert (tmp_path / 'a.log').read_text(encoding='utf-8') == 'größe \\udcff\n'
    assert capsys.readouterr().err == ''
