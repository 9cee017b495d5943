"""A map has exactly the cells in which something is."""

import math
import random

import numpy as np
import pytest

from rosbots_description.sim import (
    ModelError,
    NotFoundError,
    Pose,
    SimError,
    World,
    from_rpy,
)
from rosbots_description.sim.core import compose, inverse
from rosbots_description.sim.description import (
    Box,
    Collision,
    Cylinder,
    LinkSpec,
    Mesh,
    ModelSpec,
    Sphere,
)

XACRO = 'package://rosbots_description/urdf/rosbots.xacro'
HEIGHT, CELL, FINE = 0.3, 0.1, 40  # [m]; samples along the edge of a cell


def still(geometry, name='thing'):
    return ModelSpec(name, (LinkSpec('link', collisions=(Collision('c', geometry),)),), static=True)


def grid_of(*things, cell=CELL, **options):
    """Return the map of things (geometry, pose)."""
    with World() as world:
        for number, (geometry, pose) in enumerate(things):
            world.spawn(still(geometry, str(number)), pose=pose)
        return world.occupancy_grid(HEIGHT, cell, **options)


def cells(grid):
    """Return the occupied cells as pairs of numbers of their lower borders, in cells."""
    x, y = (round(number / grid.resolution) for number in grid.origin)
    return {(int(column) + x, int(row) + y) for row, column in np.argwhere(grid.occupied)}


def is_inside(geometry, point):
    x, y, z = point
    match geometry:
        case Box(size):
            return all(abs(a) <= half / 2.0 for a, half in zip(point, size, strict=True))
        case Sphere(radius):
            return math.hypot(x, y, z) <= radius
        case Cylinder(radius, length):
            return math.hypot(x, y) <= radius and abs(z) <= length / 2.0


def random_thing(rng):
    geometry = rng.choice(
        (
            Box(tuple(rng.uniform(0.05, 1.0) for _ in range(3))),
            Sphere(rng.uniform(0.05, 0.5)),
            Cylinder(rng.uniform(0.05, 0.5), rng.uniform(0.05, 1.0)),
        )
    )
    place = rng.uniform(-1.0, 1.0), rng.uniform(-1.0, 1.0), HEIGHT + rng.uniform(-0.4, 0.4)
    return geometry, Pose(place, from_rpy(*(rng.uniform(-3.0, 3.0) for _ in range(3))))


@pytest.mark.parametrize('seed', range(12))
def test_cells_are_those_that_samples_of_the_shape_lie_in(seed):
    geometry, pose = random_thing(random.Random(seed))
    found = cells(grid_of((geometry, pose)))
    offsets = (np.arange(FINE) + 0.5) / FINE
    back = inverse(pose)
    sampled = {}
    places = found | {tuple(math.floor(n / CELL) for n in pose.position[:2])}
    xs, ys = zip(*places, strict=True)
    for x in range(min(xs) - 2, max(xs) + 3):
        for y in range(min(ys) - 2, max(ys) + 3):
            sampled[x, y] = sum(
                is_inside(
                    geometry, compose(back, Pose(((x + u) * CELL, (y + v) * CELL, HEIGHT))).position
                )
                for u in offsets[::4]
                for v in offsets[::4]
            )
    inside = {cell for cell, count in sampled.items() if count}
    assert inside <= found
    missed = found - inside  # the shape has a corner in them, between samples
    assert (
        all(
            {(x + dx, y + dy) for dx in (-1, 0, 1) for dy in (-1, 0, 1)} & inside for x, y in missed
        )
        or not inside
    )
    assert len(missed) <= max(3, len(found) // 4)


def test_a_face_on_the_border_of_cells_occupies_the_inner_ones_only():
    box = Box((0.3, 0.2, 1.0)), Pose((0.25, 0.4, 0.0))
    assert cells(grid_of(box)) == {(x, y) for x in (1, 2, 3) for y in (3, 4)}
    turned = Box((0.2, 0.3, 1.0)), Pose((0.25, 0.4, 0.0), from_rpy(0.0, 0.0, math.pi / 2.0))
    assert cells(grid_of(turned)) == cells(grid_of(box))


def test_a_wall_thinner_than_a_cell_has_no_gap():
    wall = Box((4.0, 0.001, 1.0)), Pose((0.013, 0.017, 0.0), from_rpy(0.0, 0.0, 0.5))
    found = cells(grid_of(wall))
    ends = min(found), max(found)
    assert math.dist(*ends) * CELL == pytest.approx(4.0, abs=2.0 * CELL)
    reached, new = set(), {ends[0]}
    while new:  # from cell to cell, by their edges
        reached |= new
        new = {
            (x + dx, y + dy) for x, y in new for dx, dy in ((1, 0), (-1, 0), (0, 1), (0, -1))
        } & found - reached
    assert ends[1] in reached


def test_the_surfaces_of_a_mesh_occupy_cells(tmp_path):
    corners = [(x, y, z) for x in (0, 3) for y in (0, 3) for z in (0, 1)]
    faces = ((1, 2, 4, 3), (5, 7, 8, 6), (1, 5, 6, 2), (3, 4, 8, 7), (1, 3, 7, 5), (2, 6, 8, 4))
    path = tmp_path / 'room.obj'
    path.write_text(
        '\n'.join(
            [
                *(f'v {x} {y} {z}' for x, y, z in corners),
                *('f ' + ' '.join(map(str, face)) for face in faces),
            ]
        )
    )
    around = {(x, y) for x in range(30) for y in range(30) if {x, y} & {0, 29}}
    assert cells(grid_of((Mesh(str(path)), Pose()))) == around
    mirrored = grid_of((Mesh(str(path), (-1.0, 1.0, 1.0)), Pose((3.0, 0.0, 0.0))))
    assert cells(mirrored) == around


def test_what_is_above_or_below_is_not_there():
    low, high = Box((1.0, 1.0, 0.5)), Sphere(0.4)
    assert not grid_of((low, Pose()), (high, Pose((0.0, 0.0, 0.8)))).occupied.any()


def test_margin_is_free_space_around_everything():
    grid = grid_of((Box((1.0, 1.0, 1.0)), Pose()), margin=0.5, cell=0.25)
    assert grid.occupied.shape == (8, 8)
    assert grid.origin == (-1.0, -1.0)
    assert grid.occupied.sum() == 16


def test_robots_and_named_models_are_left_out():
    with World.from_file('rooms') as world:
        world.spawn(XACRO, 'robot', x=1.0, z=0.5)
        world.run(seconds=0.5)
        grid = world.occupancy_grid(0.2)
        assert grid.left_out == ('robot',)
        world.delete('robot')
        assert np.array_equal(world.occupancy_grid(0.2).occupied, grid.occupied)
        rest = world.occupancy_grid(0.2, without=[*world.models][1:2])
        assert 0 < rest.occupied.sum() < grid.occupied.sum()


def test_files_are_those_of_map_server(tmp_path):
    with World() as world:
        world.spawn(still(Box((0.3, 0.1, 1.0))), pose=Pose((0.15, 0.05, 0.0)))
        world.spawn(still(Box((0.1, 0.1, 1.0)), 'above'), pose=Pose((0.05, 0.15, 0.0)))
        world.save_map(tmp_path / "it's.yaml", HEIGHT, CELL, margin=0.0)
        with pytest.raises(SimError, match='exists already'):
            world.save_map(tmp_path / "it's", HEIGHT, CELL, margin=0.0)
    # from the top
    assert (tmp_path / "it's.pgm").read_bytes() == (
        b'P5\n3 2\n255\n' + bytes([0, 254, 254, 0, 0, 0])
    )
    assert (tmp_path / "it's.yaml").read_text() == (
        'image: "it\'s.pgm"\nresolution: 0.1\norigin: [0.0, 0.0, 0.0]\nnegate: 0\n'
        'occupied_thresh: 0.65\nfree_thresh: 0.196\n'
    )


@pytest.mark.parametrize(
    ('options', 'kind', 'message'),
    [
        ({'resolution': 0.0}, ValueError, 'positive resolution'),
        ({'height': math.nan}, ValueError, 'finite height'),
        ({'margin': -1.0}, ValueError, 'at least 0'),
        ({'resolution': 1e-6}, SimError, 'too large'),
        ({'margin': 1e300}, SimError, 'too large'),
        ({'without': ['nobody']}, NotFoundError, "no model 'nobody'; models: thing"),
    ],
)
def test_bad_arguments_get_a_sentence(options, kind, message):
    with World() as world:
        world.spawn(still(Sphere(1.0)))
        with pytest.raises(kind, match=message):
            world.occupancy_grid(**{'height': HEIGHT} | options)


def test_a_mesh_that_has_gone_gets_a_sentence(tmp_path):
    path = tmp_path / 'a.obj'
    path.write_text('v 0 0 0\nv 1 0 0\nv 0 1 1\nf 1 2 3')
    with World() as world:
        world.spawn(still(Mesh(str(path))))
        path.unlink()
        with pytest.raises(ModelError, match=r'a\.obj'):
            world.occupancy_grid(HEIGHT)
