"""The thread that registers with the ROS master."""

import threading

import pytest
import rospy
from support.patience import PATIENCE, wait_until

from rosbots_description.ros_api.transport import registrar
from rosbots_description.ros_api.transport.master import AddressError
from rosbots_description.ros_api.transport.registrar import Registrar


def _stands_still(_name):
    raise AddressError('it has not answered')


@pytest.fixture
def slow(monkeypatch):
    """A registrar with a job that ends when the event does that is returned, too."""
    monkeypatch.setattr(registrar, 'PATIENCE', 0.001)
    may_end, slow = threading.Event(), Registrar()
    slow.post(may_end.wait)
    yield slow, may_end
    may_end.set()


def test_what_is_slow_is_awaited_while_a_master_answers(slow, monkeypatch, caplog):
    """A busy machine decides nothing."""
    looks = []

    def is_running(_name):
        looks.append(1)
        if len(looks) == 3:
            slow[1].set()
        return True

    monkeypatch.setattr(registrar, 'is_master_running', is_running)
    slow[0].await_registration('spawn')
    assert len(looks) >= 3
    assert caplog.text == ''


@pytest.mark.parametrize('is_running', [lambda _: False, _stands_still])
def test_without_a_master_nothing_is_awaited(slow, monkeypatch, caplog, is_running):
    monkeypatch.setattr(registrar, 'is_master_running', is_running)
    slow[0].await_registration('spawn')
    assert 'spawn: the ROS master has not registered all topics' in caplog.text


def test_what_hangs_is_not_awaited_for_ever(slow, monkeypatch, caplog):
    monkeypatch.setattr(registrar, 'LONGEST', 0.0)
    monkeypatch.setattr(registrar, 'is_master_running', lambda _: True)
    slow[0].await_registration('spawn')
    assert 'spawn: the ROS master has not registered all topics' in caplog.text


def threads():
    return [one for one in threading.enumerate() if one.name == 'registrar']


@pytest.mark.parametrize('ends', [True, False])
def test_a_failure_is_an_error_unless_the_node_ends(monkeypatch, caplog, ends):
    monkeypatch.setattr(rospy.core, 'is_shutdown_requested', lambda: ends)
    before = threads()
    one, failed = Registrar(), threading.Event()

    def fail():
        failed.set()
        raise rospy.ROSException('publish() to a closed topic')

    one.post(fail)
    assert failed.wait(PATIENCE)
    if ends:
        wait_until(lambda: threads() == before)
    else:
        assert one.wait(PATIENCE)
    assert ('registration with the ROS master failed' in caplog.text) is not ends
