"""Nodes start without the fixed sleeps of rospy, and end without a master and without a trace."""

import threading
from types import SimpleNamespace
from unittest.mock import Mock

import pytest
import rospy.client
import rospy.impl.init
from rospy.impl import paramserver, registration, rosout
from rospy.msproxy import MasterProxy
from support.patience import PATIENCE

from rosbots_description.ros_api.transport import process


def test_node_start_does_not_sleep_once_registered(monkeypatch):
    init, slept = rospy.impl.init, []
    answers = iter((False, False, True))
    node = SimpleNamespace(uri='http://here', start=lambda: None)
    monkeypatch.setattr(init, 'init_tcpros', lambda _port: None)
    monkeypatch.setattr(init, '_set_caller_id', lambda _name: None)
    monkeypatch.setattr(
        init, 'ROSHandler', lambda *_: SimpleNamespace(_is_registered=lambda: next(answers))
    )
    monkeypatch.setattr(init.rosgraph.xmlrpc, 'XmlRpcNode', lambda *_, **__: node)
    monkeypatch.setattr(init, 'time', init.time)  # restored after the test
    process._begin_at_once()
    monkeypatch.setattr(process.time, 'sleep', slept.append)
    assert init.start_node({}, '/node', 'http://master') is node
    assert len(slept) == 2
    assert sum(slept) < 0.01  # [s]


def test_the_end_of_a_node_wakes_the_thread_of_its_registrations(monkeypatch):
    hooks, thread = [], SimpleNamespace(cond=threading.Condition())
    found = SimpleNamespace(listeners=[SimpleNamespace(), thread])
    monkeypatch.setattr(registration, 'get_registration_listeners', lambda: found)
    monkeypatch.setattr(rospy.core, 'add_shutdown_hook', hooks.append)
    process._end_at_once()
    with thread.cond:
        threading.Thread(target=hooks[0], args=('the end',), daemon=True).start()
        assert thread.cond.wait(PATIENCE)


def test_a_registration_that_no_master_takes_ends_with_the_node(monkeypatch):
    monkeypatch.setattr(registration, 'is_shutdown', registration.is_shutdown)
    monkeypatch.setattr(rospy.core, '_in_shutdown', True)  # but not shut down yet
    process._register_until_the_end()
    manager = registration.RegManager(None)
    manager.master_uri = manager.uri = 'http://localhost:1'
    register = threading.Thread(
        target=manager.reg_added,
        args=('/topic', 'std_msgs/Empty', registration.Registration.PUB),
        daemon=True,
    )
    register.start()
    register.join(PATIENCE)
    assert not register.is_alive()


@pytest.mark.parametrize(
    ('answer', 'value'), [((-1, 'not set', 0), False), ((1, '', True), True)], ids=str
)
def test_a_message_to_rosout_asks_the_master_nothing(monkeypatch, answer, value):
    master = MasterProxy('http://localhost:9')
    master.target = Mock(spec=['getParam'], getParam=Mock(return_value=answer))
    monkeypatch.setattr(rospy.client, '_param_server', master)
    monkeypatch.setattr(paramserver, '_param_server_cache', None)
    process._remember_parameter()
    ((_, name),) = (call.args for call in master.target.getParam.call_args_list)
    assert rospy.get_param_cached(name, False) is value
    # It is what rospy looks up, and that way.
    assert name in rosout._rosout.__code__.co_consts
    assert 'get_param_cached' in rosout._rosout.__code__.co_names
