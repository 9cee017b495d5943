"""What rests sleeps, and wakes in the step in which something acts on it, as if it were awake."""

import math
from dataclasses import replace
from itertools import chain

import pytest
from support import SPAWN_POSE, empty_world, robot_spec, urdf_spec
from support.scenes import ball, box, link

from rosbots_description.sim.core.transforms import Pose, Twist, from_rpy
from rosbots_description.sim.physics.bullet.tuning import Tuning
from rosbots_description.sim.runtime.properties import set_friction

AWAKE = Tuning(rest=math.inf)
ASLEEP = 1500  # steps after which all models here sleep that rest
CUBE = urdf_spec(box('link', (0.2, 0.2, 0.2), 1.0))
POST = replace(urdf_spec(box('link', (0.1, 0.1, 0.4), 1.0)), static=True)
PLANK = urdf_spec(box('link', (1.0, 0.3, 0.1), 2.0))
PLATE = replace(urdf_spec(box('link', (1.0, 1.0, 0.2), 1.0)), static=True)
FLYWHEEL = urdf_spec(
    box('base', (0.2, 0.2, 0.2), 5.0)
    + link('wheel', '<sphere radius="0.02"/>', 1.0, (0.01, 0.01, 0.01))
    + '<joint name="axle" type="continuous"><parent link="base"/><child link="wheel"/>'
    '<origin xyz="0 0 0.2"/><axis xyz="0 0 1"/></joint>'
)
# A slider that its weight holds at its lower stop.
SLIDER = urdf_spec(
    '<link name="world"/>'
    + box('slider', (0.1, 0.1, 0.1), 1.0)
    + '<joint name="rail" type="prismatic"><parent link="world"/><child link="slider"/>'
    '<origin xyz="0 3 1"/><axis xyz="0 0 1"/><limit lower="-0.1" upper="1" effort="50" '
    'velocity="9"/></joint>'
)


def furnish(world):
    """Spawn a stack on a plate, a cube on a slope, two cubes, a flywheel and two sliders."""
    world.spawn(PLATE, 'plate', Pose((0.0, 0.0, 0.5)))
    world.spawn(CUBE, 'low', Pose((0.0, 0.0, 0.7)))
    world.spawn(CUBE, 'top', Pose((0.0, 0.05, 0.9)))
    slope = from_rpy(0.0, 0.3, 0.0)
    world.spawn(PLATE, 'slope', Pose((3.0, 0.0, 0.5), slope))
    across = 0.2 * math.sin(0.3), 0.2 * math.cos(0.3)
    world.spawn(CUBE, 'cube', Pose((3.0 + across[0], 0.0, 0.5 + across[1]), slope))
    world.spawn(CUBE, 'alone', Pose((0.0, -2.0, 0.15)))
    world.spawn(CUBE, 'hammer', Pose((-0.21, -2.0, 0.1)))
    world.spawn(SLIDER, 'slider', Pose())
    world.spawn(SLIDER, 'held', Pose((0.0, 3.0, 0.0)))
    world.models['held'].joints['rail'].set_motor(0.0, 15.0)  # more than its weight
    world.spawn(FLYWHEEL, 'flywheel', Pose((0.0, -4.0, 0.1)))


def roll(world):
    """Roll a ball far away, so that the engine goes on while others sleep."""
    world.spawn(urdf_spec(ball('link', 0.1, 1.0)), 'ball', Pose((0.0, 30.0, 0.1)))
    world.models['ball'].set_twist(Twist((1.0, 0.0, 0.0)))


def set_gravity(world):
    world.set_physics(replace(world.physics, gravity=(3.0, 0.0, -9.8)))


def lower_limit(world):
    model = world.models['slider']
    (joint,) = model.spec.joints
    model.respecify(replace(model.spec, joints=(replace(joint, lower=-0.5),)))


def spawn_below(world):
    world.spawn(PLATE, 'lift', Pose((0.0, -2.0, -0.05)))


def link_of(world, name):
    return world.models[name].links['link']


# What wakes, and the model that it moves.
WAKERS = {
    'force': (lambda w: link_of(w, 'alone').apply_wrench((20.0, 0, 0), (0, 0, 0)), 'alone'),
    'torque': (lambda w: link_of(w, 'alone').apply_wrench((0, 0, 0), (0, 0, 3.0)), 'alone'),
    'effort': (lambda w: w.models['flywheel'].joints['axle'].apply_effort(1.0), 'flywheel'),
    'target': (lambda w: w.models['flywheel'].joints['axle'].set_motor(1.0, 5.0), 'flywheel'),
    'velocity': (lambda w: w.models['alone'].set_twist(Twist((0.5, 0.0, 0.0))), 'alone'),
    'joint position': (lambda w: w.models['slider'].joints['rail'].set_position(0.0), 'slider'),
    'pose': (lambda w: w.models['alone'].set_pose(Pose((0.0, -2.0, 0.5))), 'alone'),
    'support deleted': (lambda w: w.delete('plate'), 'top'),
    'support moved': (lambda w: w.models['plate'].set_pose(Pose((0.0, 0.0, 0.3))), 'top'),
    'sleeping support deleted': (lambda w: w.delete('low'), 'top'),
    'sleeping support moved': (lambda w: w.models['low'].set_pose(Pose((2.0, 2.0, 3.0))), 'top'),
    'sleeping support pushed': (lambda w: w.models['low'].set_twist(Twist((1.0, 0, 0))), 'top'),
    'gravity': (set_gravity, 'top'),
    'friction': (lambda w: set_friction(w, 'cube', 0.05, 0.05), 'cube'),
    'mass': (lambda w: w.models['held'].scale_mass(3.0), 'held'),
    'slip': (lambda w: link_of(w, 'cube').set_slip_compliance((1, 0, 0), (0.1, 0.1)), 'cube'),
    'friction scaled': (lambda w: link_of(w, 'slope').scale_friction(0.05), 'cube'),
    'limit': (lower_limit, 'slider'),
    'hit': (lambda w: w.models['hammer'].set_twist(Twist((3.0, 0.0, 0.0))), 'alone'),
    'model spawned': (spawn_below, 'alone'),
    'reset': (lambda w: w.reset_world(), 'alone'),
}


def states(world):
    found = {}
    for name, model in world.models.items():
        for of_link, (pose, twist) in world.engine.link_states(model.body).items():
            found[name, of_link] = (*chain(*pose, *twist),)
    return found


def motion(act, tuning, busy):
    """Return the states of all links before a cause, and in the steps after it."""
    with empty_world(tuning) as world:
        furnish(world)
        if busy:
            roll(world)
        world.run(ASLEEP)
        if busy and tuning is not AWAKE:
            assert world.models['top'].twist == Twist(), 'it is to sleep'
        found = [states(world)]
        act(world)
        for steps in (1, 1, 1, 17, 80):
            world.run(steps)
            found.append(states(world))
        return found


@pytest.mark.parametrize('busy', [False, True], ids=['all asleep', 'some asleep'])
@pytest.mark.parametrize('waker', WAKERS)
def test_wakes_in_time(waker, busy):
    act, moved = WAKERS[waker]
    ours, awake = motion(act, None, busy), motion(act, AWAKE, busy)
    for step in range(1, len(awake)):
        # Within what contacts differ by chance. A step too late, gravity alone would lack 0.01 m/s.
        near, fast, turning = (5e-4, 2e-3, 0.03) if step < 4 else (5e-3, 0.05, 0.3)
        for key in awake[step].keys() & awake[0].keys():
            one, other = (
                [b - a for a, b in zip(run[0][key], run[step][key], strict=True)]
                for run in (ours, awake)
            )
            assert one[:7] == pytest.approx(other[:7], abs=near), (step, key)
            assert one[7:10] == pytest.approx(other[7:10], abs=fast), (step, key)
            assert one[10:] == pytest.approx(other[10:], abs=turning), (step, key)
    changes = (
        abs(a - b)
        for later in awake[1:]
        for key in awake[0]
        if key[0] == moved and key in later
        for a, b in zip(later[key][7:], awake[0][key][7:], strict=True)
    )
    assert max(changes) > 0.01, 'the cause has an effect'


def test_stands_still_to_the_last_bit(world):
    furnish(world)
    world.run(ASLEEP)
    before = states(world)
    contacts = world.engine.contacts(world.models['top'].body)
    world.run(1000)
    assert states(world) == before
    assert world.engine.contacts(world.models['top'].body) == contacts
    weight = sum(contact.force[2] for contact in contacts)
    assert weight == pytest.approx(9.8, rel=0.01), 'its contacts are reported, with the load'


def test_sleepers_beside_a_moving_one_report_their_contacts(world):
    furnish(world)
    world.models['alone'].set_twist(Twist((0.0, -1.0, 0.0)))
    world.models['flywheel'].joints['axle'].set_motor(1.0, 5.0)
    world.run(ASLEEP)
    assert world.models['top'].twist == Twist()
    contacts = world.engine.contacts(world.models['top'].body)
    assert sum(contact.force[2] for contact in contacts) == pytest.approx(9.8, rel=0.01)


@pytest.mark.parametrize('busy', [False, True], ids=['all asleep', 'some asleep'])
def test_moves_bit_for_bit_on_each_run_and_after_each_restore(busy):
    def scene(world):
        furnish(world)
        if busy:
            world.models['flywheel'].joints['axle'].set_motor(1.0, 5.0)
        world.run(ASLEEP)

    def ending(world):
        world.run(50)
        world.models['low'].set_twist(Twist((1.0, 0.0, 0.0)))
        world.run(3000)
        return states(world)

    ends = []
    for _ in range(2):
        with empty_world() as world:
            scene(world)
            state = world.save_state()
            for _ in range(3):
                ends.append(ending(world))
                world.restore(state)
            link_of(world, 'alone').apply_wrench((20.0, 0, 0), (0, 0, 0))
            world.run(30)
            world.restore(state)
            ends.append(ending(world))
    assert all(end == ends[0] for end in ends)


def test_a_robot_that_slept_starts_as_one_that_did_not():
    def distance(tuning):
        with empty_world(tuning) as world:
            robot = world.spawn(robot_spec(), 'rosbots', SPAWN_POSE)
            world.run(4000)
            start = robot.pose
            robot.plugin('diff_drive').command(0.5, 0.0)
            world.run(2000)
            return math.dist(robot.pose.position, start.position)

    assert distance(None) == pytest.approx(distance(AWAKE), abs=1e-4)


@pytest.mark.parametrize('busy', [False, True], ids=['all asleep', 'some asleep'])
def test_a_reaction_is_measured_from_the_next_step_on(world, busy):
    furnish(world)
    if busy:
        roll(world)
    world.run(ASLEEP)
    body = world.models['flywheel'].body
    world.engine.measure_reaction(body, 'axle')
    world.run(1)
    assert world.engine.joint_reaction(body, 'axle').force[2] == pytest.approx(9.8, rel=0.01)


def test_joints_are_read_as_they_are_set_though_others_sleep(world):
    furnish(world)
    body = world.models['flywheel'].body
    world.models['flywheel'].joints['axle'].set_motor(1.0, 5.0)
    world.run(ASLEEP)
    motion = world.engine.motion(body)
    world.engine.set_motion(body, replace(motion, joints={'axle': (0.5, -2.0)}))
    assert world.engine.joint_states(body)['axle'][:2] == (0.5, -2.0)


def test_motor_that_is_held_up_does_not_sleep(world):
    furnish(world)
    joint = world.models['slider'].joints['rail']
    joint.set_motor(0.2, 5.0)  # less than its weight
    world.run(ASLEEP)
    joint.apply_effort(0.0)
    world.run(1)
    assert joint.effort == pytest.approx(5.0)


@pytest.mark.parametrize(
    'remove',
    [lambda w: w.delete('post'), lambda w: w.models['post'].set_pose(Pose((3.0, 0.0, 0.2)))],
    ids=['deleted', 'moved'],
)
def test_a_stack_topples_exactly_when_its_support_goes(remove):
    def fall(tuning):
        """Return the steps from then until the top one has fallen to the ground, and where [m]."""
        with empty_world(tuning) as world:
            world.spawn(POST, 'other', Pose((-0.4, 0.0, 0.2)))
            world.spawn(POST, 'post', Pose((0.4, 0.0, 0.2)))
            world.spawn(PLANK, 'plank', Pose((0.0, 0.0, 0.45)))
            for k in range(3):
                world.spawn(CUBE, f'cube{k}', Pose((0.1, 0.0, 0.6 + 0.2 * k)))
            world.run(2000)
            before = states(world)
            world.run(2000)
            assert (states(world) == before) == (tuning is not AWAKE), 'it sleeps'
            remove(world)
            top, steps = world.models['cube2'], 0
            while top.pose.position[2] > 0.3 and steps < 2000:
                world.run(1)
                steps += 1
            return steps, top.pose.position

    (ours, place), (awake, other) = fall(None), fall(AWAKE)
    assert 500 < awake < 1000
    assert abs(ours - awake) <= 1
    assert math.dist(place, other) < 0.02
