"""The joint state publisher: its joints, their order, and timing."""

import pytest
from support.fake_drive import collect, fake_model, make_drive, run, turn

from rosbots_description.sim.plugins.state.joint_state_publisher import JointStatePublisher

PREFIX = 'GazeboRosJointStatePublisher Plugin (ns = robot/) '


def make(**tags):
    return make_drive(JointStatePublisher, fake_model(), **tags)


def test_joints_are_in_the_order_of_the_tag_with_positions_and_velocities():
    plugin = make(jointName=' right,\n left ', updateRate='0')
    readings = collect(plugin.joint_states)
    turn(plugin, left=2.0, right=-1.0)
    run(plugin, 100)
    names, positions, velocities, efforts = readings[-1]
    assert names == ('right', 'left')
    assert positions == pytest.approx((-0.1, 0.2))
    assert (velocities, efforts) == ((-1.0, 2.0), ())


@pytest.mark.parametrize(
    ('rate', 'steps'),
    [
        ('20', [51, 101, 151, 201]),
        ('30', [34, 67, 100, 134]),
        ('0', [1, 2, 3, 4]),
        ('-5', [1, 2, 3, 4]),
        (None, [11, 21, 31, 41]),
    ],
)
def test_the_mean_rate_is_exact_and_the_first_reading_a_step_late(rate, steps):
    plugin, found = make(jointName='left', updateRate=rate), []
    plugin.joint_states.connect(lambda _: found.append(plugin.world.clock.steps))
    run(plugin, 210)
    assert found[:4] == steps


def test_missing_tag_is_logged_with_its_default(caplog):
    plugin = make(jointName='left')
    assert caplog.messages == [f'{PREFIX}missing <updateRate>, defaults to 100.000000']
    assert plugin.namespace == 'robot'
    assert make(jointName='left', robotNamespace='').namespace == 'robot'


@pytest.mark.parametrize('names', [None, '', ' , '])
def test_states_are_empty_without_names(names):
    plugin = make(jointName=names, updateRate='0')
    readings = collect(plugin.joint_states)
    run(plugin, 1)
    assert readings == [((), (), (), ())]


def test_unknown_joint_is_reported_and_left_out(caplog):
    plugin = make(jointName='left,nope', updateRate='0')
    assert caplog.messages == [
        f"{PREFIX}Joint nope does not exist! It is left out: model 'robot' has no joint 'nope'; "
        'its joints: left, right'
    ]
    readings = collect(plugin.joint_states)
    run(plugin, 1)
    assert readings[0].names == ('left',)
