"""Environments with the controllers of a robot: actions by position, velocity and effort."""

import math

import numpy as np
import pytest
from support.controllers import EFFORT, POSITION, VELOCITY, arm

from rosbots_description.gym import SimEnv
from rosbots_description.sim import NotFoundError, Pose, SimError

JOINTS = ['joint1', 'joint2']
GROUPS = {
    POSITION: 'position_controllers/JointGroupPositionController',
    VELOCITY: 'velocity_controllers/JointGroupVelocityController',
    EFFORT: 'effort_controllers/JointGroupEffortController',
}


class Reach(SimEnv):
    """An arm by its controllers."""

    def __init__(self, interface, parameters, **options):
        super().__init__(
            robot=arm(interface), pose=Pose(), controllers=parameters, sensors=[], **options
        )

    def score(self, _observation, _action):
        return 0.0, False


@pytest.fixture
def make():
    """Return a function that makes an environment, which ends with the test."""
    made = []

    def make(*arguments, **options):
        made.append(Reach(*arguments, **options))
        return made[-1]

    yield make
    for env in made:
        env.close()


@pytest.mark.parametrize(
    ('interface', 'moved'), [(POSITION, 'position'), (VELOCITY, 'velocity'), (EFFORT, 'effort')]
)
def test_an_action_is_what_the_controller_takes(interface, moved, make):
    env = make(
        interface,
        {'arm': {'type': GROUPS[interface], 'joints': JOINTS}},
        actions={'arm': (0.5, 0.2)},
    )
    assert env.action_space.shape == (2,)
    env.reset(seed=1)
    env.step(np.array([1.0, -0.5], np.float32))
    handles = env.robot.controller('arm').joints
    assert [getattr(one, moved) for one in handles] == pytest.approx([0.5, -0.1], abs=0.02)


def test_each_episode_begins_alike_and_repeats(make):
    gains = {name: {'p': 100.0, 'd': 10.0} for name in JOINTS}
    env = make(
        POSITION,
        {
            'arm': {'type': GROUPS[POSITION], 'joints': JOINTS},
            'gazebo_ros_control': {'pid_gains': gains},
        },
    )

    def episode():
        env.reset(seed=3)
        for _ in range(5):
            env.step(np.array([0.4, -0.3], np.float32))
        return [joint.state() for joint in env.robot.joints.values()]

    assert episode() == episode()


def test_several_controllers_are_a_dict(make):
    pid = {'p': 50.0, 'd': 5.0}
    env = make(
        EFFORT,
        {
            'one': {
                'type': 'effort_controllers/JointPositionController',
                'joint': 'joint1',
                'pid': pid,
            },
            'two': {'type': 'effort_controllers/JointEffortController', 'joint': 'joint2'},
            'states': {'type': 'joint_state_controller/JointStateController', 'publish_rate': 50},
        },
    )
    assert list(env.action_space.spaces) == ['one', 'two']


@pytest.mark.parametrize(
    ('parameters', 'options', 'error', 'text'),
    [
        ({'arm': {'type': 'no/Type'}}, {}, SimError, 'does not exist'),
        ({'arm': {'type': 3}}, {}, SimError, 'does not exist'),
        (
            {'arm': {'type': GROUPS[EFFORT], 'joints': JOINTS}},
            {'actions': {'leg': 1.0}},
            NotFoundError,
            "takes no action 'leg'; its plugins and controllers with commands: arm",
        ),
    ],
)
def test_what_is_wrong_is_said_in_a_sentence(parameters, options, error, text, make):
    with pytest.raises(error, match=text):
        make(EFFORT, parameters, **options)


def test_what_is_not_finite_is_refused(make):
    env = make(EFFORT, {'arm': {'type': GROUPS[EFFORT], 'joints': JOINTS}})
    env.reset(seed=1)
    with pytest.raises(ValueError, match='finite'):
        env.step([math.nan, 0.0])
