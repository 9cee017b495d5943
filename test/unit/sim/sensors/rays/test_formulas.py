"""Ray hits lie on the surface of shapes, by an independent definition."""

import itertools
import math

import numpy as np
import pytest

from rosbots_description.sim.sensors.rays import formulas
from rosbots_description.sim.sensors.rays.fan import RayFan, Sweep

HALF = {'sphere': (0.7, 0.7, 0.7), 'box': (0.5, 0.8, 0.3), 'cylinder': (0.6, 0.6, 0.9)}
EXACT = 1e-12  # [m]


def outside(kind, points):
    """Return the approximate signed distance of points (3, n) from a shape [m]; negative inside."""
    x, y, z = points
    hx, hy, hz = HALF[kind]
    match kind:
        case 'sphere':
            return np.sqrt(x * x + y * y + z * z) - hx
        case 'box':
            return np.maximum.reduce([np.abs(x) - hx, np.abs(y) - hy, np.abs(z) - hz])
    return np.maximum(np.hypot(x, y) - hx, np.abs(z) - hz)


def meet(kind, starts, ways, least=0.0):
    starts, ways = np.array(starts, float).T, np.array(ways, float).T
    half = np.repeat(np.array([HALF[kind]]).T, starts.shape[1], axis=1)
    return formulas.first_from(least, *getattr(formulas, kind)(starts, ways, half))


def many_rays(count=20_000):
    random = np.random.default_rng(1)
    ways = random.normal(size=(count, 3))
    return random.uniform(-2.0, 2.0, (count, 3)), ways / np.linalg.norm(ways, axis=1)[:, None]


@pytest.mark.parametrize('kind', HALF)
def test_hit_is_the_first_point_on_the_surface(kind):
    starts, ways = many_rays()
    met = meet(kind, starts, ways)
    hit = np.isfinite(met)
    assert hit.sum() > 1000
    points = (starts + ways * np.where(hit, met, 0.0)[:, None]).T
    assert np.abs(outside(kind, points[:, hit])).max() < EXACT
    inside = outside(kind, starts.T) < 0.0
    for share in np.linspace(0.0, 1.0, 41)[1:-1]:
        on_the_way = (starts + ways * (np.where(hit, met, 6.0) * share)[:, None]).T
        beyond = outside(kind, on_the_way)
        assert (beyond[~inside] > -EXACT).all()
        assert (beyond[inside] < EXACT).all()


@pytest.mark.parametrize(
    ('kind', 'start', 'way', 'expected'),
    [
        ('box', (-2, 0, 0), (1, 0, 0), 1.5),
        ('box', (-2, 0.799, 0), (1, 0, 0), 1.5),
        ('box', (-2, 0.81, 0), (1, 0, 0), math.inf),
        ('box', (2, 0, 0), (1, 0, 0), math.inf),
        ('box', (0, 0, 0), (0, 0, 1), 0.3),
        ('cylinder', (0.1, 0, 3), (0, 0, -1), 2.1),
        ('cylinder', (0.61, 0, 3), (0, 0, -1), math.inf),
        ('cylinder', (-2, 0, 0.899), (1, 0, 0), 1.4),
        ('cylinder', (-2, 0, 0.91), (1, 0, 0), math.inf),
        ('cylinder', (0, 0, 0), (0, 0, 1), 0.9),
        ('cylinder', (0, 0, 0), (0, -1, 0), 0.6),
        ('sphere', (0, -3, 0), (0, 1, 0), 2.3),
        ('sphere', (0, -3, 0.71), (0, 1, 0), math.inf),
        ('sphere', (0, 0, 0), (0, 1, 0), 0.7),
    ],
)
def test_rays_along_axes_and_edges(kind, start, way, expected):
    assert meet(kind, [start], [way])[0] == pytest.approx(expected, abs=EXACT)


@pytest.mark.parametrize(
    ('least', 'expected'),
    [
        (1.0, 1.5),
        (1.5, 1.5),
        (1.6, 2.5),
        (2.5, 2.5),
        (2.6, math.inf),
    ],
)
def test_ray_from_inside_hits_the_far_side(least, expected):
    assert meet('box', [(-2, 0, 0)], [(1, 0, 0)], least)[0] == pytest.approx(expected)


SWEEPS = pytest.mark.parametrize(
    'columns',
    [
        Sweep(720, 720, -1.5708, 1.5708),
        Sweep(360, 360, -math.pi, math.pi),
        Sweep(90, 90, 3.0, -3.0),
        Sweep(400, 400, 0.0, 2 * math.pi),
        Sweep(500, 500, -7.0, 8.0),
        Sweep(1, 1, 0.5, 1.0),
        Sweep(5, 5, 0.3, 0.3),
    ],
)
ROWS = pytest.mark.parametrize(
    'rows',
    [
        Sweep(1, 1, 0.0, 0.0),
        Sweep(16, 16, -0.26, 0.26),
        Sweep(9, 9, 1.6, -1.6),
    ],
)


def corners_of(halves):
    """Return the corners (3, 8, m) of boxes with these half extents (m, 3)."""
    signs = np.array(list(itertools.product((-1.0, 1.0), repeat=3)))
    return (signs[None] * halves[:, None]).transpose(2, 1, 0)


def kept_by(fan, centres, radii, halves):
    """Return the pairs of shape and ray that may meet within 4 m."""
    some = fan.may_meet(centres, radii, halves[:, 2], 4.0)
    patches = fan.near(centres[some], radii[some], corners_of(halves[some]), 4.0)
    which, rays, _ = fan.rays(patches)
    assert rays.size == 0 or rays.max() < fan.ways.shape[1]
    return set(zip(some[patches.shapes[which]].tolist(), rays.tolist(), strict=True))


@SWEEPS
@ROWS
def test_culling_keeps_every_ray_that_hits_a_ball(rows, columns):
    fan = RayFan(rows, columns)
    random = np.random.default_rng(2)
    centres, radii = random.uniform(-5.0, 5.0, (60, 3)), random.uniform(0.01, 3.0, 60)
    along = centres @ fan.ways
    apart = (centres**2).sum(axis=1)[:, None] - along**2
    inside = (centres**2).sum(axis=1) < radii**2
    reach = along - np.sqrt(np.maximum(radii[:, None] ** 2 - apart, 0.0))
    meets = (apart < radii[:, None] ** 2) & ((along > 0.0) & (reach < 4.0) | inside[:, None])
    needed = set(zip(*(part.tolist() for part in np.nonzero(meets)), strict=True))
    assert needed
    assert needed <= kept_by(fan, centres, radii, np.repeat(radii[:, None], 3, axis=1))


@SWEEPS
@ROWS
def test_culling_keeps_every_ray_that_hits_a_box(rows, columns):
    fan = RayFan(rows, columns)
    random = np.random.default_rng(3)
    centres, halves = random.uniform(-4.0, 4.0, (60, 3)), random.uniform(0.01, 2.0, (60, 3))
    needed = set()
    for shape, (centre, half) in enumerate(zip(centres, halves, strict=True)):
        start = -centre[:, None] + 0.0 * fan.ways
        met = formulas.first_from(0.0, *formulas.box(start, fan.ways, half[:, None]))
        needed |= {(shape, ray) for ray in np.flatnonzero(met < 4.0).tolist()}
    assert needed
    assert needed <= kept_by(fan, centres, np.linalg.norm(halves, axis=1), halves)


@np.errstate(all='raise')  # the second ball is on the axis of the columns
def test_culling_for_a_small_ball_keeps_few_rays():
    fan = RayFan(Sweep(1, 1, 0.0, 0.0), Sweep(720, 720, -1.5708, 1.5708))
    centres = np.array([[5.0, 0.0, 0.0], [0.0, 0.0, 5.0]])
    assert fan.may_meet(centres, np.ones(2), np.ones(2), 9.0).tolist() == [0]
    _, rays, _ = fan.rays(fan.near(centres[:1], np.ones(1), corners_of(np.ones((1, 3))), 9.0))
    assert len(rays) == pytest.approx(2 * math.asin(0.2) / math.pi * 720, abs=2)


LEVEL = Sweep(1, 1, 0.0, 0.0)


@pytest.mark.parametrize(
    ('rows', 'centre', 'is_kept'),
    [
        # A ball of 1 m, and level rays of 9 m ahead and to both sides.
        (LEVEL, (9.99, 0.0, 0.0), True),
        (LEVEL, (10.01, 0.0, 0.0), False),
        (LEVEL, (-0.99, 5.0, 0.0), True),
        (LEVEL, (-1.01, 5.0, 0.0), False),
        (LEVEL, (5.0, 0.0, 0.99), True),
        (LEVEL, (5.0, 0.0, 1.01), False),
        (LEVEL, (5.0, 0.0, -0.99), True),
        (LEVEL, (5.0, 0.0, -1.01), False),
        # Rays between two elevations [rad]: the ball touches the cone of the last ones, or not.
        *(
            (Sweep(5, 5, -0.2, 0.3), (math.cos(angle), 0.0, math.sin(angle)), kept)
            for limit, side in ((-0.2, -1.0), (0.3, 1.0))
            for angle, kept in (
                (limit + side * (math.asin(0.2) - 0.01), True),
                (limit + side * (math.asin(0.2) + 0.01), False),
            )
        ),
    ],
)
def test_culling_drops_balls_out_of_reach_behind_above_and_below(rows, centre, is_kept):
    fan = RayFan(rows, Sweep(720, 720, -1.5707, 1.5707))
    size = 5.0 if rows is not LEVEL else 1.0  # five metres away
    centres = size * np.array([centre])
    assert len(fan.may_meet(centres, np.ones(1), np.ones(1), 9.0)) == is_kept


@pytest.mark.parametrize('side', [-1.0, 1.0])
def test_culling_keeps_rays_that_graze_a_ball(side):
    limb = math.asin(0.2) - 1e-9
    for rows, columns in (
        (LEVEL, Sweep(2, 2, 0.0, side * limb)),
        (Sweep(2, 2, 0.0, side * limb), LEVEL),
    ):
        fan = RayFan(rows, columns)
        centres, radii = np.array([[5.0, 0.0, 0.0]]), np.ones(1)
        some = fan.may_meet(centres, radii, radii, 9.0)
        patches = fan.near(centres[some], radii, corners_of(np.ones((1, 3))), 9.0)
        assert sorted(fan.rays(patches)[1].tolist()) == [0, 1]


def test_readings_between_rays_are_interpolated_in_rows_and_columns():
    rows, columns = Sweep(2, 3, -0.1, 0.1), Sweep(3, 5, -1.0, 1.0)
    blend = RayFan(rows, columns).blend
    ray_row, ray_column = np.divmod(np.arange(6), 3)
    row, column = np.divmod(np.arange(15), 5)
    linear = blend.ranges(10.0 * ray_row + 3.0 * ray_column + 7.0)
    np.testing.assert_allclose(linear, 10.0 * row / 2.0 + 3.0 * column / 2.0 + 7.0)
    # The intensity is the mean of four rays, the last ones twice at the end.
    cast = np.array([1.0, 2.0, 4.0, 8.0, 16.0, 32.0])
    expected = [
        (cast[a] + cast[b] + cast[c] + cast[d]) / 4.0
        for a, b, c, d in ((0, 1, 3, 4), (0, 1, 3, 4), (1, 2, 4, 5), (1, 2, 4, 5), (2, 2, 5, 5))
    ]
    expected += [
        *expected,
        *((cast[a] + cast[b]) / 2.0 for a, b in ((3, 4), (3, 4), (4, 5), (4, 5), (5, 5))),
    ]
    np.testing.assert_allclose(blend.intensities(cast), expected)
    assert blend.rows.tolist() == [0.5, 0.5, 1.0]
    assert blend.columns.tolist() == [0.5, 0.5, 1.5, 1.5, 2.0]


def test_a_single_reading_or_ray_is_taken_as_it_is():
    blend = RayFan(Sweep(1, 1, 0.0, 0.0), Sweep(1, 3, 0.0, 0.0)).blend
    assert blend.ranges(np.array([5.0])).tolist() == [5.0, 5.0, 5.0]
    blend = RayFan(Sweep(1, 1, 0.0, 0.0), Sweep(3, 1, 0.0, 1.0)).blend
    assert blend.ranges(np.array([5.0, 6.0, 7.0])).tolist() == [5.0]


def test_equal_fans_are_shared_and_a_single_ray_is_at_zero():
    one = RayFan.of(LEVEL, Sweep(3, 3, -0.5, 0.5))
    assert RayFan.of(LEVEL, Sweep(3, 3, -0.5, 0.5)) is one
    assert RayFan.of(LEVEL, Sweep(3, 3, -0.5, 0.6)) is not one
    assert Sweep(1, 1, 0.5, 1.0).angles.tolist() == [0.0]
    np.testing.assert_allclose(
        one.ways.T, [(math.cos(yaw), math.sin(yaw), 0.0) for yaw in (-0.5, 0.0, 0.5)]
    )


def test_culling_for_a_long_wall_keeps_the_rays_between_its_ends():
    fan = RayFan(Sweep(1, 1, 0.0, 0.0), Sweep(720, 720, -1.5708, 1.5708))
    half = np.array([[0.1, 2.0, 1.0]])
    _, rays, _ = fan.rays(
        fan.near(np.array([[4.0, 0.0, 0.0]]), np.linalg.norm(half, axis=1), corners_of(half), 9.0)
    )
    assert len(rays) == pytest.approx(2 * math.atan2(2.0, 3.9) / math.pi * 720, abs=2)
