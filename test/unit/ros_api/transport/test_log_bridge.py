"""Each log record reaches the handlers as one line, whatever names it contains."""

import logging

import pytest

from rosbots_description.ros_api.transport.log_bridge import DuplicateFilter, RecordPreparation


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


def test_repeated_message_is_suppressed_until_it_is_forgotten(logger, caplog):
    duplicates = DuplicateFilter()
    logger.addFilter(duplicates)
    try:
        for name in ['torque', 'torque', 'legacyMode', *map(str, range(1000)), 'torque']:
            logger.warning('<%s> is not read', name)
    finally:
        logger.removeFilter(duplicates)
    assert caplog.messages[:2] == ['<torque> is not read', '<legacyMode> is not read']
    assert caplog.messages.count('<torque> is not read') == 2
