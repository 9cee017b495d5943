"""Images survive whatever befalls the process that renders them."""

import logging
import os
import signal
import socket
import sys
import time

import numpy as np
import pytest
from support import robot_spec
from support.cameras import EDGES, LEVELS, process_of, stamps
from support.patience import wait_until
from support.pictures import recorded_world, spawn_robot
from support.programs import ran

from rosbots_description.sim.core.transforms import Pose


def test_missing_opengl_is_one_error_with_the_cure(scene, caplog, monkeypatch):
    monkeypatch.setenv('__EGL_VENDOR_LIBRARY_FILENAMES', '/nonexistent')
    _, camera = spawn_robot(scene, 'camera_320')
    taken = stamps(camera)
    scene.run(seconds=0.5)
    assert taken == []
    assert [r.message for r in caplog.records if r.levelno == logging.ERROR] == [
        'cameras cannot render images: there is no OpenGL 3.3 (requested device index 0, but found '
        '0 devices); install libegl-mesa0 and libgl1-mesa-dri, which draw in software'
    ]


def test_dead_render_process_is_restarted(scene, caplog):
    _, camera = spawn_robot(scene, 'camera_320')
    before = camera.read().pixels
    dead = process_of(scene)
    os.kill(dead, signal.SIGKILL)
    taken = stamps(camera)
    scene.run(seconds=0.1)
    assert len(taken) == 3
    assert process_of(scene) != dead
    # The robot has settled by some micrometres.
    assert (np.abs(camera.read().pixels.astype(int) - before) > LEVELS).mean() < EDGES
    assert [r.message for r in caplog.records if r.levelno == logging.ERROR] == [
        'the render process has died (killed by signal 9); restarting it'
    ]


@pytest.mark.parametrize('paced', [False, True])
def test_stopped_render_process_is_replaced(scene, caplog, paced):
    _, camera = spawn_robot(scene, 'camera_320')
    camera.read()
    taken, stopped = stamps(camera), process_of(scene)
    os.kill(stopped, signal.SIGSTOP)
    scene.is_paced = paced
    deadline = time.monotonic() + 60.0
    while not taken and time.monotonic() < deadline:
        scene.run(steps=10)
        time.sleep(0.001)
    assert taken
    assert process_of(scene) != stopped
    assert not os.path.exists(f'/proc/{stopped}')
    assert [r.message for r in caplog.records if r.levelno == logging.ERROR] == [
        'the render process has died (it was stopped, or hung, and was killed); restarting it'
    ]


def test_world_with_a_stopped_render_process_can_be_closed():
    with recorded_world() as world:
        spawn_robot(world, 'camera_320')[1].read()
        stopped = process_of(world)
        os.kill(stopped, signal.SIGSTOP)
    assert not os.path.exists(f'/proc/{stopped}')


def test_render_process_reads_no_module_of_the_working_folder(scene, tmp_path, monkeypatch):
    for name in ('socket', 'numpy', 'mmap', 'PIL', 'moderngl'):
        (tmp_path / f'{name}.py').write_text(f"open('{tmp_path}/harm', 'w')")
    monkeypatch.chdir(tmp_path)
    assert spawn_robot(scene, 'camera_320')[1].read().pixels is not None
    assert not (tmp_path / 'harm').exists()


def test_meshes_are_sent_with_any_default_timeout_of_sockets(scene, caplog):
    socket.setdefaulttimeout(60.0)  # as rospy does
    try:
        scene.spawn(robot_spec(), 'rosbots', Pose((0.0, 2.0, 0.5)))
        _, camera = spawn_robot(scene, 'camera_320')
        taken = stamps(camera)
        scene.run(seconds=0.1)
    finally:
        socket.setdefaulttimeout(None)
    assert len(taken) == 3
    assert [r.message for r in caplog.records if r.levelno == logging.ERROR] == []


def test_render_process_ends_with_its_parent():
    text = f"""
import os, sys
sys.path[:0] = {sys.path!r}
from support.pictures import recorded_world, spawn_robot
from rosbots_description.sim.rendering.image_capture import renderer_of
world = recorded_world()
spawn_robot(world, 'camera_320')[1].read()
print(renderer_of(world).process.process_id, flush=True)
os.kill(os.getpid(), 9)
"""
    run = ran(sys.executable, '-c', text)
    drawing = int(run.stdout)
    wait_until(lambda: not os.path.exists(f'/proc/{drawing}'), 'the end of the renderer')


def test_robot_can_be_deleted_while_its_image_is_rendered(scene):
    model, camera = spawn_robot(scene, 'camera_320')
    stamps(camera)
    scene.is_paced = True
    scene.run(seconds=0.1)
    scene.delete(model.name)
    _, camera = spawn_robot(scene, 'camera_640')  # what comes for the other one is not for it
    assert camera.read().pixels.shape == (480, 640, 3)
