"""Each log record reaches the handlers as one line, whatever names it contains."""

import logging
from dataclasses import replace

import pytest

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
