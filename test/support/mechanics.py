"""What mechanics says of recorded scenes where Gazebo contradicts it.

There the motion is compared with mechanics instead. A state of a body has None for what has no
closed form, as while a cube tumbles.
"""

import math
from collections.abc import Callable, Sequence
from typing import NamedTuple

G, DT = 9.8, 0.001  # [m/s²], [s]
STILL = (0.0, 0.0, 0.0)
UNKNOWN = (None, None, None)
ANY = (None, None, None, None)  # orientation

Numbers = tuple[float | None, ...]
Row = Sequence[float]  # time, position, quaternion, velocity, angular velocity


class State(NamedTuple):
    """Position [m], quaternion, velocity [m/s] and angular velocity [rad/s] in the world."""

    position: Numbers
    orientation: Numbers
    velocity: Numbers = STILL
    spin: Numbers = STILL


Motion = Callable[[Row, int], State]  # of the first row, and of the number of steps made


class Motions(NamedTuple):
    """The motion of links of a scene, compared in these quantities; and what Gazebo does."""

    scene: str
    links: tuple[str, ...]
    quantities: str
    motion: Motion
    reason: str
    leeway: float = 1.0  # of the least tolerances of support/passive.py


def falls(to: float, faces: bool = True) -> Motion:
    """Return a free fall to a height [m], without a rebound.

    Args:
        faces: whether it lands as it fell, and does not tumble until it lies still.
    """

    def motion(first: Row, steps: int) -> State:
        height = first[3] - G * DT**2 * steps * (steps + 1) / 2  # semi-implicit Euler
        if height > to:
            return State((*first[1:3], height), tuple(first[4:8]), (0.0, 0.0, -G * DT * steps))
        return State((*first[1:3], to), tuple(first[4:8])) if faces else tumbled(to)(first, steps)

    return motion


def tumbled(height: float, still: float = 1.5) -> Motion:
    """Return a tumbling cube: nothing is known until it has lain on a face for some time [s]."""

    def motion(_: Row, steps: int) -> State:
        if steps * DT < still:
            return State(UNKNOWN, ANY, UNKNOWN, UNKNOWN)
        return State((None, None, height), ANY)

    return motion


def pushed_to_tipping(first: Row, steps: int) -> State:
    """Return a cube on mu 1, pushed from 1 s on by 1.27 of its weight; then it tumbles for 2 s."""
    pushed = max(0.0, steps * DT - 1.0)
    if pushed > 0.25:  # until here it pitches by less than 0.01 rad
        return tumbled(0.25, 4.0)(first, steps)
    excess = 25.0 / 2.0 - G
    return State((excess * pushed**2 / 2, 0.0, None), ANY, (excess * pushed, 0.0, None), UNKNOWN)


def slides(begin: float, mu: float) -> Motion:
    """Return a body at rest that gets 1 m/s along x at a time [s], and is braked by friction."""

    def motion(first: Row, steps: int) -> State:
        time = max(0.0, steps * DT - begin)
        time = min(time, 1.0 / (mu * G)) if time else 0.0
        speed = 1.0 - mu * G * time if time else 0.0
        return State(
            (first[1] + time - mu * G * time**2 / 2, *first[2:4]),
            tuple(first[4:8]),
            (speed, 0.0, 0.0),
        )

    return motion


def rolls(
    begin: float,
    inertia: float,
    radius: float,
    drag: float = 0.0,
    pushes: tuple[float, float, float] = (0.0, 0.0, 0.0),
) -> Motion:
    """Return a round body that gets 1 m/s along x on mu 1, slides until it rolls, and rolls on.

    Args:
        begin: of the motion [s].
        inertia: about the axis, in m r².
        radius: of the body [m].
        drag: rolling resistance, as a share of the weight.
        pushes: begin [s], duration [s] and specific force [N/kg] of a push at the centre.
    """
    rolling, until = 1.0 / (1.0 + inertia), inertia / (1.0 + inertia) / G

    def motion(first: Row, steps: int) -> State:
        time = max(0.0, steps * DT - begin)
        if not time:
            return State(tuple(first[1:4]), tuple(first[4:8]))
        sliding, on = min(time, until), max(0.0, time - until)
        pushed = min(max(0.0, steps * DT - pushes[0]), pushes[1])
        after = max(0.0, steps * DT - pushes[0] - pushes[1])
        speed = 1.0 - G * sliding - drag * G * rolling * on + pushes[2] * rolling * pushed
        rolled = (
            (1.0 - G * until) * on
            - drag * G * rolling * on**2 / 2
            + pushes[2] * rolling * pushed * (pushed / 2 + after)
        )
        spin = speed / radius if on else G * sliding / inertia / radius
        turned = G * sliding**2 / (2 * inertia * radius) + rolled / radius
        half = turned / 2
        return State(
            (first[1] + sliding - G * sliding**2 / 2 + rolled, *first[2:4]),
            times((0.0, math.sin(half), 0.0, math.cos(half)), first[4:8]),
            (speed, 0.0, 0.0),
            (0.0, spin, 0.0),
        )

    return motion


def times(a: Row, b: Row) -> tuple[float, ...]:
    """Return the product of two quaternions (x, y, z, w)."""
    return (
        a[3] * b[0] + a[0] * b[3] + a[1] * b[2] - a[2] * b[1],
        a[3] * b[1] - a[0] * b[2] + a[1] * b[3] + a[2] * b[0],
        a[3] * b[2] + a[0] * b[1] - a[1] * b[0] + a[2] * b[3],
        a[3] * b[3] - a[0] * b[0] - a[1] * b[1] - a[2] * b[2],
    )


def turns_not(after: float = 0.0) -> Motion:
    """Return a body of which only this is known, from a time [s] on."""

    def motion(_: Row, steps: int) -> State:
        return State(UNKNOWN, ANY, UNKNOWN, STILL if steps * DT > after else UNKNOWN)

    return motion


ALL = 'place orientation velocity spin'
_STACK = 'a stack of five cubes stands; in Gazebo it collapses after 3.2 s'
_CREEP = 'stacked cubes do not creep; in Gazebo by 6 cm'
_EDGE = 'a box stays there whose centre of mass is 8 cm inside the edge of the one below'
_JUMP = 'no rebound from a restitution of 0; in Gazebo all of 0.5, 0.8 and 1 rise by 0.56 m'
_CALM = 'a cube on a plane does not rock; in Gazebo it does at 0.07 rad/s, without end'
_SLEEP = 'no body sleeps; in Gazebo a velocity of 1 m/s does not move one that does'
MOTIONS = (
    Motions('stack', ('a0', 'a1', 'a2', 'a3', 'a4'), ALL, lambda first, steps:
            falls(first[3])(first, steps), _STACK),
    *(Motions('stack', (f'g{n}',), ALL, falls(0.1 + 0.2 * n), _CREEP) for n in range(4)),
    Motions('stack', ('p0',), 'place velocity spin', falls(0.1), _EDGE),
    Motions('stack', ('p1',), ALL, falls(0.3), _EDGE),
    Motions('bounce', ('r0.5', 'r0.8', 'r1'), 'place velocity', falls(0.2), _JUMP),
    Motions('bounce_plate', ('r0.8_on0',), 'place velocity', falls(0.3), _JUMP),
    Motions('bounce', ('soft',), 'place velocity', falls(0.199),
            '1e4 N/m yield 1 mm under 1 kg; in Gazebo 46 mm'),
    Motions('bounce', ('bx0.6',), 'place velocity spin', falls(0.2, faces=False), _JUMP),
    Motions('sleep', ('awake',), 'place velocity', slides(2.0, 1.0),
            f'{_SLEEP}; the first step brakes twice: 5 % less way', leeway=1.4),
    Motions('sleep', ('asleep',), ALL, rolls(2.0, 0.4, 0.2, pushes=(4.0, 0.1, 5.0)), _SLEEP),
    Motions('roll', ('c',), ALL, rolls(0.05, 0.5, 0.15, drag=0.0031),
            'a rolling can is braked by 0.0031 of its weight; in Gazebo by nothing', leeway=2.5),
    Motions('push', ('b_mu1',), 'place velocity spin', pushed_to_tipping,
            '25 N at half the height of a cube with mu 1: at the limit of tipping'),
    *(Motions(scene, (link,), 'spin', turns_not(after), _CALM) for scene, link, after in (
        ('mu_pairs', 'f3', 0.0), ('mu_pairs', 'f4', 0.0), ('mu_pairs', 'f5', 0.3),
        ('mu_pairs_diag', 'f1', 0.0), ('mu_pairs_diag', 'f2', 0.0), ('mu_pairs_diag', 'f3', 0.0),
        ('slope', 'b6', 0.0), ('push', 'b_mu0.2_heavy', 0.0))),
)  # fmt: skip


class Rebounds(NamedTuple):
    """A ball that falls on a plate: each rebound reaches e² of the height before."""

    scene: str
    link: str
    e: float  # coefficient of restitution
    rest: float  # [m] height of the ball at rest
    reason: str


REBOUNDS = (
    Rebounds(
        'bounce_plate',
        'r0.8_on0.8',
        0.8,
        0.3,
        'a rebound is 2 % higher here than in Gazebo, so the fifth is 40 ms later',
    ),
    Rebounds(
        'bounce_plate',
        'r0.8_on0.5',
        math.sqrt(0.8 * 0.5),
        0.3,
        'restitution is 0.63, the geometric mean; in Gazebo 0.75, as for 0.8 on 0',
    ),
)


# Of drives: scene, quantity, value, and reason.
DRIVES = (
    ('planar turn_w1.0', 'w', 4.262062 / 5.0, 'Gazebo says 0.904, but turns by 4.262 rad in 5 s'),
)
