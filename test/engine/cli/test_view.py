"""rosbots-view: what it prints, its exit codes, and the page that it serves."""

import os
import re
import signal
import subprocess
import sys
from contextlib import contextmanager

import pytest
from support import ROOT
from support.browser import Browser
from support.patience import PATIENCE

from rosbots_description.cli import view

ROBOT = ROOT / 'urdf' / 'rosbots.xacro'
ADDRESS = re.compile(r'rosbots-view: the world is at (http://\S+)')


@contextmanager
def viewing(*arguments):
    """Yield the lines that the program prints, and the process."""
    process = subprocess.Popen(
        [sys.executable, '-m', 'rosbots_description.cli.view', *map(str, arguments), '--no-open'],
        stderr=subprocess.PIPE,
        text=True,
        env={**os.environ, 'PYTHONPATH': os.pathsep.join([str(ROOT / 'src'), *sys.path])},
    )
    try:
        yield process
    finally:
        process.kill()
        process.communicate(timeout=PATIENCE)


@pytest.mark.parametrize('end', [signal.SIGINT, signal.SIGTERM])
def test_the_page_of_a_robot_opens_and_ends_with_a_signal(end):
    with viewing(ROBOT, '--paused') as process:
        address = None
        while address is None:
            line = process.stderr.readline()
            assert line.startswith('rosbots-view: ')
            address = ADDRESS.match(line)
        with Browser(address[1]) as browser:
            browser.wait_until(lambda: '/models/rosbots' in browser.nodes)
            browser.wait_until(lambda: browser.control('Play'))
            browser.wait_until(lambda: browser.control('Forward'))
        process.send_signal(end)
        assert process.wait(PATIENCE) == 0
        assert 'Traceback' not in process.stderr.read()


@pytest.mark.parametrize(
    ('name', 'content', 'sentence'),
    [
        ('a.urdf', '<robot name="r"><link/></robot>', 'line 1'),
        ('a.xacro', '<robot', 'xacro rejects it'),
        ('a.world', '<sdf version="1.7"/>', '<world>'),
        ('a.urdf', None, 'No such file'),
    ],
)
def test_a_broken_file_ends_with_one_sentence(tmp_path, capsys, name, content, sentence):
    path = tmp_path / name
    if content is not None:
        path.write_text(content, encoding='utf-8')
    assert view.main([str(path), '--no-open']) == 1
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith('rosbots-view: ')
    assert sentence in line
    assert str(path) in line


@pytest.mark.parametrize(
    ('arguments', 'sentence'),
    [
        (['x.urdf', 'height=2'], "'height=2' is no argument of xacro; write NAME:=VALUE"),
        (['x.urdf', '--port', '99999'], 'no window at 127.0.0.1, port 99999'),
        (['x.urdf', '--token-file', '/nowhere'], "no token in '/nowhere'"),
    ],
)
def test_arguments_that_cannot_be_used_are_named(capsys, arguments, sentence):
    assert view.main(arguments) == 1
    assert capsys.readouterr().err.startswith(f'rosbots-view: {sentence}')


def test_missing_viser_is_named(monkeypatch, capsys):
    monkeypatch.setattr('importlib.util.find_spec', lambda _name: None)
    assert view.main(['x.urdf']) == 1
    assert "pip install 'rosbots_description[web]'" in capsys.readouterr().err


def test_many_faults_are_counted(capsys):
    view._list([f'fault {number}' for number in range(view.MOST_FAULTS + 3)])
    lines = capsys.readouterr().err.splitlines()
    assert len(lines) == view.MOST_FAULTS + 1
    assert lines[-1] == 'rosbots-view: and 3 more'
