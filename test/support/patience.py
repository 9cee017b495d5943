"""Waiting for a condition: the deadline only ends a hopeless wait and decides no result."""

import time

PATIENCE = 60.0  # [s, wall] for what takes a moment, even on the busiest machine


def wait_until(condition, what='the condition', patience=PATIENCE):
    """Wait for a condition; `patience` [s, wall] is more for what takes longer than a moment."""
    end = time.monotonic() + patience
    while not condition():
        assert time.monotonic() < end, f'not within {patience:g} s: {what}'
        time.sleep(0.01)
