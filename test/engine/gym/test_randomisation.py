"""What differs between episodes is drawn by the seed, and undone by the next reset."""

import numpy as np
import pytest
from support import XACRO
from support.refusals import sentence_of

from rosbots_description.gym import Randomisation, SimEnv
from rosbots_description.sim import NotFoundError, Pose, SimError
from rosbots_description.sim.formats.urdf import expand_xacro
from rosbots_description.sim.resources import PackageSearch

NOISY = expand_xacro(str(XACRO), {'laser': 'true'}, PackageSearch()).replace(
    '</scan>', '</scan><noise><type>gaussian</type><stddev>0.01</stddev></noise>'
)
ALL = Randomisation(
    mass=(0.5, 2.0),
    friction=(0.5, 0.9),
    light=(0.2, 1.0),
    noise=(2.0, 4.0),
    pose=(0.5, 0.5, 3.0),
    obstacles={'barrel': 0.5, 'table': 0.3},
)


class Still(SimEnv):
    """Nothing to do."""

    def score(self, _observation, _action):
        return 0.0, False


@pytest.fixture
def env():
    made = Still('room', NOISY, randomise=ALL, settle=0.3)
    yield made
    made.close()


def state(env):
    """Return what may differ."""
    world, robot = env.world, env.robot
    return (
        robot.mass_scale,
        [link.friction_scale for link in robot.links.values()],
        dict(world.lights),
        robot.sensor('laser').noise_scale,
        robot.pose,
        world.model('barrel').pose,
        world.model('table').pose,
        world.seed,
    )


def test_everything_is_drawn_within_its_range_by_the_seed(env):
    found = []
    for seed in (1, 2, 1):
        observation, info = env.reset(seed=seed)
        drawn = info['randomised']
        assert {*drawn} == {'mass', 'friction', 'light', 'noise', 'pose', 'barrel', 'table'}
        for name in ('mass', 'friction', 'light', 'noise'):
            least, most = getattr(ALL, name)
            assert least <= drawn[name] <= most
        assert env.robot.mass_scale == drawn['mass']
        assert env.robot.sensor('laser').noise_scale == drawn['noise']
        assert max(abs(env.robot.pose.position[0]), abs(env.robot.pose.position[1])) <= 0.5
        x, y, _ = env.world.model('barrel').pose.position
        assert max(abs(x - 2.9), abs(y - 1.9)) <= 0.5 + 1e-3
        assert not env.bumps()
        found.append((state(env), observation['laser'].tobytes(), drawn))
    assert found[0] == found[2]
    for one, other in zip(found[0][0], found[1][0], strict=True):
        assert one != other


def test_next_reset_undoes_everything(env):
    env.reset(seed=1)
    env.step(np.array([1.0, 0.3]))
    env._randomise = Randomisation()
    env.reset(seed=1)
    plain = Still('room', NOISY, settle=0.3)
    plain.reset(seed=1)
    assert state(env) == state(plain)
    for _ in range(5):
        one, other = (made.step(np.array([1.0, 0.3]))[0] for made in (env, plain))
        assert one['laser'].tobytes() == other['laser'].tobytes()
    plain.close()


def test_noise_of_a_sensor_differs_between_seeds_only():
    made = Still('room', NOISY, settle=0.1)
    scans = [made.reset(seed=seed)[0]['laser'].tobytes() for seed in (1, 2, 1)]
    made.close()
    assert scans[0] == scans[2] != scans[1]


@pytest.mark.parametrize(
    ('given', 'kind', 'said'),
    [
        ({'mass': (0.0, 1.0)}, ValueError, 'randomisation of mass is (0.0, 1.0)'),
        ({'friction': (2.0, 1.0)}, ValueError, 'range of factors'),
        ({'light': (1.0, float('nan'))}, ValueError, 'range of factors'),
        ({'mass': 1.5}, ValueError, 'randomisation of mass is 1.5; it is a range of factors'),
        ({'pose': (-1.0, 0.0, 0.0)}, ValueError, 'numbers from 0 to 1e+06'),
        ({'pose': (1e308, 0.0, 0.0)}, ValueError, 'randomisation of pose is (1e+308, 0.0, 0.0)'),
        ({'pose': (0.0, 0.0, 10**400)}, ValueError, 'numbers from 0 to 1e+06'),
        ({'obstacles': {'barrel': 1e308}}, ValueError, 'numbers from 0 to 1e+06'),
        ({'mass': (1.0, 1e308)}, ValueError, 'both above 0 and at most 1e+06'),
        ({'noise': (1.0, 10**400)}, ValueError, 'both above 0 and at most 1e+06'),
        (
            {'pose': (1.0, 1.0)},
            ValueError,
            'randomisation of pose is (1.0, 1.0); it is three shifts',
        ),
        ({'obstacles': ['barrel']}, ValueError, "is ['barrel']; it is a dict of shifts by names"),
        ({'obstacles': {'piano': 1.0}}, NotFoundError, "no model 'piano'"),
        ({'noise': (1.0, 2.0)}, SimError, 'no sensor'),
    ],
)
def test_randomisation_that_cannot_be_is_named(given, kind, said):
    assert said in sentence_of(kind, lambda: Still(randomise=Randomisation(**given), settle=0.1))


@pytest.mark.parametrize('given', [1, True, 'all', {'mass': (1.0, 2.0)}, Randomisation])
def test_anything_but_a_randomisation_is_refused(given):
    with pytest.raises(ValueError, match=r'randomise is .*; it takes a Randomisation, or None'):
        Still(randomise=given, settle=0.1)


def test_robot_is_put_where_it_overlaps_nothing():
    made = Still(
        'room',
        pose=Pose((0.7, -1.2, 0.5)),
        settle=0.3,
        randomise=Randomisation(pose=(0.6, 0.0, 0.0)),
    )
    for seed in range(30):  # the column is a quarter of a metre ahead
        made.reset(seed=seed)
        assert not made.world.overlaps(made.robot).keys() & {'column'}
    made.close()


def test_obstacle_without_a_free_place_is_named(monkeypatch):
    made = Still('room', randomise=Randomisation(obstacles={'barrel': 0.1}), settle=0.1)
    monkeypatch.setattr(type(made.world), 'overlaps', lambda *_: {'walls': 0.1})
    with pytest.raises(SimError, match="no place is free for model 'barrel' between x 2"):
        made.reset(seed=0)
    made.close()
