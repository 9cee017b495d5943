"""Property tests: a damaged scenario is refused in a sentence, or its run is simulated."""

import pytest
from hypothesis import given
from support.batches import pushed_ball
from support.fuzzing import Fuzzer
from support.mutations import damaged_tree

SCENARIO = pushed_ball(
    world='empty',
    period=0.01,
    seed=3,
    repeat=2,
    record={
        'x': {'model': 'ball', 'value': 'pose.position.x'},
        'v': {'model': 'ball', 'link': 'ball', 'value': 'twist.linear.z'},
        'truth': {'topic': '/truth', 'value': 'pose.position.z'},
    },
    conditions=['x_end >= 0.0', 'v_min > -force - 10 and truth_mean < 6'],
    parameters={'force': {'grid': [1.0, 3.0]}, 'most': {'uniform': [0.0, 1.0]}},
)


@pytest.fixture(scope='module')
def fuzzer():
    with Fuzzer() as fuzzer:
        yield fuzzer
        fuzzer.require_both()


@given(damaged_tree(SCENARIO))
def test_damaged_scenario_is_refused_or_simulated(fuzzer, document):
    fuzzer.judge('scenario', document)
