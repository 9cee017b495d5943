"""Runs in this process: what is simulated, recorded and judged, and what is said of bad input."""

import pytest
from support import ROOT
from support.batches import BALL, FLOATING, MASS, full_disk, only_row, pushed_ball

from rosbots_description.batch import ScenarioError, run

BOX_OF_MESH = f"""<robot name="b"><link name="l"><inertial><mass value="1"/>
<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial><collision><geometry>
<mesh filename="file://{ROOT}/meshes/wheel.dae"/></geometry></collision></link></robot>"""
EXAMPLE = ROOT / 'config' / 'scenarios' / 'drive.yaml'


@pytest.fixture(autouse=True)
def package_path(monkeypatch):
    monkeypatch.setenv('ROS_PACKAGE_PATH', str(ROOT))


@pytest.fixture
def floating(tmp_path):
    path = tmp_path / 'floating.world'
    path.write_text(FLOATING, encoding='utf-8')
    return str(path)


@pytest.fixture
def policy(tmp_path):
    """Return a function that writes the body of a policy to a file, and returns its address."""

    def write(*lines):
        path = tmp_path / 'policy.py'
        body = '\n'.join(f'        {line}' for line in lines)
        path.write_text(f'def make(run):\n    def act(time, readings):\n{body}\n    return act\n')
        return f'{path}:make'

    return write


def test_a_pushed_ball_moves_as_newton_says():
    row = only_row(pushed_ball())
    assert row['x_end'] == pytest.approx(3.0 / MASS / 2.0, rel=2e-3)  # F t^2 / 2 m
    assert row['x_max'] == row['x_end']
    assert row['x_min'] == 0.0
    assert (row['outcome'], row['reason'], row['force']) == ('passed', '', 3.0)
    assert row['faults'] == []


def test_a_condition_that_does_not_hold_fails_the_run_with_its_values():
    row = only_row(pushed_ball(), force=1.0)
    assert row['outcome'] == 'failed'
    assert row['reason'].startswith("'x_end > 0.5' does not hold: x_end = 0.25")


def test_a_parameter_in_a_condition_has_the_value_of_the_run():
    scenario = pushed_ball(
        conditions=['x_end > $least'], parameters={'force': 3.0, 'least': {'grid': [0.5, 1.0]}}
    )
    rows = run(scenario, workers=0).table.to_pylist()
    assert [row['outcome'] for row in rows] == ['passed', 'failed']
    assert rows[1]['reason'].startswith("'x_end > 1.0' does not hold: x_end = 0.7")


def test_commands_come_at_their_times(floating):
    push = {'topic': 'push', 'message': {'force': {'x': 2.0}}}
    row = only_row(
        pushed_ball(
            world=floating,
            commands=[{'at': 0.75, 'topic': 'push'}, {'at': 0.25, **push}],
            record={'v': {'model': 'ball', 'link': 'ball', 'value': 'twist.linear.x'}},
            conditions=[],
        )
    )
    assert row['v_end'] == pytest.approx(2.0 / MASS * 0.5, rel=1e-6)


def test_readings_of_a_topic_are_recorded_at_its_rate():
    record = {'truth': {'topic': 'truth', 'value': 'pose.position.x'}}
    row = only_row(pushed_ball(record=record, conditions=[]))
    times = [0.1 * index for index in range(1, 11)]
    expected = sum(3.0 / MASS * time**2 / 2.0 for time in times) / len(times)
    assert row['truth_mean'] == pytest.approx(expected, rel=0.01)


def test_a_policy_acts_each_period_on_what_is_recorded(policy, floating):
    acts = policy(
        "assert time < 0.2 or readings['truth'].pose.position[0] > 0.0",
        "return {'push': {'force': {'x': 4.0 - 10.0 * readings['v']}}}",
    )
    row = only_row(
        pushed_ball(
            world=floating,
            policy=acts,
            commands=[],
            period=0.01,
            duration=3.0,
            record={
                'v': {'model': 'ball', 'value': 'twist.linear.x'},
                'truth': {'topic': '/truth'},
            },
            conditions=['abs(v_end - 0.4) < 1e-4'],
        )
    )
    assert (row['outcome'], row['reason']) == ('passed', '')


def test_time_begins_at_0_in_a_saved_world_and_a_short_period_is_a_step(policy, tmp_path):
    saved = tmp_path / 'saved.world'
    saved.write_text(
        FLOATING.replace(
            '</world>', '<state world_name="default"><sim_time>5 0</sim_time></state></world>'
        )
    )
    push = policy("return {'push': {'force': {'x': 2.0 if 0.25 <= time < 0.75 else 0.0}}}")
    row = only_row(
        pushed_ball(
            world=str(saved),
            policy=push,
            commands=[],
            period=0.0004,
            conditions=[],
            record={'v': {'model': 'ball', 'value': 'twist.linear.x'}},
        )
    )
    assert row['reason'] == ''
    assert row['v_end'] == pytest.approx(2.0 / MASS * 0.5, rel=1e-6)


def test_a_random_run_is_the_same_each_time_it_is_made():
    noisy = pushed_ball(parameters={'force': {'uniform': [1.0, 3.0]}}, repeat=2, seed=5)
    first, second = (run(noisy, workers=0).table for _ in range(2))
    assert first.equals(second)
    assert len(set(first.column('x_end').to_pylist())) == 2


def test_the_example_passes_where_the_tyres_grip():
    result = run(EXAMPLE, {'world': 'empty'}, workers=0)
    assert result.table.num_rows == 6
    for row in result.table.to_pylist():
        assert row['outcome'] == ('passed' if row['friction'] == 1.0 else 'failed'), row['reason']


def test_no_message_of_the_library_reaches_the_console(capfd):
    only_row(pushed_ball(models=[{'name': 'ball', 'text': '<robot name="r"/>'}]))
    assert capfd.readouterr() == ('', '')


@pytest.mark.parametrize(
    ('changes', 'said'),
    [
        (
            {'commands': [{'at': 0.0, 'topic': 'puhs', 'message': {}}]},
            "commands[0]: no plugin takes commands on the topic 'puhs'; did you mean '/push'?",
        ),
        (
            {'record': {'x': {'topic': 'lie', 'value': 'range'}}, 'conditions': []},
            "record 'x': no plugin sends on the topic 'lie'",
        ),
        (
            {'record': {'x': {'model': 'bell', 'value': 'pose.position.x'}}},
            "record 'x': there is no model 'bell' in this world; its models: ground_plane, ball",
        ),
        (
            {'record': {'x': {'model': 'ball', 'joint': 'j', 'value': 'position'}}},
            "record 'x': model 'ball' has no joint 'j'",
        ),
        (
            {'record': {'x': {'topic': 'truth', 'value': 'pose.z'}}},
            "record 'x': 'pose.z' is not in a Odometry: there is no 'z' in it",
        ),
        (
            {'commands': [{'at': 0.1, 'topic': 'push', 'message': {'force': {'x': float('nan')}}}]},
            'commands[0]: force.x is nan; numbers must be finite',
        ),
        ({'world': 'nowhere.world'}, 'nowhere.world'),
        ({'models': [{'name': 'ball', 'file': 'nowhere.urdf'}]}, 'nowhere.urdf'),
        ({'models': [{'name': 'ball', 'text': '<robot name="r"/>'}]}, 'link'),
        (
            {'policy': 'nowhere.py:make'},
            "the policy 'nowhere.py:make' cannot be loaded: FileNotFound",
        ),
        ({'policy': 'math:make'}, "cannot be loaded: math has no function 'make'"),
        (
            {'policy': 'make'},
            "'make' is not a policy; it takes module:function or file.py:function",
        ),
        ({'policy': 'builtins:abs'}, "the policy 'builtins:abs' raised TypeError: bad operand"),
        ({'conditions': ['1 / (x_min - x_min) > 1']}, 'cannot be computed: float division by zero'),
        ({'conditions': ['x_end < 0 or 3']}, ''),
    ],
)
def test_bad_input_is_said_in_the_row(changes, said):
    row = only_row(pushed_ball(**changes))
    assert said in row['reason']
    assert row['reason'].isprintable()
    assert row['outcome'] == ('error' if said else 'passed')


@pytest.mark.parametrize(
    ('lines', 'said'),
    [
        (["raise KeyError('lost')"], "at 0 s raised KeyError: 'lost' (policy.py, line 3)"),
        (['import json', "json.loads('{')"], 'line 1 column 2 (char 1) (policy.py, line 4)'),
        (
            ["return {'push': {'force': {'x': float('nan')}}}"],
            "at 0 s, topic 'push': force.x is nan; numbers must be finite",
        ),
        (
            ["return {'puhs': {}}"],
            "topic 'puhs': no plugin takes commands on the topic 'puhs'; did",
        ),
        (['return 3'], 'at 0 s returned 3; it returns messages by topic'),
    ],
)
def test_what_a_policy_does_wrong_is_said_in_the_row(policy, lines, said):
    row = only_row(pushed_ball(policy=policy(*lines)))
    assert row['outcome'] == 'error'
    assert said in row['reason']


@pytest.mark.parametrize(
    ('text', 'said'),
    [
        (
            'def make(run:',
            "policy.py:make' cannot be loaded: SyntaxError: '(' was never closed "
            '(policy.py, line 1)',
        ),
        ('import nowhere', "ModuleNotFoundError: No module named 'nowhere' (policy.py, line 1)"),
        (None, "policy.py'"),
    ],
)
def test_a_policy_that_cannot_be_loaded_is_said_in_the_row(tmp_path, text, said):
    if text:
        (tmp_path / 'policy.py').write_text(text)
    assert only_row(pushed_ball(policy=f'{tmp_path}/policy.py:make'))['reason'].endswith(said)


def test_a_policy_may_be_a_dataclass(tmp_path, floating):
    (tmp_path / 'policy.py').write_text("""from __future__ import annotations
from dataclasses import dataclass

@dataclass
class Push:
    run: object
    def __call__(self, time, readings):
        return {'push': {'force': {'x': self.run.parameters['force']}}}
""")
    row = only_row(pushed_ball(world=floating, policy=f'{tmp_path}/policy.py:Push', commands=[]))
    assert row['outcome'] == 'passed', row['reason']


def test_a_part_of_a_model_that_is_left_out_is_an_error():
    model = pushed_ball()['models'][0]
    broken = {**model, 'text': model['text'].replace('<bodyName>ball', '<bodyName>bell', 1)}
    row = only_row(pushed_ball(models=[broken], commands=[]))
    assert row['outcome'] == 'error'
    assert 'bell does not exist' in row['reason']
    (fault,) = row['faults']
    assert row['reason'] == fault['what']
    assert (fault['model'], fault['element'], fault['step']) == ('ball', "plugin 'push'", 0)
    assert not fault['internal']


def test_the_runs_beside_a_bad_one_are_made():
    scenario = pushed_ball(
        parameters={'world': {'grid': ['nowhere', 'empty']}, 'force': 3.0}, world='$world'
    )
    assert run(scenario, workers=0).outcomes == {'passed': 1, 'failed': 0, 'error': 1}


def test_a_full_disk_ends_runs_that_need_files_and_keeps_the_rows(tmp_path):
    model = tmp_path / 'box.urdf'
    model.write_text(BOX_OF_MESH)
    ball = tmp_path / 'ball.urdf'
    ball.write_text(BALL)
    scenario = pushed_ball(
        models=[{'name': 'ball', 'file': '$file'}],
        commands=[],
        conditions=[],
        parameters={'file': {'grid': [str(model), str(ball)]}},
    )
    with full_disk(3000):
        made = run(scenario, workers=0, output=tmp_path / 'out')
    assert made.outcomes == {'passed': 1, 'failed': 0, 'error': 1}
    assert 'nothing can be written in' in made.table.to_pylist()[0]['reason']
    assert made.unwritten == f'rows cannot be written to {tmp_path / "out"}: File too large'
    again = run(scenario, workers=0, output=tmp_path / 'out')
    assert (again.unwritten, again.outcomes['passed']) == ('', 2)


def test_an_interrupted_batch_is_resumed(tmp_path):
    scenario = pushed_ball(parameters={'force': {'grid': [1.0, 2.0, 3.0, 4.0]}})
    whole, made = run(scenario, workers=0).table, []

    def interrupt(done, _total, _repeated):
        made.append(done)
        if done == 2:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        run(scenario, workers=0, output=tmp_path, progress=interrupt)
    resumed = run(scenario, workers=0, output=tmp_path, progress=interrupt)
    assert made == [1, 2, 3, 4]
    assert resumed.table.equals(whole)
    assert run(scenario, workers=0, output=tmp_path, progress=interrupt).table.equals(whole)
    assert made == [1, 2, 3, 4]


def test_some_of_the_runs_can_be_made_alone(tmp_path):
    scenario = pushed_ball(parameters={'force': {'grid': [1.0, 2.0, 3.0]}})
    made = run(scenario, workers=0, only=[1], output=tmp_path).table
    assert made.column('run').to_pylist() == [1]
    assert run(scenario, workers=0, output=tmp_path).table.num_rows == 3
    with pytest.raises(ScenarioError, match='the runs have the numbers 0 to 2'):
        run(scenario, workers=0, only=[3])
