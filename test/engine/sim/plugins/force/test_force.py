"""The force plugin: as recorded in Gazebo, until the next command, through resets."""

import pytest
from support import empty_world
from support.recorded import DATA, load

from rosbots_description.sim.core.errors import PluginError
from rosbots_description.sim.core.transforms import Pose, from_rpy
from rosbots_description.sim.formats.urdf.urdf import load_urdf
from rosbots_description.sim.runtime.scheduler import NEVER

PUSH = ((5.0, 0.0, 60.0), (0.0, 0.0, 0.0))
NOTHING = ((0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
BEFORE = 6  # steps between the force and the first recorded state


def spec(**tags):
    text = (DATA / 'robots' / 'force.urdf').read_text(encoding='utf-8')
    for tag, value in tags.items():
        text = text.replace(f'<{tag}>', f'<{tag}>{value}<!--').replace(f'</{tag}>', f'--></{tag}>')
    return load_urdf(text, 'fbot')[0]


def test_body_moves_as_recorded():
    states = load('model_plugins')['force']
    with empty_world() as world:
        model = world.spawn(spec(), 'fbot', Pose((0.0, 0.0, 0.0), from_rpy(0.0, 0.0, 1.0)))
        world.run(round(1000 * states[0][0]) - BEFORE)
        model.plugin('force').command(*PUSH)
        for stamp, position, velocity in states:
            world.run(round(1000 * stamp) - world.clock.steps)
            pose, twist = model.state()
            # Gazebo's body is 0.01 mm higher.
            assert pose.position == pytest.approx(position, abs=2e-5)
            assert twist.linear == pytest.approx(velocity, abs=1e-5)


def test_force_ends_with_zero_and_not_with_a_reset(world):
    model = world.spawn(spec(), 'fbot', Pose((0.0, 0.0, 1.0)))
    plugin = model.plugin('force')
    assert plugin.due == NEVER
    plugin.command(*PUSH)
    world.run(10)
    world.reset_simulation()
    world.run(10)
    assert model.twist.linear[0] == pytest.approx(0.01)
    plugin.command(*NOTHING)
    assert plugin.due == NEVER
    world.run(10)
    assert model.twist.linear[0] == pytest.approx(0.01)


def test_torque_rotates_about_the_centre_of_mass(world):
    model = world.spawn(spec(), 'fbot', Pose())
    model.plugin('force').command((0.0, 0.0, 0.0), (0.0, 0.0542, 0.0))
    world.run(1)
    assert model.twist.angular[1] == pytest.approx(0.0542 / 0.0833 * 1e-3, rel=1e-3)
    assert model.twist.linear[0] == pytest.approx(-0.1 * model.twist.angular[1])


def test_numbers_that_are_not_finite_are_rejected(world):
    plugin = world.spawn(spec(), 'fbot', Pose()).plugin('force')
    with pytest.raises(ValueError, match='takes finite numbers'):
        plugin.command((float('nan'), 0.0, 0.0), (0.0, 0.0, 0.0))


@pytest.mark.parametrize(
    ('tag', 'value', 'sentence'),
    [
        ('bodyName', '', 'force plugin: missing <bodyName>, cannot proceed'),
        ('topicName', '', 'force plugin: missing <topicName>, cannot proceed'),
        (
            'bodyName',
            'nope',
            "force plugin: bodyName: nope does not exist: model 'fbot' has no link",
        ),
    ],
)
def test_plugin_with_invalid_tags_is_left_out_with_an_error(world, caplog, tag, value, sentence):
    model = world.spawn(spec(**{tag: value}), 'fbot', Pose())
    assert sentence in caplog.text
    assert not model.plugins
    assert PluginError.__name__ not in caplog.text
