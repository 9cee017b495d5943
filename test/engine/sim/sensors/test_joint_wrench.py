"""Joint reactions agree with Gazebo's recordings."""

import math

import pytest
from support.sensing import box_sdf, collected, robot_text, timed

from rosbots_description.ros_api.adapters.wrenches import wrench_message
from rosbots_description.sim.public.world import World

ARM = robot_text('arm_ft')
# In Gazebo, hanging at rest: force and torque of each joint [N, N m].
HANGING = {
    'ft_elbow': ((0.0, 0.0, 4.9), (0.0, 0.0, 0.0)),
    'ft_shoulder': ((0.0, 0.0, 14.7), (0.245, 0.0, 0.0)),
}
CLOSE = 1e-3


@pytest.fixture
def world():
    with World.empty() as made:
        yield made


def spawn(world):
    """Return the arm, hanging, and by topic a list that takes times [ms] and readings."""
    model = world.spawn(ARM, 'arm')
    model.joint('shoulder').set_position(math.pi)
    return model, {
        plugin.params.values['topicName']: timed(world, plugin.outputs['wrench'])
        for plugin in model.plugins.values()
        if 'wrench' in plugin.outputs
    }


@pytest.mark.parametrize('topic', HANGING)
def test_reactions_at_rest_are_the_weight_below_the_joint(world, topic):
    _, found = spawn(world)
    world.run(200)
    assert [time for time, _ in found[topic]] == list(range(10, 201, 10))
    force, torque = HANGING[topic]
    message = wrench_message(found[topic][-1][1]).wrench
    assert (message.force.x, message.force.y, message.force.z) == pytest.approx(force, abs=CLOSE)
    assert (message.torque.x, message.torque.y, message.torque.z) == pytest.approx(
        torque, abs=CLOSE
    )


def test_effort_on_a_joint_is_part_of_its_torque(world):
    model, found = spawn(world)
    # 0.118 rad is where 0.1 N m holds the fore-arm against gravity.
    world.apply_effort(model.joint('elbow'), 0.1)
    world.run(8000)
    _, reading = found['ft_elbow'][-1]
    assert reading.torque[1] == pytest.approx(-0.1, abs=0.003)
    assert math.hypot(*reading.force) == pytest.approx(4.9, abs=0.01)


def test_reactions_at_a_joint_limit_agree_with_the_recording(world):
    model, found = spawn(world)
    world.apply_effort(model.joint('elbow'), 1.0)  # [N m], more than the weight
    model.joint('elbow').set_position(2.5)
    model.joint('shoulder').set_position(3.0269811)
    world.run(1500)
    for topic, expected in (
        ('ft_elbow', (-3.362324, 0.0, -3.5645097, 0.0, -0.67247247, 0.0)),
        ('ft_shoulder', (1.6814816, 0.0, 14.604347, 0.24342872, 0.0, -0.028053357)),
    ):
        force, torque = found[topic][-1][1]
        assert (*force, *torque) == pytest.approx(expected, abs=CLOSE)


ROD = """<robot name="rod"><link name="world"/><joint name="f" type="fixed"><parent link="world"/>
<child link="base"/><origin xyz="0 0 1" rpy="0 0 0.7"/></joint>
<link name="base"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1"/></inertial></link>
<link name="rod"><inertial><origin xyz="0.5 0 0"/><mass value="2"/>
<inertia ixx="0.1" iyy="0.1" izz="0.1"/></inertial><collision><origin xyz="0.5 0 0"/><geometry>
<box size="0.9 0.2 0.1"/></geometry></collision></link><joint name="j" type="revolute">
<parent link="base"/><child link="rod"/><axis xyz="0 1 0"/>
<limit lower="{lower}" upper="0" effort="100" velocity="10"/></joint>
<gazebo><plugin name="p" filename="libgazebo_ros_ft_sensor.so"><topicName>t</topicName>
<jointName>j</jointName></plugin></gazebo></robot>"""


@pytest.mark.parametrize('lower', [-1, 0])  # 0: as of a fixed joint that is kept for its sensor
def test_reaction_at_a_joint_limit_is_the_weight_of_rod_and_load(world, lower):
    (plugin,) = world.spawn(ROD.format(lower=lower)).plugins.values()
    found = collected(plugin.outputs['wrench'])
    world.run(200)
    assert (*found[-1].force, *found[-1].torque) == pytest.approx(
        (0.0, 0.0, -19.6, 0.0, 9.8, 0.0), abs=0.01
    )
    load = box_sdf('.1 .1 .1', static=False)
    world.spawn(load, x=0.8 * math.cos(0.7), y=0.8 * math.sin(0.7), z=1.1, yaw=0.7)
    world.run(1000)
    assert found[-1].force[2] == pytest.approx(-29.4, abs=0.05)
    assert found[-1].torque[1] == pytest.approx(9.8 + 0.8 * 9.8, abs=0.05)


def test_frame_is_that_of_the_child_and_nothing_is_measured_without_readers(world):
    model = world.spawn(ARM, 'arm')
    plugin = model.plugin('ft')
    assert plugin.params.values['frame'] == 'fore'
    read = collected(plugin.outputs['wrench'])
    world.run(20)
    plugin.outputs['wrench'].disconnect(read.append)
    assert len(read) == 2
    assert world.engine.joint_reaction(model.body, 'elbow').force == pytest.approx((0, 0, 0))
