"""Who looks at the window is told when the simulator goes, and when it is there again."""

import socket

import pytest

from rosbots_description.ros_api.clients import server_watch
from rosbots_description.ros_api.clients.server_watch import ServerWatch


@pytest.fixture
def place(monkeypatch):
    """Where the master says the simulator is; None is nowhere."""
    found = {'address': None}
    monkeypatch.setattr(server_watch, 'node_address', lambda *_: found['address'])
    return found


@pytest.fixture
def simulator(place):
    """Return a function that starts something that takes connections as the simulator does."""
    sockets = []

    def start():
        sockets.append(socket.create_server(('127.0.0.1', 0)))
        place['address'] = f'http://127.0.0.1:{sockets[-1].getsockname()[1]}/'
        return sockets[-1]

    yield start
    for opened in sockets:
        opened.close()


def test_before_there_is_a_simulator_nothing_is_told(place):
    told = []
    watch = ServerWatch(told.append)
    watch.poll()
    watch.poll()
    assert told == []


def test_the_end_of_the_simulator_and_the_next_one_are_told_once(place, simulator):
    told = []
    watch = ServerWatch(told.append)
    first = simulator()
    watch.poll()
    watch.poll()
    assert told == []
    first.close()  # killed: the master still names its address
    watch.poll()
    watch.poll()
    assert told == [False]
    place['address'] = None  # the master has forgotten it
    watch.poll()
    simulator()
    watch.poll()
    watch.poll()
    assert told == [False, True]


def test_a_simulator_that_is_replaced_has_not_gone(place, simulator):
    told = []
    watch = ServerWatch(told.append)
    first = simulator()
    watch.poll()
    simulator()
    first.close()
    watch.poll()
    assert told == []


def test_without_a_master_there_is_no_simulator(monkeypatch):
    monkeypatch.setenv('ROS_MASTER_URI', 'http://127.0.0.1:1')
    ServerWatch(pytest.fail).poll()
    assert server_watch.NOTICE == 'the simulator has gone'
