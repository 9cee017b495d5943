"""Rows that have come are written, whatever ends a batch."""

import sys

import pytest

from rosbots_description.batch.runner import _collect


class FakeTable:
    """Notes when rows are written."""

    def __init__(self, events):
        self.rows, self._events = {}, events

    def add(self, row):
        self.rows[row['run']] = row

    def flush(self):
        self._events.append(f'{len(self.rows)} written')


def test_rows_are_written_before_ray_is_shut_down_which_may_end_the_process():
    events = []

    def rows():
        try:
            for number in range(5):
                yield {'run': number}, 0
        finally:
            events.append('shut down')

    def interrupt(count, _total, _repeated):
        if count == 3:
            sys.exit(143)

    with pytest.raises(SystemExit):
        _collect(FakeTable(events), rows(), 5, interrupt)
    assert events == ['3 written', 'shut down']
