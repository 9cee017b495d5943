"""Property tests: random scenes end alike whether what rests sleeps or not, and on each run."""

import math
import random
from dataclasses import replace

from hypothesis import given, settings
from hypothesis import strategies as st
from support import empty_world, urdf_spec
from support.scenes import box

from rosbots_description.sim.core.transforms import Pose, Twist, from_rpy
from rosbots_description.sim.physics.bullet.tuning import Tuning

AWAKE = Tuning(rest=math.inf)
# Where a box may end beside where it ends awake [m]. Some scenes are chaotic, a box topples or not:
# there, by as much further as it ends elsewhere awake if all boxes start by up to ASIDE aside.
NEAR = 5e-3
ASIDE, VARIANTS = 1e-3, 8
SIZES = (0.2, 0.2, 0.2), (0.3, 0.2, 0.1), (0.2, 0.3, 0.15)
PLATE = replace(urdf_spec(box('link', (0.4, 0.6, 0.1), 1.0)), static=True)

SEEDS = st.integers(0, 2**32 - 1)


def furnish(world, chance, variant=0):
    """Spawn boxes in a row, some on static plates, some on each other; return the boxes' names."""
    aside, most = random.Random(variant), ASIDE if variant else 0.0
    names = []
    for i in range(chance.randint(3, 6)):
        top = 0.0
        if chance.random() < 0.4:
            world.spawn(PLATE, f'plate{i}', Pose((0.45 * i, 0.0, 0.05)))
            top = 0.1
        for k in range(chance.choice((1, 1, 2))):
            size = chance.choice(SIZES)
            x, y = (chance.uniform(-0.03, 0.03) + aside.uniform(-most, most) for _ in 'xy')
            place = Pose((0.45 * i + x, y, top + size[2] / 2.0), from_rpy(0, 0, chance.random()))
            spec = urdf_spec(box('link', size, chance.uniform(0.5, 3.0)))
            names.append(world.spawn(spec, f'box{i}_{k}', place).name)
            top += size[2]
    return names


def act(world, chance, boxes, deletes):
    """Do something to a random box or plate."""
    model = world.models[chance.choice([name for name in boxes if name in world.models])]
    plates = [name for name in world.models if name.startswith('plate')]
    (x, y, z), turn = model.pose
    u, v = chance.uniform(-0.5, 0.5), chance.uniform(-0.5, 0.5)
    match chance.choice(('twist', 'push', 'lift', 'grease', 'lower', 'delete')):
        case 'twist':
            model.set_twist(Twist((u, v, 0.0)))
        case 'push':
            model.links['link'].apply_wrench((500.0 * u, 500.0 * v, 0.0), (0.0, 0.0, 0.0))
        case 'lift':
            model.set_pose(Pose((x, y + 0.02, z + 0.001), turn))
        case 'grease':
            model.links['link'].scale_friction(2.0 * abs(u))
        case 'lower' if plates:
            plate = world.models[chance.choice(plates)]
            x, y, z = plate.pose.position
            plate.set_pose(Pose((x, y, z - 0.02)))
        case 'delete' if deletes and len(world.models) > 2:
            world.delete(chance.choice([*world.models][1:]))


def ending(seed, tuning, variant=0):
    """Return where the boxes end, after some rests that an act ends, or all of them [m]."""
    chance = random.Random(seed)
    with empty_world(tuning) as world:
        boxes = furnish(world, chance, variant)
        for _ in range(5):
            world.run(chance.randint(500, 2500))
            if any(name in world.models for name in boxes):
                act(world, chance, boxes, deletes=True)
        world.run(2500)
        return {name: world.models[name].pose.position for name in boxes if name in world.models}


@given(SEEDS)
@settings(max_examples=settings.default.max_examples // 4)
def test_a_random_scene_ends_as_without_sleep(seed):
    asleep, awake = ending(seed, None), ending(seed, AWAKE)
    far = [name for name, place in awake.items() if math.dist(asleep[name], place) > NEAR]
    others = [ending(seed, AWAKE, variant) for variant in range(1, VARIANTS) if far]
    for name in far:
        spread = max(math.dist(other[name], awake[name]) for other in others)
        assert math.dist(asleep[name], awake[name]) <= NEAR + spread, name


@given(SEEDS)
@settings(max_examples=1 + settings.default.max_examples // 8)
def test_a_random_scene_repeats_bit_for_bit_on_each_run_and_after_each_restore(seed):
    def after(world, boxes):
        chance = random.Random(seed)
        for _ in range(3):
            act(world, chance, boxes, deletes=False)
            world.run(chance.randint(500, 2500))
        return [(model.pose, model.twist) for model in world.models.values()]

    ends = []
    for _ in range(2):
        chance = random.Random(seed)
        with empty_world() as world:
            boxes = furnish(world, chance)
            world.run(chance.randint(500, 2500))
            state = world.save_state()
            for _ in range(2):
                ends.append(after(world, boxes))
                world.restore(state)
    assert all(end == ends[0] for end in ends)
