"""Calls to a ROS master that is running, missing, or restarted."""

import socket
import threading
from http.server import BaseHTTPRequestHandler
from socketserver import BaseRequestHandler, TCPServer
from xmlrpc.server import SimpleXMLRPCRequestHandler, SimpleXMLRPCServer

import pytest
import rosgraph
import rospy
from support.serving import serving

from rosbots_description.ros_api.clients import spawn_model
from rosbots_description.ros_api.transport import master, registrations
from rosbots_description.ros_api.transport.master import (
    AddressError,
    is_master_running,
    require_address,
    retry_call,
    topics_of,
    use_simulated_time,
    write_parameters,
)


class FakeMaster(SimpleXMLRPCServer):
    """Answers the calls of these tests like a ROS master, and counts them."""

    def __init__(self):
        super().__init__(('localhost', 0), logRequests=False)
        self.arrived = 0
        self.parameters, self.services = {}, {}
        self.state = [], [], []
        self.register_multicall_functions()
        self.register_function(self._set_parameter, 'setParam')
        self.register_function(self._look_up, 'lookupService')
        self.register_function(lambda _, name: (1, '', name in self.parameters), 'hasParam')
        self.register_function(lambda _: (1, '', self.state), 'getSystemState')

    def _dispatch(self, method, arguments):
        self.arrived += method != 'setParam'
        return super()._dispatch(method, arguments)

    def _set_parameter(self, _caller, name, value):
        self.parameters[name] = value
        return 1, '', 0

    def _look_up(self, _caller, name):
        return (1, '', self.services[name]) if name in self.services else (-1, 'no provider', '')


@pytest.fixture
def there(monkeypatch):
    server = FakeMaster()
    with serving(server) as address:
        monkeypatch.setenv('ROS_MASTER_URI', address)
        yield server


@pytest.fixture(autouse=True)
def _no_pause(monkeypatch):
    monkeypatch.setattr(master.time, 'sleep', lambda _: None)


def test_parameters_are_set_in_one_call(there):
    write_parameters({'gravity_z': -9.8, 'sor_pgs_iters': 50, 'auto_disable_bodies': False})
    assert there.parameters == {
        '/unnamed/gravity_z': -9.8,
        '/unnamed/sor_pgs_iters': 50,
        '/unnamed/auto_disable_bodies': False,
    }
    assert there.arrived == 1


@pytest.mark.parametrize(('before', 'after'), [({}, True), ({'/use_sim_time': False}, False)])
def test_simulated_time_is_used_unless_the_user_has_decided(there, before, after):
    there.parameters.update(before)
    use_simulated_time('/gazebo_gui')
    assert there.parameters == {'/use_sim_time': after}


@pytest.mark.parametrize('address', ['http://localhost:9', 'foo'])
def test_simulated_time_can_wait_where_no_master_answers(monkeypatch, address):
    monkeypatch.setenv('ROS_MASTER_URI', address)
    use_simulated_time('/gazebo_gui')


def test_the_topics_of_a_node_are_those_that_it_publishes_or_reads(there):
    there.state = (
        [['/clock', ['/gazebo']], ['/odom', ['/other']]],
        [['/cmd_vel', ['/gazebo', '/other']]],
        [],
    )
    assert topics_of('/gazebo') == ['/clock', '/cmd_vel']


@pytest.mark.parametrize('address', ['', 'foo', 'http://', 'http://localhost:99999'])
def test_invalid_address_of_the_master_is_an_error_at_once(monkeypatch, capsys, address):
    monkeypatch.setenv('ROS_MASTER_URI', address)
    sentence = f"ROS_MASTER_URI is '{address}'; it must be the address of a ROS master"
    with pytest.raises(AddressError, match=sentence):
        require_address()
    assert spawn_model.run(None, []) == 1
    assert capsys.readouterr().err.startswith(f'spawn_model: {sentence}')


@pytest.mark.parametrize('address', ['http://localhost:11311', 'http://robot.local:11311/'])
def test_missing_master_at_a_valid_address_is_awaited(monkeypatch, address):
    monkeypatch.setenv('ROS_MASTER_URI', address)
    require_address()


class Stranger(BaseHTTPRequestHandler):
    """Answers like a server of web pages."""

    def do_POST(self):
        self.send_response(200)
        self.end_headers()
        self.wfile.write(b'<html>no</html>')

    def log_message(self, *_arguments):
        pass


class Banner(BaseRequestHandler):
    """Answers like a server of another protocol."""

    def handle(self):
        self.request.sendall(b'SSH-2.0-OpenSSH_9.2\r\n')
        self.request.recv(1000)


@pytest.mark.parametrize('handler', [Stranger, Banner, SimpleXMLRPCRequestHandler])
def test_what_is_not_a_master_is_an_error_of_each_program(monkeypatch, capsys, handler):
    kind = SimpleXMLRPCServer if handler is SimpleXMLRPCRequestHandler else TCPServer
    with serving(kind(('localhost', 0), handler)) as address:
        monkeypatch.setenv('ROS_MASTER_URI', address)
        with pytest.raises(AddressError, match='is not a ROS master'):
            is_master_running('/me')
        assert spawn_model.run(None, []) == 1
    (line,) = [line for line in capsys.readouterr().err.splitlines() if 'spawn_model' in line]
    assert 'is not a ROS master; roscore starts one' in line


def test_what_listens_and_is_silent_is_an_error_after_a_while(monkeypatch):
    monkeypatch.setattr(master, '_PATIENCE', 0.1)
    with socket.create_server(('localhost', 0)) as silent:
        monkeypatch.setenv('ROS_MASTER_URI', f'http://localhost:{silent.getsockname()[1]}')
        with pytest.raises(AddressError, match='has not answered for'):
            is_master_running('/me')


def test_master_that_is_absent_or_ending_is_not_running(monkeypatch, there):
    there.register_function(lambda _: (1, '', 'http://localhost'), 'getUri')
    assert is_master_running('/me')
    with socket.create_server(('localhost', 0)) as listening:
        monkeypatch.setenv('ROS_MASTER_URI', f'http://localhost:{listening.getsockname()[1]}')

        def hang_up():
            listening.accept()[0].close()

        thread = threading.Thread(target=hang_up, daemon=True)
        thread.start()
        assert not is_master_running('/me')
        thread.join()
    assert not is_master_running('/me')


def test_call_is_repeated_until_a_master_runs():
    faults = [ConnectionRefusedError(), TimeoutError()]

    def ask():
        if faults:
            raise faults.pop()
        return 'prefix'

    assert retry_call(ask) == 'prefix'
    assert not faults


def test_error_from_the_master_is_not_retried():
    def ask():
        raise rosgraph.MasterError('no such parameter')

    with pytest.raises(rosgraph.MasterError):
        retry_call(ask)


def test_shutdown_ends_the_wait_for_a_master(monkeypatch):
    monkeypatch.setattr(rospy, 'is_shutdown', lambda: True)
    with pytest.raises(rospy.ROSInterruptException):
        retry_call(lambda: pytest.fail('asked'))


def test_partly_registered_node_is_not_known_to_the_master(there):
    who = rosgraph.Master('/unnamed')
    there.services = {'/unnamed/some_service': 'rosrpc://localhost:1'}
    assert registrations._is_known(who) is False
    there.services['/unnamed/get_loggers'] = 'rosrpc://localhost:1'
    assert registrations._is_known(who) is True
