"""Each log record reaches the handlers as one line, whatever names it contains."""

import logging
from dataclasses import replace
from unittest.mock import Mock

import pytest
import rospy
import rospy.client
from rospy.impl import paramserver, rosout
from rospy.msproxy import MasterProxy

from rosbots_description.ros_api.transport import log_bridge
from rosbots_description.ros_api.transport.log_bridge import FaultLog, RecordPreparation
from rosbots_description.sim.core import Fault


@pytest.fixture
def logger():
    made = logging.getLogger('test_log_bridge')
    handler = RecordPreparation(lambda: 2_500_000_000)
    made.addHandler(handler)
    yield made
    made.removeHandler(handler)


def test_name_cannot_start_a_new_line(logger, caplog):
    logger.error('model [%s] does not exist', 'robot]\n[ERROR] [0.0]: all is lost')
    assert caplog.messages[0] == 'model [robot]\\n[ERROR] [0.0]: all is lost] does not exist'


def test_a_long_name_is_cut(logger, caplog):
    logger.error('%s', 'x' * 100_000)
    assert len(caplog.messages[0]) < 2000


def test_a_warning_of_a_plugin_is_logged_once_until_it_is_forgotten(caplog):
    log = FaultLog()
    for name in ['torque', 'torque', 'legacyMode', *map(str, range(1000)), 'torque']:
        log(Fault(f'<{name}> is not read', element="plugin 'drive'"))
    assert caplog.messages[:2] == ['<torque> is not read', '<legacyMode> is not read']
    assert caplog.messages.count('<torque> is not read') == 2


def test_a_level_is_set_by_its_name_in_any_case_and_another_name_is_ignored():
    package = logging.getLogger('rosbots_description')
    before = package.level
    try:
        for name in ('Debug', 'warn', 'FATAL', 'na'):
            log_bridge.set_level(name)
            assert package.level == {
                'Debug': logging.DEBUG,
                'warn': logging.WARNING,
            }.get(name, logging.CRITICAL)
    finally:
        package.setLevel(before)


@pytest.mark.parametrize('where', [{'severity': logging.ERROR}, {'element': "joint 'j'"}])
def test_other_faults_are_logged_each_time(caplog, where):
    log, fault = FaultLog(), replace(Fault('bad', element="plugin 'drive'"), **where)
    log(fault)
    log(fault)
    assert caplog.messages == ['bad', 'bad']


@pytest.mark.parametrize(('answer', 'value'), [({}, False), (True, True)])  # {}: it is not set
def test_a_message_to_rosout_asks_the_master_nothing(monkeypatch, answer, value):
    master = MasterProxy('http://localhost:9')
    master.target = Mock(subscribeParam=Mock(return_value=(1, '', answer)))
    monkeypatch.setattr(rospy.client, '_param_server', master)
    monkeypatch.setattr(paramserver, '_param_server_cache', None)
    log_bridge._remember_parameter()
    asked = master.target.subscribeParam
    ((_, _, name),) = (call.args for call in asked.call_args_list)
    assert rospy.get_param_cached(name, False) is value
    asked.assert_called_once()
    # It is what rospy looks up, and that way.
    assert name in rosout._rosout.__code__.co_consts
    assert 'get_param_cached' in rosout._rosout.__code__.co_names
