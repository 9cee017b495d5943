"""Attempts of strangers, each by its own: at the door without the token, and inside with it.

Whoever is inside may command the simulator, but neither break the page of others nor fill the
memory. After each attempt the door opens with the token, and a browser inside sees the page as
before.
"""

import math
import re
import socket
import threading
from contextlib import suppress

import msgspec
import pytest
from support.browser import CAMERA, Browser
from support.patience import PATIENCE, wait_until
from support.window import FakeSimulator, serving
from websockets.exceptions import ConnectionClosed, InvalidHandshake

from rosbots_description.sim.description import SceneChange
from rosbots_description.web import Page
from rosbots_description.web.site import message_gate
from rosbots_description.web.site.message_gate import MOST_CLIENTS, MOST_EARLY
from rosbots_description.web.site.uploads import MAX_BYTES, OF_ONE

UPLOAD = 'Upload URDF, xacro or SDF'
SECRET = 'the-token-of-this-test'
KEY = 'Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: 13\r\n'
SOCKET = f'Upgrade: websocket\r\nConnection: Upgrade\r\n{KEY}'


@pytest.fixture(scope='module')
def served():
    """A page, and the simulator behind it."""
    simulator = FakeSimulator()
    with serving('127.0.0.1', SECRET) as site:
        yield site, simulator, Page(site, simulator)


@pytest.fixture
def door(served):
    """The site; when the attempt has been made, the token still leads in."""
    site, *_ = served
    yield site
    said = answer(site, request(f'/?token={SECRET}'))
    assert said.startswith(b'HTTP/1.1 303') and b'Set-Cookie' in said


@pytest.fixture
def site(served):
    """The window; when the attempt has been made, it works."""
    site, simulator, _ = served
    simulator.told.clear()
    yield site
    with Browser(site.address) as browser:

        def is_shown():
            if show := simulator.change:
                show(SceneChange(True))  # again: the page closes when the one before has left
            return (
                browser.control('Pause')
                and browser.control(UPLOAD)
                and browser.received('SetCameraPositionMessage')
            )

        browser.wait_until(is_shown)


@pytest.fixture
def browser(site, served):
    with Browser(site.address) as browser:
        browser.wait_until(lambda: served[1].change and browser.control(UPLOAD))
        yield browser


def answer(site, request):
    """Return all that is answered to the bytes of a request."""
    with socket.create_connection(('127.0.0.1', site.get_port()), timeout=PATIENCE) as connection:
        connection.sendall(
            request.encode('latin-1').replace(b'PORT', str(site.get_port()).encode())
        )
        if '\r\n\r\n' not in request:  # else it would wait for the rest of it
            connection.shutdown(socket.SHUT_WR)
        received = b''
        try:
            while b' 101 ' not in received[:20] and (part := connection.recv(65536)):
                received += part
        except ConnectionResetError:
            pass
        return received


def request(target='/', headers='', method='GET', host='127.0.0.1:PORT', version='HTTP/1.1'):
    return f'{method} {target} {version}\r\nHost: {host}\r\n{headers}\r\n'


TARGETS = [
    '/',
    '/index.html',
    '/?token',
    '/?token=',
    '/?token=x',
    '/?token=%00',
    '/?token=%FF',
    f'/?token={SECRET[:-1]}',
    f'/?token={SECRET}x',
    f'/?token={SECRET.upper()}',
    f'/?Token={SECRET}',
    f'/?token%20={SECRET}',
    f'/?token=%20{SECRET}',
    f'/?token[]={SECRET}',
    f'/#?token={SECRET}',
    f'/?a={SECRET}',
    f'/{SECRET}',
    f'/{SECRET}/',
    f'/token={SECRET}',
    '//',
    '///?token=x',
    '/..',
    '/../',
    '/%2e%2e/',
    '/..%2f',
    '/..%5c..%5c',
    '/....//',
    '/%00',
    '/.git/config',
    '/etc/passwd',
    '//etc/passwd',
    '/%2fetc%2fpasswd',
    '/static/../../site.py',
    '/rosbots_window',
    '/' + 'A' * 22,
    '/' + 'A' * 22 + '/',
    '/' + 'a/' * 2000,
    '/' + 'x' * 9000,
    'http://127.0.0.1/',
    f'http://evil.example/?token={SECRET[1:]}',
    '*',
    'evil.example:80',
    '/?token=x&token=y',
    '/?' + '&'.join(['token=x'] * 1000),
    '/?websocket=ws://evil.example',
    '/;token=x',
    '/?token=\u00e9',
]
HEADERS = [
    'Cookie: \r\n',
    'Cookie: rosbots_window_PORT=\r\n',
    'Cookie: rosbots_window_PORT=x\r\n',
    f'Cookie: rosbots_window_PORT={SECRET}\r\n',  # it is for a path that nobody knows
    f'Cookie: token={SECRET}\r\n',
    f'Cookie: rosbots_window_PORT="{SECRET}"\r\n',
    f'Authorization: Bearer {SECRET}\r\n',
    f'Authorization: token {SECRET}\r\n',
    f'X-Token: {SECRET}\r\n',
    f'Referer: http://127.0.0.1:PORT/?token={SECRET}\r\n',
    'Origin: null\r\n',
    'Origin: http://evil.example\r\n',
    'Origin: http://127.0.0.1:1\r\n',
    'Origin: http://127.0.0.1:PORT.evil.example\r\n',
    'Origin: file://\r\n',
    'Origin: http://[\r\n',
    'X-Forwarded-For: 127.0.0.1\r\n',
    'X-Forwarded-Host: localhost\r\n',
    'X-Original-URL: /?token=x\r\n',
    f'X-Rewrite-URL: /?token={SECRET}\r\n',
    'Transfer-Encoding: chunked\r\n',
    'Content-Length: 5\r\n',
    'Cookie: a[]=1; =;;\r\n',
    'Cookie: ' + 'a=b; ' * 1500 + '\r\n',
    'A: b\r\n' * 200,
    'X: ' + 'y' * 9000 + '\r\n',
    ' folded: x\r\n',
    'no colon\r\n',
    'Host: evil.example\r\n',
]
METHODS = ['POST', 'PUT', 'DELETE', 'OPTIONS', 'HEAD', 'TRACE', 'CONNECT', 'PATCH', 'get', 'X' * 99]


@pytest.mark.parametrize('target', TARGETS)
@pytest.mark.parametrize('headers', ['', SOCKET], ids=['page', 'socket'])
def test_no_target_without_the_token_leads_in(door, target, headers):
    said = answer(door, request(target, headers))
    outside(said)
    assert said.startswith(b'HTTP/1.1 4') or len(target) > 8000  # no line as long is read


@pytest.mark.parametrize('extra', HEADERS)
@pytest.mark.parametrize('headers', ['', SOCKET], ids=['page', 'socket'])
def test_no_header_replaces_the_token(door, extra, headers):
    outside(answer(door, request('/', headers + extra)))


@pytest.mark.parametrize('method', METHODS)
def test_no_other_method_leads_in(door, method):
    outside(answer(door, request('/', method=method)))
    # Not even with the token: there is nothing to put or to delete.
    said = answer(door, request(f'/?token={SECRET}', method=method))
    assert b'<html' not in said and b'HTTP/1.1 101' not in said


@pytest.mark.parametrize(
    'raw',
    [
        '',
        '\r\n',
        '\0' * 100,
        'GET',
        'GET / HTTP/1.1',
        'GET / HTTP/1.0\r\n\r\n',
        'GET /\r\n\r\n',
        'GET / HTTP/2.0\r\nHost: a\r\n\r\n',
        '\x16\x03\x01\x02\x00\x01',
        'PRI * HTTP/2.0\r\n\r\nSM',
        'GET  /  HTTP/1.1\r\n\r\n',
        'GET / HTTP/1.1\r\nHost: a\r\nHost: b\r\n\r\n',
        'x' * 100_000,
    ],
)
def test_what_is_no_request_leads_nowhere(door, raw):
    outside(answer(door, raw))


@pytest.mark.parametrize(
    'origin',
    [
        'http://evil.example',
        'null',
        'http://127.0.0.1',
        'file://',
        'https://127.0.0.1:PORT.evil.example',
        'chrome-extension://x',
    ],
)
def test_a_page_of_others_does_not_get_in_with_the_token(door, origin):
    outside(answer(door, request(f'/?token={SECRET}', f'{SOCKET}Origin: {origin}\r\n')))


def outside(said):
    """Check that an answer is no page, opens no socket and gives nothing away."""
    status = said.split(b'\r\n', 1)[0]
    assert b' 200' not in status
    assert b' 101' not in status
    assert b' 500' not in status
    assert b'<html' not in said
    assert SECRET.encode() not in said
    assert b'Set-Cookie' not in said
    assert b'Traceback' not in said


encode = msgspec.msgpack.encode


def message(kind, **fields):
    return encode({'type': kind, **fields})


def update(updates):
    return message('GuiUpdateMessage', uuid='x', updates=updates)


def picture(payload):
    return message('GetRenderResponseMessage', payload=payload, render_uuid='x')


MALFORMED = {
    'text': 'text',
    'empty': b'',
    'no msgpack': b'\xc1',
    'a number': encode(1),
    'a list': encode([1]),
    'no type': encode({}),
    'deep': b'\x91' * 100_000,
    'cut off': encode(CAMERA)[:-3],
    'unknown type': message('Nothing'),
    'class of python': message('object'),
    'base class': message('Message'),
    'share': message('ShareUrlRequest'),
    'script': message('RunJavascriptMessage', source='alert(1)'),
    'notification': message('NotificationShowMessage', uuid='x', props={}),
    'theme': message('ThemeConfigurationMessage'),
    'remove': message('RemoveSceneNodeMessage', name='/models'),
    'remove control': message('GuiRemoveMessage', uuid='x'),
    'background': message('BackgroundImageMessage'),
    'storage': message(
        'LocalStorageGetItemResponseMessage', value='x', error=None, request_uuid='x'
    ),
    'form': message('GuiFormDirtyMessage', uuid='x'),
    'camera without a field': encode(dict(list(CAMERA.items())[:-1])),
    'camera with another field': encode({**CAMERA, 'client': 1}),
    'camera of text': encode({**CAMERA, 'position': 'abc'}),
    'camera of two numbers': encode({**CAMERA, 'position': [1.0, 2.0]}),
    'camera of a thousand': encode({**CAMERA, 'wxyz': [1.0] * 1000}),
    'camera of nothing': encode({**CAMERA, 'look_at': None}),
    'camera in a camera': encode({**CAMERA, 'look_at': [CAMERA] * 3}),
    'width of text': encode({**CAMERA, 'image_width': '100'}),
    'click without a ray': message('SceneNodeClickMessage', name='/x'),
    'long name': message('TransformControlsDragStartMessage', name='x' * 5000, owner=''),
    'large message': update({'value': 'x' * 2_000_000}),
    'other properties': update({'removed': True}),
    'callbacks': update({'update_cb': []}),
    'no property': update({}),
    'two properties': update({'value': 1, 'sync_cb': None}),
    'picture that is none': picture(b'GIF89a'),
    'picture of text': picture('x'),
    'file for no button': message(
        'FileTransferStartUpload',
        source_component_uuid='x',
        transfer_uuid='x',
        filename='x',
        mime_type='',
        part_count=1,
        size_bytes=1,
    ),
}


@pytest.mark.parametrize('raw', MALFORMED.values(), ids=MALFORMED)
def test_who_sends_what_no_page_sends_is_disconnected(browser, raw):
    browser._connection.send(raw)
    with pytest.raises(ConnectionClosed) as closed:
        browser.wait_until(lambda: False)
    assert closed.value.rcvd.code == 1008


def test_a_message_larger_than_any_picture_ends_its_connection(browser):
    with pytest.raises(ConnectionClosed):
        for _ in range(2):
            browser._connection.send(b'x' * 30_000_000)
        browser.wait_until(lambda: False)


BAD = (math.nan, math.inf, -math.inf, 1e300)
CAMERAS = [
    *[{name: [bad, 0.0, 0.0]} for bad in BAD for name in ('position', 'look_at', 'up_direction')],
    *[{'wxyz': [bad, 0.0, 0.0, 0.0]} for bad in BAD],
    *[{name: bad} for bad in BAD for name in ('fov', 'near', 'far')],
    {'wxyz': [0.0] * 4},
    {'up_direction': [0.0] * 3},
    {'look_at': CAMERA['position']},
    {'fov': 0.0},
    {'fov': -1.0},
    {'fov': 4.0},
    {'near': 0.0},
    {'far': 0.001},
    {'image_height': 0},
    {'image_width': -1},
    {'image_width': 100_000},
    {'image_height': 2**63 - 1},
]


@pytest.mark.parametrize('change', CAMERAS, ids=str)
def test_a_camera_that_looks_nowhere_is_ignored(browser, site, change):
    browser.send({**CAMERA, **change})
    browser.wait_until(lambda: browser.noted('of this browser'))
    _, client = max(site.get_clients().items())  # the newest; before, it might not be listed yet
    assert all(map(math.isfinite, client.camera.position))
    browser.look_at([1.0, 2.0, 3.0])
    browser.wait_until(lambda: list(client.camera.look_at) == [1.0, 2.0, 3.0])


def test_of_many_refusals_the_first_is_told_and_the_number_of_others(browser):
    for _ in range(50):
        browser.send({**CAMERA, 'fov': 0.0})
    told = re.compile(r'(\d+) more notices? (is|are) left out')

    def counted():
        notes = browser.notes()
        return sum('of this browser' in note for note in notes) + sum(
            int(count[1]) for note in notes if (count := told.fullmatch(note))
        )

    browser.wait_until(lambda: counted() == 50)
    assert any(map(told.fullmatch, browser.notes()))


VALUES = [
    ('Steps', math.nan),
    ('Steps', math.inf),
    ('Steps', 0),
    ('Steps', -5),
    ('Steps', 10**9),
    ('Size [m]', [math.nan, 1.0, 1.0]),
    ('Size [m]', [1.0, math.inf, 1.0]),
    ('Duration [s]', -1.0),
    ('Speed', '100x'),
    ('Kind', 'sphere; rm'),
    ('Find', 'x' * 1001),
    ('Force per metre [N]', 0.0),
    ('Model path', '../../etc/passwd'),
    ('Light', '__proto__'),
]


@pytest.mark.parametrize(('label', 'value'), VALUES, ids=str)
def test_a_value_that_a_control_cannot_have_is_refused_in_a_sentence(browser, label, value):
    before = browser.value(label)
    browser.choose(label, value)
    browser.wait_until(lambda: browser.noted(f"'{label}'"))
    assert browser.value(label) == before


@pytest.mark.parametrize(
    ('label', 'value'),
    [
        ('Steps', 'many'),
        ('Steps', None),
        ('Steps', True),
        ('Steps', [1]),
        ('Steps', {}),
        ('Size [m]', 1.0),
        ('Size [m]', [1.0, 1.0]),
        ('Size [m]', ['a', 'b', 'c']),
        ('Static', 'yes'),
        ('Find', 5),
        ('Find', b'x'),
        (UPLOAD, True),
        (UPLOAD, {'name': 'x', 'content': b''}),
        ('Colour', [1]),
        ('Speed', 3),
        ('Pause', 'x'),
    ],
    ids=str,
)
def test_a_value_of_another_type_ends_the_connection(browser, label, value):
    browser.choose(label, value)
    with pytest.raises(ConnectionClosed):
        browser.wait_until(lambda: False)


def test_unfinished_files_are_few_and_go_with_their_browser(browser, site):
    for number in range(60):
        browser.begin_file(UPLOAD, str(number), MAX_BYTES, 2)
        browser.send_part(UPLOAD, str(number), 0, 500_000 * b'x')
    browser.wait_until(lambda: browser.noted('at once'))
    assert len(site._gate._uploads) <= OF_ONE
    browser._connection.close()
    wait_until(lambda: not len(site._gate._uploads), 'the end of the uploads')


@pytest.mark.parametrize(('count', 'size'), [(-1, 10), (10**9, 10), (2, -1), (1, 2**60)])
def test_a_file_of_impossible_size_is_not_begun(browser, site, count, size):
    browser.begin_file(UPLOAD, 'x', size, count)
    with suppress(ConnectionClosed):
        browser.wait_until(
            lambda: browser.noted("'x' has more than") or browser.noted('of this browser')
        )
    assert len(site._gate._uploads) == 0


@pytest.mark.parametrize('index', [-1, 2, 2**29, 0])
def test_a_part_that_is_none_ends_the_connection(browser, index):
    browser.begin_file(UPLOAD, 'x', 1000, 2)
    browser.send_part(UPLOAD, 'x')
    browser.send_part(UPLOAD, 'x', index)
    with pytest.raises(ConnectionClosed):
        browser.wait_until(lambda: False)


def test_parts_of_a_file_of_another_browser_are_ignored(browser, site, served):
    browser.begin_file(UPLOAD, 'mine', 2, 2)
    browser.send_part(UPLOAD, 'mine', 0, b'a')
    with Browser(site.address) as other:
        other.wait_until(lambda: other.control(UPLOAD))
        other.send_part(UPLOAD, 'mine', 1, b'!')
        other.choose('Steps', 5)  # after the part
        browser.wait_until(lambda: browser.value('Steps') == 5)
        other.choose('Steps', 1)
    browser.send_part(UPLOAD, 'mine', 1, b'b')
    browser.wait_until(lambda: served[1].done('insert'))
    ((_, text, *_),) = served[1].done('insert')
    assert text.xml == 'mine: ab'


def test_name_of_a_file_is_one_line_of_text(browser, served):
    browser.upload(UPLOAD, 'a\n\u202e\0' + 'x' * 900, b'x')
    browser.wait_until(lambda: served[1].done('insert'))
    ((_, text, *_),) = served[1].done('insert')
    name = text.xml.partition(':')[0]
    assert len(name) <= 300
    assert name.startswith('a \ufffd\ufffdxx')


def test_there_is_room_for_so_many_browsers(site):
    browsers = []
    try:
        with pytest.raises((ConnectionClosed, InvalidHandshake)):
            for _ in range(MOST_CLIENTS + 1):
                browsers.append(Browser(site.address))
                browsers[-1].wait_until(lambda: browsers[-1].messages)
        assert len(browsers) in (MOST_CLIENTS, MOST_CLIENTS + 1)
    finally:
        for browser in browsers:
            browser._connection.close()
    wait_until(lambda: not site._gate._visitors, 'the end of the connections')


def test_a_command_waits_while_many_others_do_and_is_not_lost(browser, site, served, monkeypatch):
    monkeypatch.setattr(message_gate, 'BACKLOG', 0)
    browser.wait_until(lambda: browser.control('Pause'))
    executor, begun, released = site._thread_executor, threading.Semaphore(0), threading.Event()

    def work():
        begun.release()
        released.wait()

    for _ in range(executor._max_workers + 1):  # the last one waits
        executor.submit(work)
    for _ in range(executor._max_workers):
        begun.acquire()
    browser.click('Pause')
    browser.read()
    assert ('pause',) not in served[1].told
    released.set()
    browser.wait_until(lambda: ('pause',) in served[1].told)


def test_a_flood_of_messages_is_slowed_down_and_the_page_answers_others(browser, site, served):
    for _ in range(8000):
        browser.look_at([1.0, 2.0, 3.0])
    with Browser(site.address) as other:
        other.click('Pause')
        other.wait_until(lambda: ('pause',) in served[1].told)


class Reconnected(Browser):
    """A browser that knows the page, and sends nothing before it is let."""

    def __init__(self, site, page):
        self.held = []
        super().__init__(site.address)
        self.controls, self.keys = page.controls, page.keys

    def send(self, message):
        self.held.append(message)

    def let(self):
        for message in self.held:
            super().send(message)


def test_what_is_done_in_the_first_moment_of_a_connection_is_not_lost(browser, site, served):
    released = threading.Event()
    with Reconnected(site, browser) as early:
        early.press('space')
        early.update(browser.control('Speed'), '10x')
        # The server reads all of it at once.
        site._websock_server._background_event_loop.call_soon_threadsafe(released.wait)
        early.let()
        released.set()
        early.wait_until(lambda: served[1].done('pause') and served[1].done('set_speed'))


def test_a_file_by_the_button_of_another_browser_ends_the_connection(browser, site, served):
    with Reconnected(site, browser) as other:
        other.upload(UPLOAD, 'foreign', b'x')
        with pytest.raises(ConnectionClosed) as closed:
            other.let()
            other.wait_until(lambda: False)
    assert closed.value.rcvd.reason == 'This is no button for files.'
    assert not served[1].done('insert')


def test_what_is_done_before_the_page_says_where_it_looks_is_done_after_that(browser, site, served):
    with Reconnected(site, browser) as early:
        camera = early.held.pop()
        early.press('space')
        early.click('Step')
        early.held.append(camera)
        early.let()
        early.wait_until(lambda: served[1].done('pause') and served[1].done('step'))


def test_what_is_done_without_ever_looking_is_not_kept_for_long(browser, site, served):
    with Reconnected(site, browser) as early:
        camera = early.held.pop()
        for _ in range(2 * MOST_EARLY):
            early.press('space')
        early.held.append(camera)
        early.click('Step')
        early.let()
        early.wait_until(lambda: served[1].done('step'))
    assert len(served[1].told) <= MOST_EARLY + 1
