"""Scenario files: what is valid, and what is said of what is not."""

import pytest
from support.batches import pushed_ball

from rosbots_description.batch import ScenarioError, ScenarioFile


def test_parameters_stand_anywhere():
    file = ScenarioFile(
        pushed_ball(
            world='$world',
            models=[{'name': 'a', 'file': 'f_$size.urdf', 'pose': {'x': '$force'}}],
            parameters={'force': 2, 'world': 'room', 'size': 'big'},
        )
    )
    scenario = file.scenario(file.parameters.run(0))
    assert (scenario.world, scenario.models[0].file) == ('room', 'f_big.urdf')
    assert scenario.models[0].pose.pose().position == (2.0, 0.0, 0.0)


def test_xacro_reads_booleans_in_its_own_spelling():
    file = ScenarioFile(
        pushed_ball(
            models=[{'name': 'a', 'file': 'f', 'arguments': {'laser': True, 'mu': 0.5}}],
            commands=[],
            record={},
            conditions=[],
        )
    )
    (model,) = file.scenario(file.parameters.run(0)).models
    assert model.xacro_arguments() == {'laser': 'true', 'mu': '0.5'}


@pytest.mark.parametrize(
    ('changes', 'said'),
    [
        ({'duration': -1.0}, 'duration: Expected `float` > 0.0'),
        ({'duration': float('inf')}, 'duration and period take finite numbers'),
        ({'modles': []}, 'Object contains unknown field `modles`'),
        (
            {'models': [{'name': 'a', 'pose': {'x': 'far'}, 'text': 'b'}]},
            r'models\[0\].pose.x: Expected `float`, got `str`',
        ),
        ({'models': [{'name': 'a'}]}, "model 'a' takes either file or text"),
        ({'record': {'x': {'value': 'range'}}}, "record 'x' takes either topic or model"),
        ({'record': {'x': {'model': 'ball'}}}, "record 'x' needs a value"),
        ({'record': {'x': {'topic': 't', 'joint': 'j'}}}, "record 'x' takes link or joint"),
        ({'record': {'a-b': {'topic': 't'}}}, "'a-b' cannot be the name of a record"),
        ({'conditions': ['z_end > 1']}, "'z_end', which is neither recorded nor a parameter"),
        (
            {'commands': [{'at': 7.0, 'topic': 't'}]},
            r'commands\[0\] is at 7 s; the run ends at 1 s',
        ),
        ({'commands': [{'at': 0.5, 'topic': 't', 'message': 3}]}, r'commands\[0\].message'),
        (
            {'parameters': {'force': 1.0, 'x_end': 2.0}},
            "the parameter 'x_end' has the name of a col",
        ),
        ({'parameters': {}}, "there is no parameter 'force'; the parameters: none"),
        ({'parameters': {'force': {'grid': 3}}}, "grid of the parameter 'force'"),
        ({'repeat': 0}, 'repeat is 0'),
    ],
)
def test_what_is_wrong_is_said_with_its_place(changes, said):
    with pytest.raises(ScenarioError, match=said):
        ScenarioFile(pushed_ball(**changes))


@pytest.mark.parametrize(
    ('text', 'said'),
    [
        ('duration: [1', 'is not YAML: '),
        ('- 1', 'is not a scenario; a scenario is a YAML mapping'),
        ('duration: fast', 'duration: Expected `float`, got `str`'),
        (b'\xff\xfe\x00', 'read'),
    ],
)
def test_a_file_that_is_no_scenario_is_named(tmp_path, text, said):
    path = tmp_path / 'bad.yaml'
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    with pytest.raises(ScenarioError, match=rf'bad.yaml.*{said}'):
        ScenarioFile.read(path)


def test_an_absent_file_is_named(tmp_path):
    with pytest.raises(ScenarioError, match=r'nowhere.yaml cannot be read: .*No such file'):
        ScenarioFile.read(tmp_path / 'nowhere.yaml')


def test_given_parameters_replace_those_of_the_file(tmp_path):
    path = tmp_path / 'a.yaml'
    path.write_text('duration: 1.0\nparameters: {a: {grid: [1, 2, 3]}, b: 7}\n')
    file = ScenarioFile.read(path, {'a': {'grid': [5, 6]}})
    assert file.parameters.runs == 2
    assert file.parameters.run(1).parameters == {'a': 6, 'b': 7}


def test_fingerprint_differs_with_whatever_changes_rows():
    scenarios = [
        pushed_ball(),
        pushed_ball(duration=2.0),
        pushed_ball(seed=1),
        pushed_ball(repeat=2),
        pushed_ball(parameters={'force': 1.0}),
    ]
    assert len({ScenarioFile(scenario).fingerprint for scenario in scenarios}) == 5
    assert ScenarioFile(pushed_ball()).fingerprint == ScenarioFile(pushed_ball()).fingerprint
