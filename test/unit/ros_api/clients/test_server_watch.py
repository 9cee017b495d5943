"""The window shows a notice when the simulator ends, and removes it when it is back."""

import socket

import pytest

from rosbots_description.ros_api.clients import server_watch
from rosbots_description.ros_api.clients.server_watch import ServerWatch


@pytest.fixture
def place(monkeypatch):
    """Return the address of the simulator in the master's registry; None: not registered."""
    found = {'address': None}
    monkeypatch.setattr(server_watch, 'node_address', lambda *_: found['address'])
    return found


@pytest.fixture
def simulator(place):
    """Return a function that starts a listener for connections, like the simulator."""
    sockets = []

    def start():
        sockets.append(socket.create_server(('127.0.0.1', 0)))
        place['address'] = f'http://127.0.0.1:{sockets[-1].getsockname()[1]}/'
        return sockets[-1]

    yield start
    for opened in sockets:
        opened.close()


def test_no_notice_before_the_first_simulator(place):
    notices = []
    watch = ServerWatch(notices.append)
    watch.poll()
    watch.poll()
    assert notices == []


def test_end_and_return_of_the_simulator_are_notified_once(place, simulator):
    notices = []
    watch = ServerWatch(notices.append)
    first = simulator()
    watch.poll()
    watch.poll()
    assert notices == []
    first.close()  # killed: still registered with the master
    watch.poll()
    watch.poll()
    assert notices == [False]
    place['address'] = None  # no longer registered
    watch.poll()
    simulator()
    watch.poll()
    watch.poll()
    assert notices == [False, True]


def test_replaced_simulator_gives_no_notice(place, simulator):
    notices = []
    watch = ServerWatch(notices.append)
    first = simulator()
    watch.poll()
    simulator()
    first.close()
    watch.poll()
    assert notices == []


def test_no_simulator_without_a_master(monkeypatch):
    monkeypatch.setenv('ROS_MASTER_URI', 'http://127.0.0.1:1')
    ServerWatch(pytest.fail).poll()
