"""The environments of Gymnasium: spaces, exact periods, determinism, and bad input."""

import logging
import math
import warnings

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env
from support.refusals import sentence_of

import rosbots_description.gym  # noqa: F401  registers the tasks
from rosbots_description.gym import SimEnv
from rosbots_description.sim import NotFoundError, Pose, SimError

TASKS = ['FollowLine', 'GoToGoal', 'Maze', 'Wander']
STONE = """<robot name="stone"><link name="l"><inertial><mass value="1"/>
  <inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link></robot>"""


CART = """<sdf version="1.6"><model name="cart">
<link name="base"><pose>0 0 0.1 0 0 0</pose><inertial><mass>2</mass></inertial>
<collision name="c"><geometry><box><size>0.5 0.5 0.2</size></box></geometry></collision>
<sensor name="bumper" type="contact"><contact><collision>c</collision></contact></sensor>
<sensor name="depth" type="depth"><pose>0.3 0 0.3 0 0 0</pose><camera name="d">
<image><width>8</width><height>6</height></image><clip><near>0.1</near><far>9</far></clip></camera>
</sensor></link>
<link name="arm"><pose>0 0 0.5 0 0 0</pose><inertial><mass>1</mass></inertial></link>
<joint name="hinge" type="revolute"><parent>base</parent><child>arm</child>
<axis><xyz>0 0 1</xyz></axis></joint>
<plugin name="move" filename="libgazebo_ros_planar_move.so"/>
<plugin name="push" filename="libgazebo_ros_force.so"><bodyName>base</bodyName>
<topicName>push</topicName></plugin>
</model></sdf>"""


class Push(SimEnv):
    """Any robot on an empty ground."""

    def __init__(self, robot, **options):
        super().__init__(robot=robot, pose=Pose(), **options)

    def score(self, _observation, _action):
        return 0.0, False


class Forward(SimEnv):
    """As one writes one's own: drive on in the room, away from what is near."""

    def __init__(self, **options):
        super().__init__('room', **{'arguments': {'laser': 'true', 'imu': 'true'}, **options})

    def score(self, observation, action):
        return float(action[0]), bool(observation['laser'].min() < 0.3)


@pytest.fixture
def forward():
    with_laser = Forward()
    yield with_laser
    with_laser.close()


def rollout(env, seed, steps=8):
    """Return all that an environment gives for a seed, as bytes."""
    observation, info = env.reset(seed=seed)
    actions = np.random.default_rng(seed)
    parts = [observation, info]
    for _ in range(steps):
        observation, reward, terminated, truncated, info = env.step(
            actions.uniform(-1.0, 1.0, env.action_space.shape)
        )
        parts += [observation, info, {'reward': np.array([reward, terminated, truncated])}]
        if terminated or truncated:
            break
    return b''.join(
        repr(value).encode() if isinstance(value, dict | tuple) else np.asarray(value).tobytes()
        for part in parts
        for _, value in sorted(part.items())
    )


@pytest.mark.parametrize('task', TASKS)
def test_task_passes_the_checks_of_gymnasium_without_a_warning(task):
    env = gymnasium.make(f'rosbots/{task}-v0')
    with warnings.catch_warnings():
        warnings.simplefilter('error')
        check_env(env.unwrapped, skip_render_check=task != 'GoToGoal')  # one shows it for all


@pytest.mark.parametrize('task', TASKS)
def test_same_seed_gives_the_same_bits_after_other_episodes_and_in_another_world(task):
    one, other = (gymnasium.make(f'rosbots/{task}-v0').unwrapped for _ in range(2))
    first = rollout(one, 7)
    rollout(one, 8)
    assert rollout(one, 7) == first
    assert rollout(other, 7) == first
    assert rollout(other, 9) != first
    one.close()
    other.close()


def test_a_period_runs_from_one_due_event_to_the_next_with_the_bits_of_single_steps(monkeypatch):
    """The drive is due each 10 steps; between, no code but the engine's runs."""
    env = gymnasium.make('rosbots/GoToGoal-v0').unwrapped
    advance, physics, calls = env.world.run, env.world.engine.step, []
    monkeypatch.setattr(
        env.world.engine, 'step', lambda steps: (calls.append(steps), physics(steps))
    )
    whole = rollout(env, 7, steps=3)
    assert sum(calls) == 300
    assert len(calls) <= 3 * 10 + 1
    calls.clear()
    monkeypatch.setattr(env.world, 'run', lambda steps: [advance(1) for _ in range(steps)])
    assert rollout(env, 7, steps=3) == whole
    assert calls == [1] * 300
    env.close()


def test_a_step_is_exactly_one_period(forward):
    forward.reset(seed=0)
    times = [forward.step(np.zeros(2))[4]['time'] for _ in range(3)]
    assert times == [0.1, 0.2, 0.3]


def test_observation_is_a_dict_of_what_the_sensors_give(forward):
    space = forward.observation_space
    assert {name: one.shape for name, one in space.items()} == {
        'imu': (10,),
        'laser': (361,),
        'odometry': (6,),
    }
    observation, _ = forward.reset(seed=0)
    assert observation in space
    for _ in range(10):
        observation, *_ = forward.step(np.array([1.0, 0.0]))
    assert observation in space
    assert observation['odometry'][3] > 0.3  # forward velocity [m/s]
    assert observation['imu'][9] == pytest.approx(9.8, abs=2.0)


@pytest.mark.parametrize(
    ('action', 'said'),
    [
        (np.zeros(3), "'differential_drive_controller' takes 2 numbers from -1 to 1"),
        ('fast', 'takes 2 numbers'),
        (np.array([np.nan, 0.0]), 'takes finite numbers; it got [nan, 0.0]'),
        (np.array([0.0, np.inf]), 'takes finite numbers'),
    ],
)
def test_action_that_cannot_be_given_is_named(forward, action, said):
    forward.reset(seed=0)
    assert said in sentence_of(ValueError, forward.step, action)


@pytest.mark.parametrize(
    ('options', 'kind', 'said'),
    [
        (
            {'sensors': ['radar']},
            NotFoundError,
            "no sensor 'radar'; what can be observed: odometry",
        ),
        (
            {'actions': {'sails': 1.0}},
            NotFoundError,
            "no action 'sails'; its plugins and controllers",
        ),
        (
            {'actions': {'differential_drive_controller': (1.0, -1.0)}},
            ValueError,
            'positive numbers',
        ),
        ({'world': 'nowhere'}, NotFoundError, 'nowhere'),
        ({'robot': '<robot name="r"/>'}, SimError, 'link'),
        ({'robot': STONE}, SimError, 'takes commands'),
        ({'period': 0.1234567}, ValueError, 'multiple of the step size'),
        ({'period': float('nan')}, ValueError, 'period is nan'),
        ({'render_mode': 'human'}, ValueError, "render_mode is 'human'"),
    ],
)
def test_environment_that_cannot_be_made_is_named(options, kind, said):
    assert said in sentence_of(kind, SimEnv, **options)


def test_warnings_of_a_description_are_one_message_once_in_a_process(caplog):
    wheels = [
        f'<robot name="{name}"><link name="l"><inertial><mass value="1"/><inertia ixx="1" '
        'iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link><gazebo><plugin '
        'name="push" filename="libgazebo_ros_planar_move.so"><unread/><strange/></plugin>'
        '<plugin name="other" filename="libgazebo_ros_planar_move.so"><unread/></plugin>'
        f'</gazebo></robot>'
        for name in ('one', 'two')
    ]
    found = []
    for text in (wheels[0], wheels[0], wheels[1].replace('strange', 'odd')):
        caplog.clear()
        Push(text, settle=0.0).close()
        found.append([record.getMessage() for record in caplog.records])
    (first,), second, (third,) = found
    assert first.startswith('loading the robot and its world gave ')
    assert first.count('<unread>') == 2
    assert second == []
    assert '<odd>' in third


def test_errors_of_a_description_are_logged_each_time(caplog):
    for _ in range(2):
        caplog.clear()
        Push(CART.replace('libgazebo_ros_force.so', 'libgazebo_ros_nothing.so'), settle=0.0).close()
        assert [record.levelname for record in caplog.records].count('ERROR') == 1


def test_info_has_the_faults_of_the_descriptions_and_then_the_new_ones():
    env = Push(CART.replace('libgazebo_ros_force.so', 'libgazebo_ros_nothing.so'), settle=0.0)
    for _ in range(2):
        _, info = env.reset(seed=0)
        (fault,) = [one for one in info['faults'] if one.severity == logging.ERROR]
        assert fault.element == "plugin 'libgazebo_ros_nothing.so'"
        assert env.step(env.action_space.sample())[-1]['faults'] == ()
    env.world.faults.report('the wheel is loose', model='cart')
    assert env.step(env.action_space.sample())[-1]['faults'] == (env.world.faults[-1],)
    assert env.step(env.action_space.sample())[-1]['faults'] == ()
    env.close()


def test_picture_follows_the_robot():
    env = Forward(render_mode='rgb_array', settle=0.3)
    env.reset(seed=0)
    first = env.render()
    assert (first.shape, first.dtype) == ((480, 640, 3), np.uint8)
    blue = (first[:, :, 2] > 200) & (first[:, :, 0] < 80)  # the upper deck
    assert np.argwhere(blue).mean(axis=0) == pytest.approx((160.0, 320.0), abs=60.0)
    env.place(2.0, 1.0, 0.0)
    assert np.abs(env.render().astype(int) - first).mean() > 3.0  # the room has moved
    env.close()


def test_imu_of_a_new_episode_is_that_of_its_start(forward):
    forward.reset(seed=0)
    for _ in range(3):
        forward.step(np.array([0.0, 1.0]))
    forward.begin = lambda _options: forward.place(0.0, 0.0, 1.0)
    observation, _ = forward.reset(seed=0)
    assert observation['imu'][:4] == pytest.approx(
        (0.0, 0.0, math.sin(0.5), math.cos(0.5)), abs=0.02
    )
    assert observation['imu'][4:] == pytest.approx((0.0, 0.0, 0.0, 0.0, 0.0, 9.8), abs=0.1)


def test_episode_is_truncated_when_the_world_diverges_and_the_next_is_as_in_a_new_world(caplog):
    one, other = Forward(settle=0.3), Forward(settle=0.3)
    one.reset(seed=3)
    one.robot.joint('wheel_left_joint').set_position(math.nan)
    _, _, terminated, truncated, info = one.step(np.zeros(2))
    assert (terminated, truncated) == (False, True)
    (fault,) = info['faults']
    assert (fault.model, fault.severity) == (one.robot.name, logging.ERROR)
    assert fault.what in caplog.text
    caplog.clear()
    assert rollout(one, 4) == rollout(other, 4)
    assert 'the world is loaded again' in caplog.text
    assert rollout(one, 4) == rollout(other, 4)
    one.close()
    other.close()


def test_plugins_and_joints_that_take_commands_are_a_dict_of_actions():
    env = Push(
        CART,
        actions={'move': (2.0, 1.0, 3.0), 'push': 8.0, 'hinge': 0.5},
        sensors=['odometry'],
        settle=0.0,
    )
    assert {name: one.shape for name, one in env.action_space.items()} == {
        'move': (3,),
        'push': (6,),
        'hinge': (1,),
    }
    still = {'move': np.zeros(3), 'push': np.zeros(6), 'hinge': np.zeros(1)}
    env.reset(seed=0)
    for _ in range(10):
        env.step({**still, 'move': np.array([0.5, 0.25, 0.0])})
    assert env.pose[:2] == pytest.approx((1.0, 0.25), abs=0.02)  # shares of the limits, for 1 s
    for action, said in (
        ({'move': np.zeros(3)}, "the action has no 'push'"),
        (np.zeros(3), 'an action is a dict of move, push, hinge'),
        ({**still, 'hinge': np.zeros(2)}, "'hinge' takes 1 numbers"),
    ):
        with pytest.raises(ValueError, match='action') as error:
            env.step(action)
        assert said in str(error.value)
    env.close()


def test_effort_of_a_joint_acts_until_the_next_action():
    env = Push(
        CART.replace('libgazebo_ros_planar_move.so', 'libgazebo_ros_p3d.so'),
        actions={'hinge': 0.5},
        sensors=['bumper'],
        settle=0.2,
    )
    env.reset(seed=0)
    hinge, speeds = env.robot.joint('hinge'), []
    for share in (-1.0, -1.0, 0.0, 0.0):
        env.step(np.array([share]))
        speeds.append(hinge.velocity)
    assert speeds[1] == pytest.approx(2.0 * speeds[0], rel=0.05)
    assert speeds[0] < -0.01
    assert speeds[3] == pytest.approx(speeds[1], rel=0.05)
    env.close()


def test_contact_and_depth_are_observed():
    env = Push(CART, sensors=['bumper', 'depth'], settle=0.2)
    space = env.observation_space
    assert (space['bumper'].shape, space['depth'].shape) == ((1,), (6, 8))
    observation, _ = env.reset(seed=0)
    assert observation in space
    assert observation['bumper'] == 1.0  # it stands on the ground
    assert observation['depth'][0] == pytest.approx(9.0)  # the sky is as far as it sees
    env.robot.set_pose(Pose((0.0, 0.0, 3.0)))
    assert env.step(env.action_space.sample())[0]['bumper'] == 0.0
    env.close()


def test_step_before_reset_and_reset_after_close_are_named():
    env = Forward(settle=0.1)
    with pytest.raises(gymnasium.error.ResetNeeded):
        env.step(np.zeros(2))
    env.close()
    with pytest.raises(SimError, match='closed'):
        env.reset()
