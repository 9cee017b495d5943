"""What the library logs can be held back."""

import logging

import pytest

from rosbots_description.sim.core import held_records, replay

LOGGER = logging.getLogger('rosbots_description.sim')


def test_what_is_held_goes_nowhere_until_it_is_replayed(caplog):
    with held_records() as records:
        LOGGER.debug('small')
        LOGGER.warning('large')
    assert [record.getMessage() for record in records] == ['small', 'large']
    assert caplog.messages == []
    replay(records)  # at the levels that are enabled
    assert caplog.messages == ['large']


def test_what_is_below_the_level_is_dropped(caplog):
    with held_records(logging.ERROR) as records:
        LOGGER.warning('large')
        LOGGER.error('wrong')
    assert [record.getMessage() for record in records] == ['wrong']
    assert caplog.messages == []


def test_logging_is_as_before_also_after_an_error(caplog):
    def fail():
        with held_records():
            raise RuntimeError

    with pytest.raises(RuntimeError):
        fail()
    LOGGER.warning('large')
    assert caplog.messages == ['large']
