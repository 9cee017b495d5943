"""What the page gives a browser to keep: world, picture, video, recording."""

import base64
import io
import re
import sys
import threading
import time
from functools import partial
from types import SimpleNamespace

import av
import msgspec
import numpy as np
import zstandard
from PIL import Image
from support.browser import Browser
from support.patience import wait_until
from support.window import clock, model

from rosbots_description.sim.core import Pose
from rosbots_description.sim.description import SceneChange
from rosbots_description.web.controls.layout import OPAQUE
from rosbots_description.web.panels.downloads import RecordButton
from rosbots_description.web.scene import recordings

SIZE = (100, 100)  # [pixels] of the browser's picture


def image(kind, colour):
    made = io.BytesIO()
    Image.new('RGB', SIZE, colour).save(made, kind)
    return made.getvalue()


def download(browser, file):
    browser.wait_until(lambda: (browser.download() or ('',))[0] == file)
    return browser.download()[1]


def test_the_world_is_downloaded_as_the_simulator_wrote_it(browser, simulator):
    simulator.save = lambda: ('<sdf/>', 'saved 3 models')
    browser.click('World')
    assert download(browser, 'saved.world') == b'<sdf/>'


def test_a_world_that_cannot_be_saved_is_told(browser, simulator):
    simulator.fault = 'the simulator does not answer'
    browser.click('World')
    browser.wait_until(lambda: browser.notes() == ['the simulator does not answer'])


def test_a_picture_has_the_size_and_the_colours_of_the_browser(browser):
    browser.click('Picture')
    browser.wait_until(partial(browser.answer_render, image('PNG', (200, 100, 50))))
    shown = Image.open(io.BytesIO(download(browser, 'picture.png')))
    assert (shown.size, shown.getpixel((5, 5))[:3]) == (SIZE, (200, 100, 50))


def test_a_video_has_the_frames_of_the_browser_in_their_time(browser):
    browser.click('Record a video')
    begin = time.monotonic()
    for colour in ('red', 'lime', 'blue'):
        browser.wait_until(partial(browser.answer_render, image('JPEG', colour)))
    browser.click('Stop the video')
    browser.wait_until(lambda: browser.answer_render(image('JPEG', 'blue')) or browser.download())
    with av.open(io.BytesIO(download(browser, 'video.mp4'))) as video:
        frames = list(video.decode(video=0))
    colours = [np.argmax(frame.to_ndarray(format='rgb24').mean(axis=(0, 1))) for frame in frames]
    assert colours == sorted(colours)
    assert {0, 1, 2} == set(colours)
    assert frames[0].time == 0.0
    assert 1.5 / recordings.RATE < frames[-1].time < time.monotonic() - begin
    browser.wait_until(lambda: browser.control('Record a video'))


def test_a_recording_plays_the_scene_without_a_server(browser, simulator):
    simulator.change(SceneChange(True, (model('a', 1),)))
    browser.click('Record a recording')
    browser.wait_until(lambda: browser.control('Stop the recording'))
    for moment in (0.0, 0.25, 1.5):
        place = [moment, 0.0, 2.0]
        simulator.motion(clock(real_time=7.0 + moment, _1=Pose(tuple(place))))
        browser.wait_until(lambda place=place: browser.nodes['/models/a/link'][1] == place)
    browser.click('Stop the recording')
    content = download(browser, 'recording.html').decode()
    assert content.index(OPAQUE) < content.index('</head>')
    recorded = scene_of(content)
    assert recorded['durationSeconds'] == 1.5
    places = [
        (moment, message['position'][0])
        for moment, message in recorded['messages']
        if message['type'] == 'SetPositionMessage' and message['name'] == '/models/a/link'
    ]
    assert places[-2:] == [(0.25, 0.25), (1.5, 1.5)]


def test_a_recording_has_boxes_and_overlays_of_its_browser_and_of_no_other(
    browser, simulator, page, site
):
    simulator.change(SceneChange(True, (model('a', 1), model('b', 2))))
    with Browser(site.address) as other:
        for one, name in ((browser, 'a'), (other, 'b')):
            one.choose('Only of what is selected', True)
            one.choose('Frames', True)
            one.click(name)
            one.wait_until(lambda one=one, name=name: f'/models/{name}/link/Frames' in one.nodes)
        browser.click('Record a recording')
        browser.wait_until(lambda: browser.control('Stop the recording'))
        other.choose('Joint axes', True)
        other.choose('Frames', False)
        other.wait_until(lambda: '/models/b/link/Frames' not in other.nodes)
        browser.press('V')  # whose camera moves now is not that of the recording
        simulator.motion(clock(real_time=1.0, _1=Pose((3.0, 0.0, 0.0))))
        browser.wait_until(lambda: browser.nodes['/models/a/link'][1] == [3.0, 0.0, 0.0])
        browser.click('Stop the recording')
        recorded = scene_of(download(browser, 'recording.html').decode())
    messages = [message for _, message in recorded['messages']]
    shown = {message['name'] for message in messages if 'props' in message and 'name' in message}
    assert {'/models/a/link/Frames', '/models/a/link/selected'} <= shown
    assert not [name for name in shown if name.startswith('/models/b/link/') and '0 v' not in name]
    assert '/gizmo' not in shown
    assert not [
        message
        for message in messages
        if message['type'] == 'SetCameraPositionMessage' and not message['initial']
    ]
    wait_until(lambda: len(site.get_clients()) == 1)
    (client,) = site.get_clients().values()
    assert client._websock_connection._record_handles == []


def test_a_recording_that_is_long_enough_ends_by_itself(browser, simulator, page, monkeypatch):
    monkeypatch.setattr(recordings, 'LONGEST', 2.0)
    browser.click('Record a recording')
    browser.wait_until(lambda: browser.control('Stop the recording'))
    simulator.motion(clock(1.0, real_time=1.0))
    browser.wait_until(lambda: browser.shows('00:00:01.000'))
    page.poll()
    assert browser.control('Stop the recording')
    simulator.motion(clock(real_time=3.5))
    browser.wait_until(lambda: page.poll() or browser.control('Record a recording'))
    assert scene_of(download(browser, 'recording.html').decode())['durationSeconds'] == 2.5
    assert 'The recording is as long as it can be, and ends.' in browser.notes()


def test_takes_end_with_their_browser(site, simulator, page):
    with Browser(site.address) as other:
        with Browser(site.address) as browser:
            browser.click('Record a recording')
            browser.click('Record a video')
            for label in ('Stop the recording', 'Stop the video'):
                other.wait_until(lambda label=label: other.control(label))
        for label in ('Record a recording', 'Record a video'):
            other.wait_until(lambda label=label: other.control(label))
        wait_until(lambda: site._websock_server._record_handles == [])
        assert other.notes() == []


def test_two_clicks_at_once_begin_one_take_and_end_it(site):
    begun, go_on, complaints = [], threading.Event(), []

    def make(_client):
        begun.append(SimpleNamespace(finish=lambda: b''))
        go_on.wait(60.0)
        return begun[-1]

    button = RecordButton(site.gui, 'video', 'video.mp4', '', make, complaints.append)
    clicks = [
        threading.Thread(target=button._click, args=(SimpleNamespace(client=1),)) for _ in range(2)
    ]
    for click in clicks:
        click.start()
    clicks[1].join(0.2)
    go_on.set()
    for click in clicks:
        click.join()
    assert (len(begun), len(complaints)) == (1, 1)  # there was no picture yet
    assert button._running is None


def test_without_pyav_the_page_says_so(browser, monkeypatch):
    monkeypatch.setitem(sys.modules, 'av', None)
    browser.click('Record a video')
    browser.wait_until(lambda: browser.noted("'av' is not installed"))


def scene_of(page):
    """Return what a recorded page plays."""
    content = base64.b64decode(re.search(r'__VISER_EMBED_DATA__="(.+?)"', page)[1])
    inner = zstandard.ZstdDecompressor().decompressobj().decompress(content[8:])
    length = int.from_bytes(inner[:8], 'little')
    return msgspec.msgpack.decode(inner[8 : 8 + length])
