"""An environment in the browser: its own world, its own pace, and nothing while nobody looks."""

import contextlib
import threading
import time
from types import SimpleNamespace
from urllib.parse import urlsplit

import numpy as np
import pytest
from support.browser import Browser
from support.patience import PATIENCE, wait_until
from support.window import Shown

from rosbots_description.gym import SimEnv
from rosbots_description.sim import SimError
from rosbots_description.viewer import window

DRIVE = np.array([0.5, 0.2])


class Drive(SimEnv):
    """Nothing to do."""

    def score(self, _observation, _action):
        return 0.0, False


@pytest.fixture
def env():
    made = Drive(render_mode='web', settle=0.2)
    yield made
    made.close()


def test_browser_is_shown_the_robot_and_pauses_the_program(env):
    assert env.render().startswith('http://127.0.0.1:')
    env.reset(seed=0)
    with Browser(env.render()) as browser:
        end = time.monotonic() + PATIENCE
        while '/models/rosbots' not in browser.nodes and time.monotonic() < end:
            env.step(DRIVE)
            browser.read()
        assert {'/models/rosbots', '/models/ground_plane'} <= browser.nodes.keys()
        assert env._window.view.is_open
        browser.click('Pause')
        browser.wait_until(lambda: env._window.time.paused)
    wait_until(lambda: not env._window.view.is_open, 'the view closing')
    env.step(DRIVE)


def test_who_looks_is_shown_the_world_and_its_motion(env):
    env.reset(seed=0)
    env.step(DRIVE)
    viewer = Shown(env._window.view)
    env._window.time.set_speed(0.0)
    env.step(DRIVE)
    (change,) = viewer.changes
    assert change.reset
    assert [model.name for model in change.models] == ['ground_plane', 'rosbots']
    assert len(viewer.motions) == 4  # 30 frames a second
    assert viewer.motions[-1].time == pytest.approx(0.4)
    assert len(viewer.motions[-1].poses) >= 3
    env._window.view.close()
    env.step(DRIVE)
    assert len(viewer.motions) == 4


def test_time_is_paced_while_somebody_looks(env, monkeypatch):
    env.reset(seed=0)
    Shown(env._window.view)
    now = [0.0]
    monkeypatch.setattr(
        window,
        'time',
        SimpleNamespace(
            monotonic=lambda: now[0], sleep=lambda seconds: now.append(now.pop() + seconds)
        ),
    )
    for _ in range(5):
        env.step(DRIVE)
    assert now[0] == pytest.approx(0.5, abs=0.04)  # the first frame comes at once


def test_pause_and_steps_hold_the_environment_and_do_not_change_it(env):
    controls = env._window.time
    plain = Drive(settle=0.2)
    plain.reset(seed=0)
    expected = [plain.step(DRIVE)[0]['odometry'].tobytes() for _ in range(2)]
    plain.close()
    env.reset(seed=0)
    viewer = Shown(env._window.view)
    controls.set_speed(0.0)
    controls.pause()
    found = []
    thread = threading.Thread(
        target=lambda: found.extend(env.step(DRIVE)[0]['odometry'].tobytes() for _ in range(2))
    )
    thread.start()
    controls.step(30)
    wait_until(lambda: viewer.motions and viewer.motions[-1].time >= 0.23, 'the steps')
    assert viewer.motions[-1].time == pytest.approx(0.23)
    assert viewer.motions[-1].paused
    assert found == []
    env._window.view.close()  # who leaves lets it go on
    thread.join(PATIENCE)
    assert found == expected


def test_reset_is_up_to_the_program(env):
    for refused in (env._window.time.reset_world, env._window.time.reset_simulation):
        with pytest.raises(SimError, match='the program'):
            refused()


def test_the_page_is_offered_where_viser_is_there(env, monkeypatch):
    assert env.metadata['render_modes'] == ['rgb_array', 'web']
    monkeypatch.setattr('importlib.util.find_spec', lambda _name: None)
    with contextlib.closing(Drive(settle=0.1)) as without:
        assert without.metadata['render_modes'] == ['rgb_array']


def test_port_in_use_and_missing_viser_are_named(env, monkeypatch):
    port = urlsplit(env.render()).port
    with pytest.raises(SimError, match=f'port {port}'):
        Drive(render_mode='web', web_port=port, settle=0.1)
    monkeypatch.setattr('importlib.util.find_spec', lambda _name: None)
    with pytest.raises(SimError, match='needs the Python package viser; pip install'):
        Drive(render_mode='web', settle=0.1)
