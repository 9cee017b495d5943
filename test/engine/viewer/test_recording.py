"""Recordings: pages that play without a simulator, and that do not change the motion."""

import pytest
from support import box_urdf

from rosbots_description.sim import SimError, World
from rosbots_description.web.scene import SceneRecording

CRATE = f'<robot name="crate">{box_urdf("0.5 0.5 0.5", 2.0)}</robot>'


def fallen(path=None):
    with World.empty() as world:
        crate = world.spawn(CRATE, z=0.5)
        if path is None:
            world.run(seconds=1.0)
            return crate.pose, None
        with world.recording(path) as recording:
            world.run(seconds=1.0)
        return crate.pose, recording


def test_recording_is_a_page_with_the_motion_and_does_not_change_it(tmp_path, monkeypatch):
    motions = []
    move = SceneRecording.move
    monkeypatch.setattr(
        SceneRecording,
        'move',
        lambda recording, motion: (motions.append(motion), move(recording, motion)),
    )
    path = tmp_path / 'drop.html'
    pose, recording = fallen(path)
    assert pose == fallen()[0]
    content = path.read_bytes()
    assert content == recording.html
    assert b'<html' in content[:500].lower()
    assert len(motions) == 31  # 30 in a second, and the first
    assert motions[0].time == 0.0
    assert motions[-1].time == motions[-1].real_time == pytest.approx(0.99)
    assert any(motion.poses for motion in motions)


def test_recording_in_a_notebook_is_a_frame_that_runs_nothing_of_the_notebook():
    with World.empty() as world:
        recording = world.recording()
        assert recording._repr_html_() == '<p>This recording is not over.</p>'
        world.run(seconds=0.1)
        recording.close()
        shown = recording._repr_html_()
        assert shown.startswith('<iframe srcdoc="')
        assert 'sandbox="allow-scripts"' in shown


def test_a_recording_that_has_ended_has_left_the_world_and_may_end_again():
    with World.empty() as world:
        hooks = list(world.schedule._hooks)
        recording = world.recording()
        assert world.schedule._hooks != hooks
        recording.close()
        html = recording.html
        world.run(seconds=0.1)
        recording.close()
        assert world.schedule._hooks == hooks
        assert recording.html == html


def test_recording_ends_with_its_world(tmp_path):
    with World.empty() as world:
        world.recording(tmp_path / 'a.html')
        world.run(seconds=0.1)
    assert (tmp_path / 'a.html').stat().st_size > 1000


def test_where_it_cannot_be_written_is_said_at_once(tmp_path):
    with World.empty() as world:
        with pytest.raises(SimError, match=r"no folder '.*nowhere'"):
            world.recording(tmp_path / 'nowhere' / 'a.html')
        recording = world.recording()
        with pytest.raises(SimError, match='not over'):
            recording.save(tmp_path / 'a.html')
        recording.close()
        with pytest.raises(SimError, match='cannot be written: Is a directory'):
            recording.save(tmp_path)


def test_missing_viser_is_named(monkeypatch):
    monkeypatch.setattr('importlib.util.find_spec', lambda _name: None)
    with World.empty() as world:
        for act in (world.show, world.recording):
            with pytest.raises(SimError, match=r'needs the Python package viser; pip install'):
                act()
