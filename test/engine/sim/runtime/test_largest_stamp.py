"""Simulated time ends at the largest stamp, 2^32 s."""

from dataclasses import replace

import pytest
from rosbots_msgs.srv import StepRequest
from support.bench import Bench


def test_simulation_pauses_at_the_largest_stamp_until_a_reset(world, caplog):
    world.clock.steps = 1000 * 2**32 - 5
    assert world.run(3) == 3
    assert not world.paused
    assert world.run(100) == 1
    assert world.clock.now_ns == 2**32 * 10**9 - 10**6
    assert world.paused
    (error_message,) = caplog.messages
    assert 'paused at 4294967296 s: stamps of 32 bits end there' in error_message
    assert world.run(1) == 0
    world.reset_simulation()
    assert world.run(10) == 10
    assert world.clock.now_ns == 10**7


def test_single_steps_end_at_the_largest_stamp_and_report_their_number(world):
    world.paused = True
    world.clock.steps = 1000 * 2**32 - 31
    answer = Bench(world).call('step', StepRequest(50))
    assert not answer.success
    assert 'simulated time ended after 30 steps' in answer.status_message
    assert answer.sim_time == pytest.approx(2**32 - 0.001, abs=1e-6)


def test_step_beyond_the_largest_stamp_is_not_made(world):
    world.clock.steps = 1000 * 2**32 - 5
    world.set_physics(replace(world.physics, step_size=10.0))
    assert world.run(1) == 0
    assert world.clock.now_ns < 2**32 * 10**9
