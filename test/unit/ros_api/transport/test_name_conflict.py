"""Node names in use: a running node is detected, a stale registration is not."""

import http.server
import os
import socket
from unittest import mock
from urllib.parse import urlsplit
from xmlrpc.server import SimpleXMLRPCServer

import pytest
import rospy
from support.serving import serving

from rosbots_description.ros_api.node import node
from rosbots_description.ros_api.transport import name_conflict, registrations
from rosbots_description.ros_api.transport.name_conflict import (
    NameTakenError,
    RunningNode,
    free_name,
    node_name,
    replacing_node,
    running_node,
)

NAME = '/gazebo'


@pytest.fixture
def master():
    """A fake ROS master, without any registrations of topics and services."""
    made = SimpleXMLRPCServer(('localhost', 0), logRequests=False)
    made.register_function(lambda _caller: (1, '', [[], [], []]), 'getSystemState')
    return made


@pytest.fixture
def registered(monkeypatch, master):
    """Return the nodes registered with the fake master: name -> URI."""
    nodes = {}
    master.register_function(
        lambda _caller, name: (1, '', nodes[name]) if name in nodes else (-1, 'unknown node', ''),
        'lookupNode',
    )
    with serving(master) as uri:
        monkeypatch.setenv('ROS_MASTER_URI', uri)
        yield nodes


@pytest.fixture
def living(registered):
    """Register a node that answers; return its URI."""
    server = SimpleXMLRPCServer(('localhost', 0), logRequests=False)
    server.register_function(lambda _caller: (1, '', os.getpid()), 'getPid')
    with serving(server) as uri:
        registered[NAME] = uri
        yield uri


def test_running_node_is_reported_with_its_process_and_host(living):
    assert running_node(NAME) == RunningNode(living, os.getpid())
    with pytest.raises(NameTakenError) as caught:
        free_name(NAME)
    message = str(caught.value)
    assert f'the node {NAME}, process {os.getpid()} on localhost ({living})' in message
    assert '--replace' in message


@pytest.mark.usefixtures('registered')
def test_unregistered_name_is_free():
    assert running_node(NAME) is None
    free_name(NAME)


def test_master_forgets_a_killed_node_and_nobody_else(registered, master):
    with socket.socket() as probe:
        probe.bind(('localhost', 0))
        uri = registered[NAME] = f'http://localhost:{probe.getsockname()[1]}/'
    both, other = [NAME, '/other'], ['/other']
    state = [[['/clock', both], ['/a', other]], [['/b', [NAME]]], [['/c', other], ['/d', [NAME]]]]
    left = []
    master.register_function(lambda _caller: (1, '', state), 'getSystemState')
    master.register_function(lambda _caller, name: (1, '', f'rosrpc:{name}'), 'lookupService')
    for call in ('unregisterPublisher', 'unregisterSubscriber', 'unregisterService'):
        master.register_function(lambda *told: left.append(told) or (1, '', 1), call)
    free_name(NAME)
    assert left == [(NAME, '/clock', uri), (NAME, '/b', uri), (NAME, '/d', 'rosrpc:/d')]


def test_port_reused_by_another_program_is_no_conflict(registered):
    server = http.server.HTTPServer(
        ('localhost', 0),
        type('Silent', (http.server.BaseHTTPRequestHandler,), {'log_message': lambda *_: None}),
    )
    with serving(server) as uri:
        registered[NAME] = uri
        assert running_node(NAME) is None
        free_name(NAME)


@pytest.mark.parametrize(
    ('changed', 'is_free'),
    [
        ({}, False),
        ({'getName': '/other'}, True),
        ({'getMasterUri': 'http://localhost:1'}, True),
        ({'getMasterUri': 'http://localhost:port'}, True),
        ({'getMasterUri': 5}, True),
    ],
    ids=str,
)
def test_port_reused_by_another_node_is_no_conflict(registered, changed, is_free):
    master = f'http://127.0.0.1:{urlsplit(os.environ["ROS_MASTER_URI"]).port}'
    answers = {'getName': NAME, 'getMasterUri': master, 'getPid': os.getpid()} | changed
    server = SimpleXMLRPCServer(('localhost', 0), logRequests=False)
    for call, answer in answers.items():
        server.register_function(lambda _caller, answer=answer: (1, '', answer), call)
    with serving(server) as uri:
        registered[NAME] = uri
        assert running_node(NAME) == (None if is_free else RunningNode(uri, os.getpid()))


def test_stopped_process_still_has_its_name(registered, monkeypatch):
    monkeypatch.setattr(name_conflict, 'TIMEOUT', 0.1)
    with socket.create_server(('localhost', 0)) as stopped:
        registered[NAME] = f'http://localhost:{stopped.getsockname()[1]}/'
        with pytest.raises(NameTakenError, match='a process that does not answer on localhost'):
            free_name(NAME)


def test_node_that_took_over_the_name_is_reported(living):
    assert replacing_node(NAME, 'http://localhost:1/') == RunningNode(living, os.getpid())
    assert replacing_node(NAME, living) is None


@pytest.fixture
def replaced(living, monkeypatch):
    """Be a node of the same name; return what is written when it registers again."""
    monkeypatch.setattr(rospy, 'get_name', lambda: NAME)
    monkeypatch.setattr(rospy, 'get_node_uri', lambda: 'http://localhost:2/')
    for name in ('get_registration_listeners', 'get_topic_manager'):
        monkeypatch.setattr(registrations, name, mock.MagicMock)
    services = {registrations._first_service(): 'rosrpc://localhost:2'}
    manager = mock.Mock(get_services=services.items)
    monkeypatch.setattr(registrations, 'get_service_manager', lambda: manager)
    return []


def test_replaced_node_does_not_take_its_name_back(replaced):
    registrations._register_again([lambda: replaced.append('parameter')])
    assert replaced == []


def test_stale_entry_of_a_new_master_does_not_keep_a_node_away(replaced, registered):
    registered[NAME] = 'http://localhost:1/'
    registrations._register_again([lambda: replaced.append('parameter')])
    assert replaced == ['parameter']


@pytest.mark.parametrize(
    ('arguments', 'namespace', 'name'),
    [
        ([], '', '/gazebo'),
        (['__name:=two', 'odom:=odometry'], '', '/two'),
        ([], '/lab', '/lab/gazebo'),
        (['__ns:=/other', '__name:=/two'], '/lab', '/other/two'),
    ],
)
def test_name_is_that_of_rospy(monkeypatch, arguments, namespace, name):
    monkeypatch.setenv('ROS_NAMESPACE', namespace)
    assert node_name('gazebo', arguments) == name


def test_without_a_master_there_is_a_warning_at_once_and_then_every_ten_seconds(
    monkeypatch, capsys
):
    now, warned = [0.0], []

    def sleep(seconds):
        now[0] += seconds
        warned.extend([now[0]] * capsys.readouterr().err.count('No ROS master'))

    monkeypatch.setenv('ROS_MASTER_URI', 'http://localhost:1')
    monkeypatch.setattr(node, 'is_master_running', lambda _name: now[0] > 25.0)
    monkeypatch.setattr(node.time, 'monotonic', lambda: now[0])
    monkeypatch.setattr(node.time, 'sleep', sleep)
    node._wait_for_master()
    assert warned == [node.MASTER_PERIOD, 10.0 + node.MASTER_PERIOD, 20.0 + node.MASTER_PERIOD]
