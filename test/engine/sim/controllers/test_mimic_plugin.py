"""The mimic plugin of roboticsgroup: a joint follows another one."""

import pytest
from support.controllers import EFFORT, arm, first_joint_only, start_controller

LIBRARIES = [
    'libroboticsgroup_gazebo_mimic_joint_plugin.so',
    'libroboticsgroup_upatras_gazebo_mimic_joint_plugin.so',
]
TAGS = (
    '<joint>joint1</joint><mimicJoint>joint2</mimicJoint><multiplier>-0.5</multiplier>'
    '<offset>0.1</offset>'
)


def spawned(world, tags=TAGS, library=LIBRARIES[0]):
    """Return the arm, with a controller of its first joint only."""
    extra = f'<plugin name="mimic" filename="{library}">{tags}</plugin></gazebo></robot>'
    bot = world.spawn(
        arm(
            EFFORT,
            lambda text: first_joint_only(text).replace('</gazebo>\n</robot>', extra),
        ),
        name='arm',
    )
    gains = {'p': 500.0, 'd': 50.0, 'i': 50.0, 'i_clamp': 20.0}
    parameters = {'joint': 'joint1', 'pid': gains}
    kind = 'effort_controllers/JointPositionController'
    start_controller(bot, 'arm', kind, parameters).command(0.6)
    return bot


@pytest.mark.parametrize('library', LIBRARIES)
def test_a_joint_is_set_to_its_position(library, world):
    bot = spawned(world, library=library)
    world.run(2000)
    leader, joint = (bot.joint(name).position for name in ('joint1', 'joint2'))
    assert leader == pytest.approx(0.6, abs=0.05)
    assert joint == pytest.approx(-0.5 * leader + 0.1, abs=1e-3)


def test_a_pid_drives_the_joint_within_its_effort(world):
    bot = spawned(world, f'{TAGS}<hasPID/><maxEffort>20</maxEffort>')
    gains = {'p': 200.0, 'd': 10.0, 'i': 50.0, 'i_clamp': 20.0}
    plugin = bot.plugin('mimic')
    assert plugin.gains_path == 'gazebo_ros_control/pid_gains/joint2'
    plugin.configure({'gazebo_ros_control': {'pid_gains': {'joint2': gains}}})
    world.run(3000)
    assert bot.joint('joint2').position == pytest.approx(
        -0.5 * bot.joint('joint1').position + 0.1, abs=0.02
    )


def test_a_pid_without_gains_is_named(world, caplog):
    spawned(world, f'{TAGS}<hasPID>my/gains</hasPID>')
    world.run(5)
    assert caplog.messages.count('No p gain specified for pid.  Namespace: /my/gains') == 1


def test_a_joint_that_is_close_enough_is_left_alone(world):
    bot = spawned(world, f'{TAGS}<sensitiveness>9</sensitiveness>')
    world.run(50)
    assert bot.joint('joint2').position != pytest.approx(
        -0.5 * bot.joint('joint1').position + 0.1, abs=0.01
    )


@pytest.mark.parametrize(
    ('tags', 'text'),
    [
        ('', 'No joint element present.'),
        ('<joint>joint1</joint>', 'No mimicJoint element present.'),
        ('<joint>nose</joint><mimicJoint>joint2</mimicJoint>', 'No joint named "nose".'),
        ('<joint>joint1</joint><mimicJoint>nose</mimicJoint>', 'No (mimic) joint named "nose".'),
        (
            '<joint>joint2</joint><mimicJoint>joint2</mimicJoint>',
            'Joint "joint2" is to mimic itself; name another one in <joint>.',
        ),
    ],
)
def test_a_missing_joint_gets_upstreams_words(tags, text, world, caplog):
    spawned(world, tags)
    assert f'{text} MimicJointPlugin could not be loaded.' in caplog.text
