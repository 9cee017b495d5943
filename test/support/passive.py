"""Passive scenes recorded in Gazebo: bodies that fall, slide, roll and swing."""

import math
from collections.abc import Callable, Iterator
from itertools import pairwise

from rosbots_description.sim.core.transforms import Twist
from rosbots_description.sim.formats.sdf.world_file import open_world
from rosbots_description.sim.resources.search_path import ModelSearch
from rosbots_description.sim.runtime.model import Joint, Link
from rosbots_description.sim.runtime.population import populate
from rosbots_description.sim.runtime.world import World

from .mechanics import MOTIONS, REBOUNDS, Motions, Rebounds
from .recorded import DATA, Difference, load

SCENES = (
    'push', 'mu_pairs', 'mu_pairs_diag', 'slope', 'roll', 'sleep', 'stack', 'bounce',
    'bounce_defaults', 'bounce_plate', 'pendulum', 'prismatic',
)  # fmt: skip
# Tolerances relative to the largest recorded value, with lower bounds (floors).
# The floors are those of comparisons with mechanics.
PLACE_SHARE, PLACE_FLOOR = 0.04, 0.002  # [m]
SPEED_SHARE, SPEED_FLOOR = 0.03, 0.02  # [m/s]
ANGLE_SHARE, ANGLE_FLOOR = 0.03, 0.01  # [rad]
RATE_FLOOR = 0.05  # [rad/s]
JOINT_SHARE, JOINT_FLOOR = 0.03, 0.005  # [rad or m], and the same per second
REBOUND_SHARE, BOUNCES = 0.03, 3


def compare_scene(name: str) -> list[Difference]:
    """Return the differences in all recorded quantities of a passive scene.

    Some of them are from mechanics, see support/mechanics.py.
    """
    data = load(name)
    ours = _run(name)
    found = []
    for link, rows in data.get('links', {}).items():
        found += _compare_link(name, link, rows, ours)
    for joint, rows in data.get('joints', {}).items():
        found += _compare_joint(name, joint, rows, ours)
    for motions in (one for one in MOTIONS if one.scene == name):
        for link in (f'{one}::link' for one in motions.links):
            found += _compare_motion(motions, link, data['links'][link], ours)
    found += [_compare_rebounds(one, ours) for one in REBOUNDS if one.scene == name]
    return found


def _run(name: str) -> dict[tuple[str, int], tuple]:
    """Return the state of each link and joint at each step of the recording, by both.

    Those of `REBOUNDS` at every step.
    """
    data = load(name)
    world = World()
    try:
        populate(world, open_world(DATA / 'worlds' / f'{name}.world', find_model=ModelSearch()))
        wanted: dict[int, list[str]] = {}
        for kind in ('links', 'joints'):
            for target, rows in data.get(kind, {}).items():
                for row in rows:
                    wanted.setdefault(round(1000 * row[0]), []).append(target)
        events, states = list(_events(world, data['events'])), {}
        always = [f'{one.link}::link' for one in REBOUNDS if one.scene == name]
        for step in range(max(wanted) + 1):
            for begin, end, act in events:
                if begin <= step < end:
                    act()
            world.run(1)
            for target in (*wanted.get(step, ()), *always):
                states[target, step] = _find(world, target).state()
        return states
    finally:
        world.close()


def _events(world: World, events: list) -> Iterator[tuple[int, int, Callable[[], None]]]:
    """Yield events as (first step, step after the last, action)."""
    for kind, time, duration, target, values in events:
        thing, first = _find(world, target), round(1000 * time)
        last = first + max(1, round(1000 * duration))
        if kind == 'vel':
            twist = Twist(tuple(values[:3]), tuple(values[3:]))
            yield first, last, lambda m=thing.model, t=twist: m.set_twist(t)
        elif kind == 'force':
            yield (
                first,
                last,
                lambda link=thing, v=values: link.apply_wrench(tuple(v[:3]), tuple(v[3:])),
            )
        elif kind == 'jpos':
            yield first, last, lambda j=thing, v=values: j.set_position(v[0])
        elif kind == 'jforce':
            yield first, last, lambda j=thing, v=values: j.apply_effort(v[0])
        else:
            raise ValueError(f'unknown event {kind!r}')


def _find(world: World, target: str) -> Link | Joint:
    model, _, name = target.partition('::')
    found = world.models[model]
    return found.links[name] if name in found.links else found.joints[name]


def _compare_link(scene: str, link: str, rows: list, ours: dict) -> Iterator[Difference]:
    start = rows[0][1:4]
    far = max(math.dist(start, row[1:4]) for row in rows)
    turned = max(_angle(rows[0][4:8], row[4:8]) for row in rows)
    fast = max(math.hypot(*row[8:11]) for row in rows)
    spun = max(math.hypot(*row[11:14]) for row in rows)
    for (quantity, unit, value), tolerance in zip(
        _most_apart(link, rows, ours),
        (
            max(PLACE_SHARE * far, PLACE_FLOOR),
            max(ANGLE_SHARE * turned, ANGLE_FLOOR),
            max(SPEED_SHARE * fast, SPEED_FLOOR),
            max(SPEED_SHARE * spun, RATE_FLOOR),
        ),
        strict=True,
    ):
        yield Difference(scene, f'{link} {quantity}', unit, 0.0, value, tolerance)


def _compare_motion(motions: Motions, link: str, rows: list, ours: dict) -> Iterator[Difference]:
    """Compare with mechanics at the times of a recording."""
    expected = [
        [
            time,
            *(
                number
                for numbers in motions.motion(rows[0], round(1000 * time) + 1)
                for number in numbers
            ),
        ]
        for time, *_ in rows
    ]
    for (quantity, unit, value), floor in zip(
        _most_apart(link, expected, ours),
        (PLACE_FLOOR, ANGLE_FLOOR, SPEED_FLOOR, RATE_FLOOR),
        strict=True,
    ):
        if quantity in motions.quantities.split():
            yield Difference(
                motions.scene,
                f'{link} {quantity}',
                unit,
                0.0,
                value,
                motions.leeway * floor,
                reference='mechanics',
                reason=motions.reason,
            )


def _most_apart(link: str, rows: list, ours: dict) -> list[tuple[str, str, float]]:
    """Return the largest differences; None in a row is not compared."""
    pairs = [(ours[link, round(1000 * time)], row) for time, *row in rows]
    return [
        ('place', 'm', max(_apart(pose.position, row[:3]) for (pose, _), row in pairs)),
        ('orientation', 'rad', max(_angle(pose.orientation, row[3:7]) for (pose, _), row in pairs)),
        ('velocity', 'm/s', max(_apart(twist.linear, row[7:10]) for (_, twist), row in pairs)),
        ('spin', 'rad/s', max(_apart(twist.angular, row[10:]) for (_, twist), row in pairs)),
    ]


def _compare_rebounds(ball: Rebounds, ours: dict) -> Difference:
    """Compare the height that a rebound reaches, as a share of the one before, with e²."""
    heights = [
        state[0].position[2] - ball.rest
        for (link, _), state in sorted(ours.items(), key=lambda item: item[0][1])
        if link == f'{ball.link}::link'
    ]
    tops = [
        heights[0],
        *(b for a, b, c in zip(heights, heights[1:], heights[2:], strict=False) if a < b >= c),
    ]
    shares = [b / a for a, b in pairwise(tops[: BOUNCES + 1])]
    worst = max(shares, key=lambda share: abs(share - ball.e**2))
    return Difference(
        ball.scene,
        f'{ball.link}::link rebound',
        '1',
        ball.e**2,
        worst,
        REBOUND_SHARE * ball.e**2,
        reference='mechanics',
        reason=ball.reason,
    )


def _compare_joint(scene: str, joint: str, rows: list, ours: dict) -> Iterator[Difference]:
    apart = faster = 0.0
    for time, position, velocity in rows:
        own = ours[joint, round(1000 * time)]
        apart = max(apart, abs(own[0] - position))
        faster = max(faster, abs(own[1] - velocity))
    reach = max(abs(position) for _, position, _ in rows)
    fast = max(abs(velocity) for *_, velocity in rows)
    yield Difference(
        scene, f'{joint} position', 'rad|m', 0.0, apart, max(JOINT_SHARE * reach, JOINT_FLOOR)
    )
    yield Difference(
        scene, f'{joint} velocity', '/s', 0.0, faster, max(JOINT_SHARE * fast, JOINT_FLOOR)
    )


def _apart(a, b) -> float:
    """Return the distance of two vectors, in the components that both have."""
    return math.hypot(*(x - y for x, y in zip(a, b, strict=True) if None not in (x, y)))


def _angle(a, b) -> float:
    """Return the angle between two orientations [rad]; none if one is not known."""
    if None in (*a, *b):
        return 0.0
    cosine = abs(sum(x * y for x, y in zip(a, b, strict=True)))
    length = math.hypot(*a) * math.hypot(*b)
    return 2.0 * math.acos(min(1.0, cosine / length))
