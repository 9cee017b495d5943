"""Ray casts against all collisions of a world.

The first scan after a step reads the poses of all links that move; those of static models are read
only after something was placed. Bounding spheres and boxes limit the number of ray-shape pairs to
compute.
"""

import logging
import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import Future
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import NDArray

from ...core import ZERO, Fault, ModelError, PluginError, Pose, Vector, compose, report, rotate
from ...core.arrays import rotation_matrix
from ...description import Box, Collision, Cylinder, Geometry, Mesh, Plane, Sphere
from ...runtime import Link, Listener, Model, SensorPart, World
from . import formulas
from .fan import Indices, Patches, RayFan
from .mesh import RayMesh, build_later
from .solids import LinkSolids, corners_of

Floats = NDArray[np.float64]

Formula = Callable[[Floats, Floats, Floats], tuple[Floats, Floats]]
_FORMULAS: dict[type, Formula] = {
    Box: formulas.box,
    Cylinder: formulas.cylinder,
    Sphere: formulas.sphere,
}
_MOST = 1 << 18  # ray-shape pairs in a batch: 30 MB at most
MANY_RAYS, MAX_RAYS = 200_000, 5_000_000  # of all sensors of a world, each with one scan


class RayScene(Listener):
    """The collisions of all models of a world, in arrays."""

    def __init__(self, world: World) -> None:
        # A reference to the world would keep it alive.
        self._revisions, self._world_models = world.revisions, world.models
        self._engine, self._read = world.engine, (-1, -1)  # its counters, when poses were read
        self._known_meshes: dict[Mesh, Future[RayMesh]] = {}
        self._unreadable: set[Mesh] = set()  # of these an error was logged
        self._rays: WeakKeyDictionary[SensorPart, int] = WeakKeyDictionary()  # of a scan
        self._reported = MANY_RAYS / 2  # rays in the last warning about their sum
        self._laid_out: object = None  # models
        self._lay_out([])
        for model in self._world_models.values():
            self.model_spawned(model)
        world.listeners.append(self)

    @classmethod
    def of(cls, world: World) -> 'RayScene':
        """Return the scene of a world, shared by its sensors."""
        if world not in _SCENES:
            _SCENES[world] = cls(world)
        return _SCENES[world]

    def add_rays(self, sensor: SensorPart, rays: int) -> None:
        """Count the rays of a sensor, with a warning whenever the sum of all has doubled.

        Raises:
            PluginError: all sensors of the world cast too many.
        """
        total = rays + sum(self._rays.values())
        if total > MAX_RAYS:
            raise PluginError(
                f'{sensor.called}: the sensors of this world would cast {total} rays '
                f'with it; at most {MAX_RAYS} are cast'
            )
        self._rays[sensor] = rays
        if total > MANY_RAYS and total >= 2 * self._reported:
            self._reported = total
            what = f"model '{sensor.model.name}', {sensor.called}: {total} rays, with those of all "
            report(Fault(f'{what}other sensors, take long; the simulation waits for each scan'))

    def remove_rays(self, sensor: SensorPart) -> None:
        """Count the rays of a sensor no more."""
        self._rays.pop(sensor, None)
        self._reported = max(MANY_RAYS / 2, min(self._reported, sum(self._rays.values())))

    def model_spawned(self, model: Model) -> None:
        """Begin to build its meshes, so that the first scan needs not."""
        self._build(collision.geometry for _, collision in _collisions([model]))

    def model_deleted(self, model: Model) -> None:
        """Drop it, and its meshes that no other model has."""
        self._laid_out = None  # the next scan lays out the others
        self._lay_out([])
        others = [other for other in self._world_models.values() if other is not model]
        used = {collision.geometry for _, collision in _collisions(others)}
        for mesh in self._known_meshes.keys() - used:
            del self._known_meshes[mesh]

    def cast(self, pose: Pose, fan: RayFan, least: float, most: float) -> tuple[Floats, Floats]:
        """Return the distances (n,) [m] of the first hits, and the laser_retro (n,) of what is hit.

        Args:
            pose: of the fan, in the world.
            least: minimum range [m], where rays start.
            most: maximum range [m], returned with laser_retro 0 for rays without a hit.
        """
        self._update()
        turn = rotation_matrix(pose.orientation)
        rays = fan.ways.shape[1]
        distances, retro = np.full(rays, most), np.zeros(rays)
        with np.errstate(all='ignore'):  # diverged shapes are not hit
            self._meet_planes(np.array(pose.position), turn @ fan.ways, least, distances, retro)
            self._meet_solids(np.array(pose.position), turn, fan, least, distances, retro)
        return distances, retro

    def _meet_planes(
        self, origin: Floats, ways: Floats, least: float, distances: Floats, retro: Floats
    ) -> None:
        heights = ((self._points - origin) * self._normals).sum(axis=1)
        for height, slopes, shine in zip(
            heights.tolist(), self._normals @ ways, self._plane_retro, strict=True
        ):
            if abs(height) > max(slopes.max(), -slopes.min()) * distances.max():
                continue  # out of reach
            met = height / slopes
            closer = (met >= least) & (met < distances)
            distances[closer], retro[closer] = met[closer], shine

    def _meet_solids(
        self,
        origin: Floats,
        turn: Floats,
        fan: RayFan,
        least: float,
        distances: Floats,
        retro: Floats,
    ) -> None:
        solids, most = self._solids, distances.max()
        offsets = solids.centres - origin
        centres = offsets @ turn
        reaches = (np.abs(turn[:, 2] @ solids.axes) * self._halves.T).sum(axis=1)
        some = fan.may_meet(centres, self._radii, reaches, most)
        axes, halves = solids.axes[some], self._halves[:, some]
        inwards = turn.T @ axes
        starts = np.einsum('ij,ijk->ki', -offsets[some], axes)  # of the rays, in the shapes' frames
        patches = fan.near(centres[some], self._radii[some], corners_of(inwards, halves), most)
        laid_out = np.concatenate((starts, halves, inwards.reshape(-1, 9).T))  # (15, m)
        at_once = max(1, _MOST // len(distances))
        for begin in range(0, len(patches.shapes), at_once):
            batch = Patches(*(part[begin : begin + at_once] for part in patches))
            which, ray, counts = fan.rays(batch)
            # take keeps the pairs of a row contiguous in memory, unlike indexing.
            pairs = laid_out.take(batch.shapes[which], axis=1)
            along = fan.ways.take(ray, axis=1)
            ways = np.einsum('ip,ijp->jp', along, pairs[6:].reshape(3, 3, -1))
            rows = some[batch.shapes]
            met = self._meet(
                rows, [0, *counts.cumsum().tolist()], least, pairs[:3], ways, pairs[3:6]
            )
            self._keep_nearest(distances, retro, fan, batch, met, self._retro[rows])

    def _meet(
        self,
        shapes: Indices,
        ends: Sequence[int],
        least: float,
        start: Floats,
        way: Floats,
        half: Floats,
    ) -> Floats:
        """Return the hit distances of p ray-shape pairs.

        Args:
            shapes: (m,) ascending.
            ends: (m + 1,) where the pairs of each shape end; the first is 0.
            start: (3, p), as in `formulas`; so are `way` and `half`.
        """
        met = np.empty(way.shape[1])
        first = 0
        for kind, formula in _FORMULAS.items():
            last = int(np.searchsorted(shapes, self._ends[kind]))
            if last > first:
                some = slice(ends[first], ends[last])
                met[some] = formulas.first_from(
                    least, *formula(start[:, some], way[:, some], half[:, some])
                )
            first = last
        for number in range(first, len(shapes)):
            some = slice(ends[number], ends[number + 1])
            met[some] = self._meshes[int(shapes[number])].meet(start[:, some], way[:, some], least)
        return met

    def _keep_nearest(
        self,
        distances: Floats,
        retro: Floats,
        fan: RayFan,
        patches: Patches,
        met: Floats,
        shine: Floats,
    ) -> None:
        """Update distances and laser_retro of rays (n,) to the nearest hits, in place.

        Args:
            patches: m, each of rays that may meet a shape.
            met: (p,) hit distances of their rays, patch by patch; of equals the first counts.
            shine: (m,) laser_retro of their shapes.
        """
        grid, glow = distances.reshape(fan.shape), retro.reshape(fan.shape)
        begin = 0
        for _, top, bottom, left, right, own in zip(
            *(part.tolist() for part in (*patches, shine)), strict=True
        ):
            patch = slice(top, bottom), slice(left, right)
            end = begin + (bottom - top) * (right - left)
            mine = met[begin:end].reshape(bottom - top, right - left)
            if self._shines:
                glow[patch][mine < grid[patch]] = own
            np.minimum(grid[patch], mine, out=grid[patch])
            begin = end

    def _update(self) -> None:
        """Update to models spawned and deleted, and to links moved."""
        models = self._revisions.models()
        if models is not self._laid_out:
            self._laid_out = models
            self._lay_out(list(models))
        placements, last = self._engine.placements, self._read
        self._read = placements, self._engine.advances
        if self._read == last:
            return
        links, rows = self._moving, self._moving_rows
        if placements != last[0]:
            links, rows = self._links, self._rows
        poses = [link.pose for link in links]
        numbers = np.array([(*place, *turned) for place, turned in poses])
        self._solids.place(*rows, numbers.reshape(-1, 7))  # no row where all models are static
        for row, (link, collision, normal) in enumerate(self._planes):
            if link in links:
                position, orientation = compose(link.pose, collision.pose)
                self._points[row], self._normals[row] = position, rotate(orientation, normal)

    def _lay_out(self, models: list[Model]) -> None:
        """Allocate the arrays for the shapes of models, sorted by kind."""
        found = list(_collisions(models))
        self._links = list(dict.fromkeys(link for link, _ in found))
        self._moving = [link for link in self._links if not link.model.static]
        self._read = -1, -1
        solids: list[tuple[Link, Collision]] = []
        self._ends: dict[type, int] = {}
        for kind in _FORMULAS:
            solids += [one for one in found if isinstance(one[1].geometry, kind)]
            self._ends[kind] = len(solids)
        halves = [_half_extents(collision.geometry) for _, collision in solids]
        radii = [_radius(collision.geometry) for _, collision in solids]
        self._meshes: dict[int, RayMesh] = {}  # by row
        for link, collision in found:
            mesh = self._built_mesh(collision.geometry)
            if mesh is not None:
                self._meshes[len(solids)] = mesh
                solids.append((link, collision))
                halves.append(mesh.half)
                radii.append(mesh.radius)
        self._planes = [
            (link, collision, collision.geometry.normal)
            for link, collision in found
            if isinstance(collision.geometry, Plane)
        ]
        self._halves, self._radii = np.array(halves).reshape(-1, 3).T, np.array(radii)
        self._points, self._normals = np.zeros((2, len(self._planes), 3))
        self._retro = np.array([collision.surface.laser_retro for _, collision in solids])
        self._plane_retro = np.array([one.surface.laser_retro for _, one, _ in self._planes])
        self._shines = bool(self._retro.any() or self._plane_retro.any())
        numbers = {link: number for number, link in enumerate(self._links)}
        self._solids = LinkSolids(
            [numbers[link] for link, _ in solids],
            [collision.pose for _, collision in solids],
            {row: mesh.centre for row, mesh in self._meshes.items()},
        )
        self._rows = self._solids.of([numbers[link] for link in self._links])
        self._moving_rows = self._solids.of([numbers[link] for link in self._moving])

    def _build(self, shapes: Iterable[Geometry]) -> None:
        """Begin to build the meshes among some shapes, unless that was done before."""
        self._known_meshes.update(
            build_later(
                shape
                for shape in dict.fromkeys(shapes)
                if isinstance(shape, Mesh) and shape not in self._known_meshes
            )
        )

    def _built_mesh(self, shape: Geometry) -> RayMesh | None:
        """Return the RayMesh of a mesh once it is built; None for others, and if it cannot be."""
        if not isinstance(shape, Mesh):
            return None
        self._build([shape])  # of a model that is being spawned
        try:
            return self._known_meshes[shape].result()
        except ModelError as error:
            if shape not in self._unreadable:
                report(Fault(f'rays do not see a mesh: {error}', logging.ERROR))
                self._unreadable.add(shape)
            return None


def _collisions(models: list[Model]) -> Iterator[tuple[Link, Collision]]:
    for model in models:
        for link in model.links.values():
            for collision in link.spec.collisions:
                yield link, collision


def _half_extents(shape: Geometry) -> Vector:
    match shape:
        case Box((x, y, z)):
            return x / 2.0, y / 2.0, z / 2.0
        case Cylinder(radius, length):
            return radius, radius, length / 2.0
        case Sphere(radius):
            return radius, radius, radius
    return ZERO  # not used for planes; a mesh has its own


def _radius(shape: Geometry) -> float:
    """Return the radius of a shape's bounding sphere [m], with a margin for rounding."""
    x, y, z = _half_extents(shape)
    radius = (
        x
        if isinstance(shape, Sphere)
        else math.hypot(x, z)
        if isinstance(shape, Cylinder)
        else math.hypot(x, y, z)
    )
    return radius * (1.0 + 1e-9) + 1e-9


_SCENES: WeakKeyDictionary[World, RayScene] = WeakKeyDictionary()
