"""Parameters: how many runs, which values in each, and where they stand in a scenario."""

import numpy as np
import pytest

from rosbots_description.batch.parameters import MAX_RUNS, Parameters, substitute


def values(parameters, name):
    return [parameters.run(number).parameters[name] for number in range(parameters.runs)]


def test_grids_are_combined_and_the_last_changes_first():
    made = Parameters({'a': {'grid': [1, 2]}, 'b': {'grid': ['x', 'y', 'z']}, 'c': 5}, repeat=2)
    assert made.runs == 12
    assert values(made, 'a') == [1] * 6 + [2] * 6
    assert values(made, 'b') == ['x', 'x', 'y', 'y', 'z', 'z'] * 2
    assert values(made, 'c') == [5] * 12


def test_lists_go_together():
    made = Parameters({'a': {'list': [1, 2, 3]}, 'b': {'list': [4, 5, 6]}})
    assert list(zip(values(made, 'a'), values(made, 'b'), strict=True)) == [(1, 4), (2, 5), (3, 6)]


def test_random_values_depend_on_seed_run_and_name_only():
    spec = {'a': {'uniform': [0, 1]}, 'b': {'uniform': [0, 1]}}
    made, other = Parameters(spec, 3, 20), Parameters({'b': spec['b']}, 3, 10)
    assert len({*values(made, 'a'), *values(made, 'b')}) == 40
    assert values(other, 'b') == values(made, 'b')[:10]
    assert values(Parameters(spec, 4, 20), 'a') != values(made, 'a')


def test_distributions_have_their_mean_and_range():
    made = Parameters(
        {
            'u': {'uniform': [2, 4]},
            'n': {'normal': [10, 2]},
            'i': {'integers': [3, 6]},
            'c': {'choice': ['p', 'q']},
        },
        1,
        2000,
    )
    uniform, normal = np.array(values(made, 'u')), np.array(values(made, 'n'))
    assert uniform.min() >= 2.0
    assert uniform.max() <= 4.0
    assert uniform.mean() == pytest.approx(3.0, abs=0.06)  # 5 standard errors
    assert normal.mean() == pytest.approx(10.0, abs=0.23)
    assert normal.std() == pytest.approx(2.0, abs=0.16)
    assert set(values(made, 'i')) == {3, 4, 5}
    assert values(made, 'c').count('p') == pytest.approx(1000, abs=112)


def test_seeds_of_runs_differ():
    made = Parameters({}, 1, 1000)
    assert len({made.run(number).seed for number in range(1000)}) == 1000


@pytest.mark.parametrize(
    ('spec', 'kind'),
    [
        ({'grid': [1, 2.5]}, float),
        ({'grid': [1, 2]}, int),
        ({'choice': ['a', 1]}, str),
        ({'uniform': [0, 1]}, float),
        ({'integers': [0, 9]}, int),
        (True, bool),
        ('room', str),
    ],
)
def test_all_values_have_one_type(spec, kind):
    assert Parameters({'p': spec}).type_of('p') is kind


@pytest.mark.parametrize(
    ('spec', 'said'),
    [
        ({'grid': []}, "grid of the parameter 'p' takes a list of values"),
        ({'uniform': 3}, "uniform of the parameter 'p' takes a list of values"),
        ({'normal': [1, -2]}, "normal of the parameter 'p' takes mean, standard deviation"),
        ({'uniform': [1, 2, 3, 4]}, "uniform of the parameter 'p' takes low, high"),
        ({'gauss': [1, 2]}, "the parameter 'p' is of the kind 'gauss'; there are: grid, list"),
        ({'grid': [1], 'list': [2]}, "the parameter 'p' takes a number"),
        (float('nan'), "the parameter 'p' takes a number"),
        (2**70, "the parameter 'p' takes a number"),
        (None, "the parameter 'p' takes a number"),
    ],
)
def test_invalid_parameters_are_named(spec, said):
    with pytest.raises(ValueError, match=said):
        Parameters({'p': spec})


@pytest.mark.parametrize(
    ('arguments', 'said'),
    [
        (({'a b': 1},), "'a b' cannot be the name"),
        (([1],), 'a mapping from names'),
        (({}, -1), 'seed is -1'),
        (({}, 0, 0), 'repeat is 0'),
        (({}, 0, MAX_RUNS + 1), f'at most {MAX_RUNS}'),
        (({'a': {'list': [1]}, 'b': {'list': [1, 2]}},), 'of equal length; these are not: a, b'),
    ],
)
def test_invalid_sets_of_parameters_are_named(arguments, said):
    with pytest.raises(ValueError, match=said):
        Parameters(*arguments)


def test_a_whole_text_becomes_the_value_and_a_part_its_text():
    document = {'x': '$mu', 'file': 'robot_${mu}.urdf', 'price': '$$mu', 'list': [{'deep': '${n}'}]}
    assert substitute(document, {'mu': 0.5, 'n': True}) == {
        'x': 0.5,
        'file': 'robot_0.5.urdf',
        'price': '$mu',
        'list': [{'deep': True}],
    }


@pytest.mark.parametrize(
    ('text', 'said'),
    [
        ('$nu', "no parameter 'nu'; the parameters: mu"),
        ('a $nu', "no parameter 'nu'"),
        ('a $ b', 'without the name of a parameter'),
    ],
)
def test_a_name_that_is_no_parameter_is_named(text, said):
    with pytest.raises(ValueError, match=said):
        substitute(text, {'mu': 1})
