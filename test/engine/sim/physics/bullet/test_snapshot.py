"""Snapshots: bit-identical continuation, whatever happened in between."""

import math
import random

import pytest
from support import SPAWN_POSE, box_urdf, empty_world, robot_spec, urdf_spec
from support.scenes import castered

from rosbots_description.sim.core.errors import SimError
from rosbots_description.sim.core.transforms import Pose, Twist, from_rpy
from rosbots_description.sim.description.physics_settings import PhysicsSettings
from rosbots_description.sim.physics.bullet.client import pybullet

BOX = urdf_spec(box_urdf('0.2 0.2 0.2', 1.0))
# Two links on a joint with a spring, with an inertia that makes them tumble.
ARM = (
    '<link name="a"><inertial><mass value="1"/><inertia ixx="0.01" iyy="0.02" izz="0.03" ixy="0" '
    'ixz="0" iyz="0"/></inertial><collision><geometry><box size="0.2 0.2 0.1"/></geometry>'
    '</collision></link><link name="b"><inertial><origin xyz="0.2 0 0"/><mass value="0.3"/>'
    '<inertia ixx="0.001" iyy="0.004" izz="0.004" ixy="0" ixz="0" iyz="0"/></inertial>'
    '<collision><origin xyz="0.2 0 0"/><geometry><box size="0.3 0.05 0.05"/></geometry>'
    '</collision></link><joint name="j" type="revolute"><parent link="a"/><child link="b"/>'
    '<axis xyz="0 1 0"/><limit lower="-1" upper="1" effort="1" velocity="9"/>'
    '<dynamics damping="0.01"/></joint>'
)


def motion(world):
    """Return the states of all links and joints."""
    return [
        (world.engine.link_states(model.body), world.engine.joint_states(model.body))
        for model in world.models.values()
    ]


def states(world):
    """Return the states of all links and joints, and the contacts."""
    return motion(world), [
        [contact[2:] for contact in world.engine.contacts(model.body)]
        for model in world.models.values()
    ]


def go_on(world, steps=600):
    found = []
    for k in range(steps // 20):
        if k == 10:
            for model in world.models.values():
                for joint in model.joints.values():
                    joint.set_motor(-4.0, 3.0)
        world.engine.step(20)
        found.append(states(world))
    return found


def mix_up(world, chance):
    """Set random poses, high speeds and other motor targets."""
    for model in world.models.values():
        if model.static:
            continue
        if chance.random() < 0.6:
            place = [chance.uniform(-2.0, 2.0) for _ in range(3)]
            model.set_pose(Pose((*place[:2], 2.5 + place[2]), from_rpy(*place)))
            model.set_twist(Twist((0.0, place[0], 0.0), tuple(20.0 * x for x in place)))
        for joint in model.joints.values():
            joint.set_motor(chance.uniform(-9.0, 9.0), 5.0)
    world.engine.step(chance.randrange(1000))


def pile(world, chance, boxes):
    for k in range(boxes):
        pose = Pose((0.6 + chance.uniform(0.0, 0.5), chance.uniform(-0.4, 0.4), 0.2 + 0.25 * k))
        world.spawn(BOX, f'box{k}', pose)


@pytest.mark.parametrize(('seed', 'boxes', 'robots'), [(1, 0, 1), (2, 2, 1), (3, 8, 1), (4, 4, 3)])
def test_continuation_from_a_snapshot_is_bit_identical(world, seed, boxes, robots):
    chance = random.Random(seed)
    pile(world, chance, boxes)
    for k in range(robots):
        spec = robot_spec() if not k else castered()
        world.spawn(spec, f'robot{k}', Pose((0.0, 1.2 * k, 0.5 - 0.35 * bool(k))))
    world.spawn(urdf_spec(ARM), 'arm', Pose((0.5, 0.0, 3.5), from_rpy(0.1, 0.2, 0.3)))
    for model in world.models.values():
        for joint in model.joints.values():
            joint.set_motor(5.0, 5.0)
    world.engine.step(1777)
    before = motion(world)
    snapshot = world.engine.snapshot()
    assert motion(world) == before
    wanted = go_on(world)
    for _ in range(2):
        mix_up(world, chance)
        world.engine.restore(snapshot)
        assert motion(world) == before
        found = go_on(world)
        same = [a == b for a, b in zip(wanted, found, strict=True)]
        assert all(same), f'differs from step {20 * same.index(False)}'


# PyBullet reorders the contact points of a body of several shapes, such as the robot.
@pytest.mark.parametrize(
    ('make_spec', 'tolerances'),
    [
        (lambda: BOX, (0.0, 0.0)),
        (robot_spec, (1e-6, 1e-4)),
    ],
    ids=['box', 'robot'],
)
def test_taking_a_snapshot_hardly_changes_the_motion(make_spec, tolerances):
    with empty_world() as world, empty_world() as other:
        models = [one.spawn(make_spec(), 'thing', SPAWN_POSE) for one in (world, other)]
        for one in (world, other):
            one.run(2500)
        world.engine.snapshot()
        for steps, tolerance in zip((1, 999), tolerances, strict=True):
            for one in (world, other):
                one.run(steps)
            assert math.dist(*(model.pose.position for model in models)) <= tolerance  # [m]


def test_continuation_is_bit_identical_with_spin_slip_forces_and_new_step_size(world):
    arm = world.spawn(urdf_spec(ARM), 'arm', Pose((0.0, 0.0, 90.0)))
    box = world.spawn(BOX, 'box', Pose((3.0, 0.0, 0.1)))
    arm.set_twist(Twist((0.0, 0.0, 9.0), (0.3, 20.0, 0.2)))
    world.engine.step(333)
    world.engine.set_slip_compliance(box.body, 'box', (1.0, 0.0, 0.0), (0.01, 0.02))
    box.set_twist(Twist((0.5, 0.5, 0.0)))
    world.engine.step(40)
    box.links['box'].apply_wrench((0.0, 0.0, 30.0), (0.0, 0.0, 0.5))
    arm.joints['j'].apply_effort(0.5)
    snapshot = world.engine.snapshot()
    wanted = go_on(world, 400)
    for _ in range(2):
        box.links['box'].apply_wrench((70.0, 0.0, 0.0), (0.0, 0.0, 0.0))
        world.engine.set_slip_compliance(box.body, 'box', (0.0, 1.0, 0.0), (1.0, 1.0))
        world.set_physics(PhysicsSettings(step_size=0.002, gravity=(0.0, 0.0, -3.0)))
        world.engine.step(50)
        box.links['box'].apply_wrench((70.0, 0.0, 0.0), (0.0, 0.0, 0.0))
        world.engine.restore(snapshot)
        assert go_on(world, 400) == wanted


def test_static_model_is_restored_to_its_pose(world):
    shelf = urdf_spec(box_urdf('1 1 0.2', 1.0, '<gazebo><static>true</static></gazebo>'))
    stand = world.spawn(shelf, 'shelf', Pose((0.0, 0.0, 1.0)))
    box = world.spawn(BOX, 'box', Pose((0.0, 0.0, 1.2)))
    world.engine.step(500)
    snapshot = world.engine.snapshot()
    wanted = go_on(world, 500)
    stand.set_pose(Pose((5.0, 0.0, 1.0)))
    world.engine.step(500)
    assert box.pose.position[2] < 0.2
    world.engine.restore(snapshot)
    assert go_on(world, 500) == wanted


def test_snapshot_of_other_models_is_rejected_with_a_message(world):
    snapshot = world.engine.snapshot()
    world.spawn(BOX, 'box', Pose((0.0, 0.0, 1.0)))
    with pytest.raises(SimError, match='of other models'):
        world.engine.restore(snapshot)
    later = world.engine.snapshot()
    world.reset_simulation()
    with pytest.raises(SimError, match='of other models'):
        world.engine.restore(later)


def test_reset_world_with_a_snapshot_moves_like_a_new_one():
    found = []
    for saves in (False, True):
        with empty_world() as world:
            pile(world, random.Random(5), 4)
            if saves:
                world.engine.step(300)
                world.engine.snapshot()
                world.reset_simulation()
            found.append(go_on(world))
    assert found[0] == found[1]


def test_unreferenced_snapshots_are_freed(world, monkeypatch):
    save, remove, saved = pybullet.saveState, pybullet.removeState, set()

    def recorded_save(**options):
        saved.add(state := save(**options))
        return state

    def recorded_remove(state, **options):
        remove(state, **options)
        saved.remove(state)

    monkeypatch.setattr(pybullet, 'saveState', recorded_save)
    monkeypatch.setattr(pybullet, 'removeState', recorded_remove)
    for _ in range(20):
        snapshot = world.engine.snapshot()
    assert len(saved) == 1
    del snapshot
    assert not saved
