"""Another user of the machine reaches nothing of a batch on Ray: its ports, sockets and files."""

import json
import os
import tempfile
from pathlib import Path

import pytest
from support.listening import listening
from support.programs import ran

from rosbots_description.batch import cluster
from rosbots_description.cli.launched import descendants

pytest.importorskip('ray')
OTHER = 65534  # nobody
# Calls of Ray's servers: what harms nothing is made with the token, too, to see that it is there.
LOOKS = [
    'InternalKVGcsService/InternalKVKeys',
    'NodeInfoGcsService/GetAllNodeInfo',
    'JobInfoGcsService/GetAllJobInfo',
    'ActorInfoGcsService/GetAllActorInfo',
    'NodeManagerService/GetNodeStats',
    'ObjectManagerService/Pull',
    'CoreWorkerService/GetCoreWorkerStats',
]
HARM = [
    'InternalKVGcsService/InternalKVPut',
    'InternalKVGcsService/InternalKVDel',
    'JobInfoGcsService/AddJob',
    'ActorInfoGcsService/RegisterActor',
    'ActorInfoGcsService/CreateActor',
    'NodeInfoGcsService/UnregisterNode',
    'NodeManagerService/RequestWorkerLease',
    'NodeManagerService/ShutdownRaylet',
    'ObjectManagerService/Push',
    'ObjectManagerService/FreeObjects',
    'CoreWorkerService/PushTask',
    'CoreWorkerService/KillActor',
    'CoreWorkerService/Exit',
]
POSTS = [
    '/get_or_create_runtime_env',
    '/delete_runtime_env_if_possible',
    '/api/jobs/',
    '/api/version',
    '/',
]
# The other user's program: gRPC's HTTP/2 by hand, as their Python has no library for it.
STRANGER = r"""
import http.client, json, os, socket, struct, sys

DATA, HEADERS, RESET, SETTINGS, AWAY = 0, 1, 3, 4, 7
ENDS_STREAM, ENDS_HEADERS, ACKNOWLEDGES = 1, 4, 1

def frame(kind, flags, stream, content=b''):
    return struct.pack('>I', len(content))[1:] + struct.pack('>BBI', kind, flags, stream) + content

def text(value):
    return struct.pack('B', len(value)) + value.encode()

def answered(port, call, token):
    # Whether a call with an empty message brings a message back.
    fields = {':method': 'POST', ':scheme': 'http', ':path': '/ray.rpc.' + call,
              ':authority': 'ray', 'content-type': 'application/grpc', 'te': 'trailers'}
    if token:
        fields['authorization'] = 'Bearer ' + token
    headers = b''.join(b'\0' + text(name) + text(value) for name, value in fields.items())
    with socket.create_connection(('127.0.0.1', port), 60.0) as connection:
        connection.sendall(b'PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n' + frame(SETTINGS, 0, 0)
                           + frame(HEADERS, ENDS_HEADERS, 1, headers)
                           + frame(DATA, ENDS_STREAM, 1, bytes(5)))
        stream = connection.makefile('rb')
        while len(head := stream.read(9)) == 9:
            content = stream.read(int.from_bytes(head[:3], 'big'))
            kind, flags = head[3], head[4]
            if kind == DATA and content:
                return True
            if kind in (RESET, AWAY) or (kind == HEADERS and flags & ENDS_STREAM):
                return False
            if kind == SETTINGS and not flags & ACKNOWLEDGES:
                connection.sendall(frame(SETTINGS, ACKNOWLEDGES, 0))
    return False

def status(port, path, token):
    # What a request of HTTP/1.1 brings, 0 for no answer.
    connection = http.client.HTTPConnection('127.0.0.1', port, timeout=60.0)
    try:
        connection.request('POST', path, b'', {'Authorization': 'Bearer ' + token} if token else {})
        return connection.getresponse().status
    except (http.client.HTTPException, ConnectionError):
        return 0
    finally:
        connection.close()

def tried(act, *arguments):
    try:
        act(*arguments)
    except PermissionError:
        return False
    except FileExistsError:  # made by another way to it
        pass
    return True

def connect(path):
    with socket.socket(socket.AF_UNIX) as one:
        one.connect(path)

plan = json.load(sys.stdin)
found = []
for call, token in plan['calls']:
    for port in plan['ports']:
        try:
            if answered(port, call, token):
                found.append((call, token))
        except ConnectionError:
            pass
print(json.dumps({
    'calls': found,
    'posts': [status(port, path, token) for port in plan['ports'] for path in plan['posts']
              for token in ('', 'x')],
    'reached': [path for path in plan['sockets'] if tried(connect, path)]
    + [path for path in plan['folders'] if tried(os.listdir, path)]
    + [path for path in plan['folders'] if tried(os.mkdir, path + '/made')]}))
"""


@pytest.fixture(name='place')
def fixture_place(tmp_path_factory, monkeypatch):
    """Return a folder for temporary files that is everybody's, as /tmp is."""
    tmp_path_factory.getbasetemp()  # which is elsewhere
    with tempfile.TemporaryDirectory(prefix='t', dir='/tmp') as place:  # short: for Ray's sockets
        os.chmod(place, 0o1777)
        monkeypatch.setattr(tempfile, 'tempdir', place)
        monkeypatch.setenv('TMPDIR', place)
        yield Path(place)


@pytest.mark.skipif(os.getuid() != 0, reason='only root can try what another user can do')
def test_another_user_reaches_nothing_of_a_batch(place):
    with cluster._connected(1, None) as ray:
        cluster._require_worker(ray)
        family = [os.getpid(), *descendants(os.getpid())]
        token, inside = os.environ['RAY_AUTH_TOKEN'], list(place.rglob('*'))
        plan = {
            'ports': sorted(port for _, port in listening(family)),
            'calls': [
                *[(call, by) for call in LOOKS + HARM for by in ('', 'x', token[:-1])],
                *[(call, token) for call in LOOKS],
            ],
            'posts': POSTS,
            'sockets': [str(path) for path in inside if path.is_socket()],
            'folders': [str(path) for path in inside if path.is_dir()],
        }
        ended = ran(
            *('/usr/bin/python3', '-I', '-c', STRANGER),
            timeout=None,
            input=json.dumps(plan),
            user=OTHER,
            group=OTHER,
            extra_groups=[],
            cwd='/',
        )
        assert ended.returncode == 0, ended.stderr
        said = json.loads(ended.stdout)
        lines = b''.join(Path(f'/proc/{one}/cmdline').read_bytes() for one in family)
        cluster._require_worker(ray)  # nothing has been ended
    assert token.encode() not in lines
    assert b'monitor.py' not in lines
    assert b'dashboard.py' not in lines
    assert plan['sockets']
    # Those with the token are answered, so it is calls of Ray that are refused without it.
    assert {tuple(call) for call in said['calls']} == {(call, token) for call in LOOKS}
    assert {401, 403} <= set(said['posts']) <= {0, 400, 401, 403}
    assert said['reached'] == []
