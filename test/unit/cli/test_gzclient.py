"""The window as a process: it reads no robot's TF, prints little, and ends on request."""

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest
import yaml
from support import ROOT
from support.patience import PATIENCE, wait_until
from support.programs import is_running

from rosbots_description.cli.gzclient import config_file, drawn_seldom, rviz_environment

WINDOW = """#!/bin/sh
echo $$ "$@" > {folder}/arguments
exec sleep 60
"""
MAIN = (
    'import sys; from rosbots_description.cli import gzclient; '
    'gzclient.display_works = lambda: True; gzclient.has_graphics_card = lambda: {}; '
    'sys.exit(gzclient.main(sys.argv[1:]))'
)


def open_window(folder, text, card=True):
    """Start gzclient with a program of this text instead of RViz."""
    program = folder / 'rviz'
    program.write_text(text)
    program.chmod(0o755)
    return subprocess.Popen(
        [sys.executable, '-c', MAIN.format(card), '--verbose', '__name:=gazebo_gui'],
        env={
            **os.environ,
            'PATH': f'{folder}:{os.environ["PATH"]}',
            'ROS_MASTER_URI': 'http://127.0.0.1:1',
        },
        stderr=subprocess.PIPE,
        text=True,
    )


def rate_of(config):
    return yaml.safe_load(config.read_text())['Visualization Manager']['Global Options'][
        'Frame Rate'
    ]


def test_pictures_are_fewer_without_a_graphics_card(tmp_path):
    copy = drawn_seldom(config_file(), str(tmp_path))
    assert (rate_of(config_file()), rate_of(copy)) == (30, 10)
    assert [*tmp_path.iterdir()] == [copy]
    assert drawn_seldom(config_file(), str(tmp_path)) == copy


def test_pictures_are_as_many_where_no_copy_can_be_made(tmp_path):
    assert drawn_seldom(config_file(), str(tmp_path / 'not there')) == config_file()


@pytest.mark.parametrize(('card', 'rate'), [(True, 30), (False, 10)])
def test_window_shows_the_config_for_its_card(tmp_path, card, rate):
    process = open_window(tmp_path, '#!/bin/sh\ncp "$2" {}\n'.format(tmp_path / 'shown'), card)
    process.communicate(timeout=PATIENCE)
    assert rate_of(tmp_path / 'shown') == rate


@pytest.fixture
def window(tmp_path):
    """Return a gzclient with a program instead of RViz, and that program's PID and arguments."""
    process = open_window(tmp_path, WINDOW.format(folder=tmp_path))
    try:
        arguments = tmp_path / 'arguments'
        wait_until(lambda: arguments.exists() and arguments.read_text())
        yield process, arguments.read_text().split()
    finally:
        process.kill()
        process.wait()


def test_window_has_its_own_tf_topics_and_ends_on_request(window):
    process, words = window
    assert {'/tf:=gazebo/view/tf', '/tf_static:=gazebo/view/frames', '__name:=gazebo_gui'} <= set(
        words
    )
    process.send_signal(signal.SIGTERM)
    assert process.wait(PATIENCE) == 0


def test_window_ends_when_its_parent_is_killed(window):
    process, words = window
    process.kill()
    process.wait()
    wait_until(lambda: not is_running(words[0]))


def test_crash_of_rviz_is_told_in_the_name_of_the_program(tmp_path):
    process = open_window(tmp_path, '#!/bin/sh\nkill -SEGV $$\n')
    _, output = process.communicate(timeout=PATIENCE)
    assert output.startswith('gzclient: RViz crashed as it opened (SIGSEGV); restarting it\n')


def test_rviz_gets_default_folder_and_log_levels_unless_the_user_sets_them(tmp_path, monkeypatch):
    monkeypatch.setattr('tempfile.tempdir', str(tmp_path))
    made = rviz_environment({}, Path('/levels'))
    assert made['ROSCONSOLE_CONFIG_FILE'] == '/levels'
    assert Path(made['XDG_RUNTIME_DIR']).stat().st_mode & 0o777 == 0o700
    given = {'XDG_RUNTIME_DIR': '/run/user/1', 'ROSCONSOLE_CONFIG_FILE': '/mine'}
    assert rviz_environment(given, Path('/levels')) == given


def test_the_layouts_have_time_displays_and_views_and_the_window_can_follow_a_model():
    for path in (config_file(), *(ROOT / 'config').glob('*.rviz')):
        layout = yaml.safe_load(path.read_text())
        assert {panel['Name'] for panel in layout['Panels']} == {'Displays', 'Views', 'Time'}
        assert layout['Window Geometry']['Time'] == {'collapsed': False}
    shown = yaml.safe_load(config_file().read_text())['Visualization Manager']
    red, _, blue = map(int, shown['Global Options']['Background Color'].split(';'))
    assert blue > red > 100  # light blue
    views = shown['Views']
    assert views['Current']['Pitch'] > 0.3  # [rad], from above
    assert views['Saved'][0]['Target Frame'] == 'rosbots'


def link_to_a_folder(path, tmp_path):
    (tmp_path / 'elsewhere').mkdir()
    path.symlink_to(tmp_path / 'elsewhere')


def folder_of_another_user(path, _tmp_path):
    if os.getuid():
        pytest.skip('only root gives folders to other users')
    path.mkdir()
    os.chown(path, 65534, 65534)


@pytest.mark.parametrize(
    'plant', [link_to_a_folder, folder_of_another_user, lambda path, _: path.touch()]
)
def test_planted_runtime_folder_is_not_used(tmp_path, monkeypatch, plant):
    monkeypatch.setattr('tempfile.tempdir', str(tmp_path))
    plant(tmp_path / f'rosbots-runtime-{os.getuid()}', tmp_path)
    assert 'XDG_RUNTIME_DIR' not in rviz_environment({}, Path('/levels'))


def test_runtime_folder_is_made_private(tmp_path, monkeypatch):
    monkeypatch.setattr('tempfile.tempdir', str(tmp_path))
    (tmp_path / f'rosbots-runtime-{os.getuid()}').mkdir(mode=0o777)
    made = Path(rviz_environment({}, Path('/levels'))['XDG_RUNTIME_DIR'])
    assert made.stat().st_mode & 0o777 == 0o700
