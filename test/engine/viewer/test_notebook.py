"""World.show: a cell and the page take turns with the world; without a notebook, scripts run it."""

import re
import threading
from types import SimpleNamespace

import pytest
from support.browser import Browser
from support.patience import PATIENCE, wait_until
from support.window import Shown

from rosbots_description.sim import World
from rosbots_description.viewer import notebook

ROBOT = 'package://rosbots_description/urdf/rosbots.xacro'


class Events:
    """Those of a notebook."""

    def __init__(self):
        self.callbacks = {'pre_run_cell': [], 'post_run_cell': []}

    def register(self, event, callback):
        self.callbacks[event].append(callback)

    def unregister(self, event, callback):
        self.callbacks[event].remove(callback)

    def cell(self, act):
        """Run a cell, and return its result."""
        for callback in list(self.callbacks['pre_run_cell']):
            callback(None)
        try:
            return act()
        finally:
            for callback in list(self.callbacks['post_run_cell']):
                callback(None)


@pytest.fixture
def events(monkeypatch):
    events = Events()
    monkeypatch.setattr(notebook, '_shell', lambda: SimpleNamespace(events=events))
    return events


def test_the_page_plays_between_two_cells_and_never_within_one(events):
    with World.empty() as world:
        world.spawn(ROBOT, z=0.2)
        viewer = events.cell(world.show)
        with Browser(viewer.address) as browser:
            browser.wait_until(lambda: '/models/rosbots' in browser.nodes)
            assert world.time == 0.0  # it begins paused
            browser.click('Play')
            wait_until(lambda: world.time > 0.1, 'time between the cells')

            def cell():
                before = world.clock.steps
                browser.read(0.3)
                return before, world.clock.steps

            before, after = events.cell(cell)
            assert before == after
            wait_until(lambda: world.clock.steps > after, 'time after the cell')
        events.cell(viewer.close)
    assert events.callbacks == {'pre_run_cell': [], 'post_run_cell': []}


def test_run_in_a_cell_shows_the_motion_and_takes_commands(events):
    with World.empty() as world:
        robot = world.spawn(ROBOT, z=0.2)
        viewer = events.cell(world.show)
        viewer.time.unpause()
        shown = Shown(viewer.view)
        viewer.time.set_speed(0.0)
        done = []
        threading.Thread(
            target=lambda: done.append(viewer.joints.position('rosbots', 'wheel_left_joint'))
        ).start()
        made = events.cell(lambda: world.run(seconds=0.5))
        assert made == 500
        wait_until(lambda: done and shown.motions, 'command and motion')
        assert robot.pose.position[2] < 0.2
        events.cell(viewer.close)


def test_closing_the_world_ends_the_page(events):
    world = World.empty()
    viewer = events.cell(world.show)
    events.cell(world.close)
    assert viewer._ended.is_set()
    assert viewer._turns.is_over
    assert events.callbacks['pre_run_cell'] == []


def test_the_frame_has_the_page_at_the_notebooks_own_name(events):
    with World.empty() as world:
        viewer = events.cell(lambda: world.show(height=321))
        shown = viewer._repr_html_()
        assert 'height="321"' in shown
        assert re.search(r'frame\.src = "http://127\.0\.0\.1:\d+/\?token=[\w-]+"', shown)
        events.cell(viewer.close)


def test_a_script_runs_the_world_on_the_page():
    with World.empty() as world:
        world.spawn(ROBOT, z=0.2)
        viewer = world.show()
        assert str(viewer) == f'<ShownViewer at {viewer.address}>'
        world.run(seconds=0.5)
        assert world.time == 0.5
        over = threading.Event()
        thread = threading.Thread(target=viewer.serve, args=(over.is_set,))
        thread.start()
        wait_until(lambda: world.time > 0.6, 'time')
        over.set()
        thread.join(PATIENCE)
        viewer.close()
        world.run(seconds=0.1)
