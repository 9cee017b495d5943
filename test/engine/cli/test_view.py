"""rosbots-view: what it prints, its exit codes, and the page that it serves."""

import logging
import os
import re
import signal
import subprocess
import sys
from contextlib import contextmanager

import pytest
from support import ROOT
from support.browser import Browser
from support.crashing import CRASHING, crash
from support.patience import PATIENCE

from rosbots_description.cli import view
from rosbots_description.sim.core import Fault
from rosbots_description.sim.physics.bullet.engine import Engine

ROBOT = ROOT / 'urdf' / 'rosbots.xacro'
IN_BACKGROUND = 'sh', '-c', 'trap "" INT; exec "$@"', 'sh'
ADDRESS = re.compile(r'rosbots-view: the world is at (http://\S+)')


@contextmanager
def viewing(*arguments, in_background=False):
    """Yield the process; in the background of a script it ignores Ctrl-C."""
    process = subprocess.Popen(
        [
            *(IN_BACKGROUND if in_background else ()),
            sys.executable,
            '-m',
            'rosbots_description.cli.view',
            *map(str, arguments),
            '--no-open',
        ],
        stderr=subprocess.PIPE,
        text=True,
        env={**os.environ, 'PYTHONPATH': os.pathsep.join([str(ROOT / 'src'), *sys.path])},
    )
    try:
        yield process
    finally:
        process.kill()
        process.communicate(timeout=PATIENCE)


@pytest.mark.parametrize(
    ('end', 'in_background'),
    [(signal.SIGINT, False), (signal.SIGTERM, True)],
)
def test_the_page_of_a_robot_opens_and_ends_with_a_signal(end, in_background):
    with viewing(ROBOT, '--paused', in_background=in_background) as process:
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


def test_a_file_that_crashes_the_engine_ends_with_one_sentence(tmp_path, capsys, monkeypatch):
    monkeypatch.setattr(Engine, 'add', crash)
    path = tmp_path / 'a.urdf'
    inertial = '<inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1"/></inertial>'
    link = f'<link name="{CRASHING}">{inertial}</link>'
    path.write_text(f'<robot name="r">{link}</robot>', encoding='utf-8')
    assert view.main([str(path), '--no-open']) == 1
    (line,) = capsys.readouterr().err.splitlines()
    assert "model 'r' is rejected" in line


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
    view._list([Fault(f'fault {number}') for number in range(view.MOST_FAULTS + 3)])
    lines = capsys.readouterr().err.splitlines()
    assert len(lines) == view.MOST_FAULTS + 1
    assert lines[-1] == 'rosbots-view: and 3 more'


def test_the_worst_fault_comes_first_and_none_twice(capsys):
    view._list([Fault('minor'), Fault('grave', logging.ERROR), Fault('minor', step=2)])
    assert capsys.readouterr().err == 'rosbots-view: grave\nrosbots-view: minor\n'
