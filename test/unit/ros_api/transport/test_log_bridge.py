"""What is logged reaches the handlers as a line that nobody's names can break."""

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


def test_a_name_cannot_begin_a_line_of_its_own(logger, caplog):
    logger.error('model [%s] does not exist', 'robot]\n[ERROR] [0.0]: all is lost')
    assert caplog.messages[0] == 'model [robot]\\n[ERROR] [0.0]: all is lost] does not exist'


def test_a_long_name_is_cut(logger, caplog):
    logger.error('%s', 'x' * 100_000)
    assert len(caplog.messages[0]) < 2000


def test_what_was_said_is_not_said_again_until_it_may_be_forgotten(logger, caplog):
    said = DuplicateFilter()
    logger.addFilter(said)
    try:
        for name in ['torque', 'torque', 'legacyMode', *map(str, range(1000)), 'torque']:
            logger.warning('<%s> is not read', name)
    finally:
        logger.removeFilter(said)
    assert caplog.messages[:2] == ['<torque> is not read', '<legacyMode> is not read']
    assert caplog.messages.count('<torque> is not read') == 2
