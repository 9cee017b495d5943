"""Cameras take their images in the right steps, and none without a reader."""

import contextlib
import math
import os
import signal

import pytest
from support.cameras import camera_sdf, plugin_of, process_of, stamps
from support.patience import wait_until
from support.pictures import spawn_robot
from support.sensing import robot_text

from rosbots_description.sim.public.world import World


@pytest.mark.parametrize(
    ('old', 'new', 'times'),
    [
        ('>30</update_rate>', '>15</update_rate>', [67, 134, 200, 267]),
        ('<updateRate>0<', '<updateRate>10<', [100, 200, 300, 400]),
    ],
)
def test_image_rate_is_the_lesser_of_sensor_and_plugin(scene, old, new, times):
    found = []
    text = robot_text('camera_320', old, new)
    camera = next(iter(scene.spawn(text).sensors.values()))
    plugin_of(camera).outputs['image'].connect(lambda image: found.append(image.stamp_ns // 10**6))
    scene.run(seconds=0.41)
    assert found[:4] == times


def test_each_image_has_its_step_and_none_is_missing(scene):
    _, camera = spawn_robot(scene, 'camera_320')
    taken = stamps(camera)
    scene.run(seconds=1.0)
    assert [stamp for stamp, _ in taken] == [now for _, now in taken]
    assert [stamp // 1_000_000 for stamp, _ in taken] == [
        math.ceil(1000 * k / 30) for k in range(1, 31)
    ]


@pytest.mark.parametrize(
    ('robot', 'plugin', 'output'),
    [
        ('camera_320', 'triggered_camera', 'image'),
        ('multicamera', 'triggered_multicamera', 'right_image'),
    ],
)
def test_triggered_camera_takes_one_image_for_each_trigger(scene, robot, plugin, output):
    text = robot_text(robot, plugin.removeprefix('triggered_') + '.so', f'{plugin}.so')
    model = scene.spawn(text, 'm')
    camera = plugin_of(next(iter(model.sensors.values())))
    camera.trigger()  # nobody reads
    found = []
    camera.outputs[output].connect(lambda image: found.append(image.stamp_ns // 1_000_000))
    scene.run(seconds=0.1)
    for _ in range(2):
        camera.trigger()
    scene.run(seconds=0.05)
    camera.trigger()
    scene.run(seconds=0.2)
    assert found == [101, 151]


@pytest.mark.parametrize('rate', ['0', '-30', '5000'])
def test_rate_of_zero_or_above_that_of_the_steps_is_every_step(rate):
    with World.empty() as world:
        taken = stamps(world.spawn(camera_sdf(rate=rate)).sensor('s'))
        world.run(steps=5)
        assert [stamp // 1_000_000 for stamp, _ in taken] == [1, 2, 3, 4, 5]


def test_nothing_is_rendered_without_readers(scene):
    spawn_robot(scene, 'camera_320')
    scene.run(seconds=0.2)
    assert process_of(scene) is None


def test_paced_simulation_does_not_wait_for_images(scene):
    _, camera = spawn_robot(scene, 'camera_320')
    camera.read()
    taken = stamps(camera)
    scene.is_paced = True
    os.kill(process_of(scene), signal.SIGSTOP)
    scene.run(seconds=0.2)  # returns, though nothing is drawn
    assert taken == []
    os.kill(process_of(scene), signal.SIGCONT)
    wait_until(lambda: scene.run(steps=1) and taken, 'a picture')
    stamp, now = taken[0]
    assert stamp == 34_000_000  # when it was taken
    assert now > stamp


def test_pictures_left_out_are_reported_once_and_all_others_are_sent(scene, caplog, monkeypatch):
    _, camera = spawn_robot(scene, 'camera_320')
    camera.read()
    taken, requested = stamps(camera), []
    request = camera._capture.request
    monkeypatch.setattr(
        camera._capture,
        'request',
        lambda *arguments: (requested.append(scene.clock.now_ns), request(*arguments)),
    )
    scene.is_paced = True
    for _ in range(2):
        drawing = process_of(scene)
        os.kill(drawing, signal.SIGSTOP)
        scene.run(seconds=12.0)  # two windows, each of at least 5 s
        with contextlib.suppress(ProcessLookupError):  # it may have been replaced
            os.kill(drawing, signal.SIGCONT)
        wait_until(
            lambda: scene.run(steps=1) and [stamp for stamp, _ in taken] == requested,
            'all pictures that were requested',
        )
    (report,) = [r.message for r in caplog.records if 'pictures come at' in r.message]
    # The three that may be pending, in 5 s.
    assert 'pictures come at 0.6 of 30 Hz, as drawing them takes longer' in report
