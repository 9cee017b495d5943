"""A rate limit: so many at once, and so many more in a second."""

import pytest

from rosbots_description.web.controls import rate_limit


def test_what_is_taken_comes_back_with_time_up_to_the_most(monkeypatch):
    now = [100.0]
    monkeypatch.setattr(rate_limit.time, 'monotonic', lambda: now[0])
    limit = rate_limit.RateLimit(3.0, 2.0)
    assert [limit.take() for _ in range(3)] == [0.0, 0.0, 0.0]
    assert not limit.has_one()
    assert [limit.take() for _ in range(2)] == [0.5, 1.0]  # two are owed, at 2 in a second
    now[0] += 1.4
    assert not limit.has_one()
    now[0] += 0.1
    assert limit.has_one()
    now[0] += 1000.0
    assert [limit.take() for _ in range(4)] == [0.0, 0.0, 0.0, pytest.approx(0.5)]
