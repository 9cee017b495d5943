"""Ray casts against all collisions of a world.

Each scan compares the poses of all links with those of the previous scan and updates those that
moved; static models are looked at only after something was placed. Bounding spheres and boxes limit
the number of ray-shape pairs to compute.
"""

import logging
import math
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import Future
from typing import TYPE_CHECKING
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import NDArray

from ..core import ZERO, ModelError, Pose, Vector, compose, rotate
from ..core.arrays import rotation_matrix
from ..description import Box, Collision, Cylinder, Geometry, Mesh, Plane, Sphere
from . import ray_shapes
from .link_solids import LinkSolids
from .ray_fan import Indices, Patches, RayFan
from .ray_mesh import RayMesh, build_later

if TYPE_CHECKING:
    from ..runtime import Link, Model, World

logger = logging.getLogger(__name__)

Floats = NDArray[np.float64]

Formula = Callable[[Floats, Floats, Floats], tuple[Floats, Floats]]
_FORMULAS: dict[type, Formula] = {
    Box: ray_shapes.box, Cylinder: ray_shapes.cylinder, Sphere: ray_shapes.sphere}
_MOST = 1 << 18  # ray-shape pairs in a batch: 30 MB at most


class RayScene:
    """The collisions of all models of a world, in arrays."""

    def __init__(self, world: 'World') -> None:
        self._models: list[Model] = []
        self._known_meshes: dict[Mesh, Future[RayMesh]] = {}
        self._unreadable: set[Mesh] = set()  # of these an error was logged
        self._placements = -1  # as the engine counts them, when static models were read
        self._world_models = world.models  # a reference to the world would keep it alive
        self._lay_out()
        for model in self._world_models.values():
            self.model_spawned(model)
        world.listeners.append(self)

    @classmethod
    def of(cls, world: 'World') -> 'RayScene':
        """Return the scene of a world, shared by its sensors."""
        if world not in _SCENES:
            _SCENES[world] = cls(world)
        return _SCENES[world]

    def model_spawned(self, model: 'Model') -> None:
        """Begin to build its meshes, so that the first scan needs not."""
        self._build(collision.geometry for _, collision in _collisions([model]))

    def model_deleted(self, model: 'Model') -> None:
        """Keep its meshes for other models."""

    def world_reset(self) -> None:
        """Keep all meshes."""

    def cast(
        self, pose: Pose, fan: RayFan, least: float, most: float
    ) -> tuple[Floats, Floats]:
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
                heights, self._normals @ ways, self._plane_retro, strict=True):
            met = height / slopes
            closer = (met >= least) & (met < distances)
            distances[closer], retro[closer] = met[closer], shine

    def _meet_solids(
        self, origin: Floats, turn: Floats, fan: RayFan, least: float, distances: Floats,
        retro: Floats,
    ) -> None:
        offsets = self._centres - origin
        corners = (turn.T @ self._corners.reshape(3, -1)).reshape(self._corners.shape)
        patches = fan.near(offsets @ turn, self._radii, corners, distances.max())
        laid_out = np.concatenate((  # (15, m): origin of the fan, half extents, fan to shape
            np.einsum('ij,ijk->ki', -offsets, self._axes), self._halves,
            (turn.T @ self._axes).reshape(-1, 9).T))
        at_once = max(1, _MOST // len(distances))
        for begin in range(0, len(patches.shapes), at_once):
            batch = Patches(*(part[begin:begin + at_once] for part in patches))
            which, ray, counts = fan.rays(batch)
            # take keeps the pairs of a row contiguous in memory, unlike indexing.
            pairs = laid_out.take(batch.shapes[which], axis=1)
            along = fan.ways.take(ray, axis=1)
            way = np.einsum('ip,ijp->jp', along, pairs[6:].reshape(3, 3, -1))
            met = self._meet(batch.shapes, counts, least, pairs[:3], way, pairs[3:6])
            self._keep_nearest(distances, retro, ray, met, self._retro[batch.shapes[which]])

    def _meet(
        self, shapes: Indices, counts: Indices, least: float, start: Floats, way: Floats,
        half: Floats,
    ) -> Floats:
        """Return the hit distances of ray-shape pairs; each shape has `counts` rays."""
        met, begin = [], 0
        for kind, formula in _FORMULAS.items():
            end = counts[:np.searchsorted(shapes, self._ends[kind])].sum()
            if end > begin:
                some = slice(begin, end)
                met.append(ray_shapes.first_from(
                    least, *formula(start[:, some], way[:, some], half[:, some])))
            begin = end
        for mesh, count in zip(shapes.tolist(), counts.tolist(), strict=True):
            if mesh >= self._ends[Sphere]:
                some = slice(begin, begin + count)
                begin += count
                met.append(self._meshes[mesh].meet(start[:, some], way[:, some], least))
        return np.concatenate(met)

    def _keep_nearest(
        self, distances: Floats, retro: Floats, ray: Indices, met: Floats, shine: Floats
    ) -> None:
        """Update distances and laser_retro of rays (n,) to the nearest hits, in place.

        Args:
            ray: (p,) indices of the rays that meet something.
            met: (p,) hit distances.
            shine: (p,) laser_retro.
        """
        closer = np.flatnonzero(met < distances[ray])
        closer = closer[np.argsort(ray[closer], kind='stable')]
        ray, met = ray[closer], met[closer]
        counts = np.bincount(ray)
        rays = np.flatnonzero(counts)
        if len(rays):
            distances[rays] = np.minimum.reduceat(met, (counts.cumsum() - counts)[rays])
            if self._shines:
                hits = np.flatnonzero(met == distances[ray])[::-1]  # the first of equals wins
                retro[ray[hits]] = shine[closer[hits]]

    def _update(self) -> None:
        """Update to models spawned and deleted, and to links moved."""
        models = list(self._world_models.values())
        if models != self._models:
            self._models = models
            self._lay_out()
        placements = self._models[0].engine.placements if self._models else 0
        links = self._moving if placements == self._placements else self._links
        self._placements = placements
        for link in links:
            pose = link.pose
            if pose != self._poses[link]:
                self._poses[link] = pose
                self._place(link, pose)

    def _lay_out(self) -> None:
        """Allocate the arrays for the shapes of all models, sorted by kind."""
        found = list(_collisions(self._models))
        self._links = list(dict.fromkeys(link for link, _ in found))
        self._moving = [link for link in self._links if not link.model.static]
        self._poses: dict[Link, Pose | None] = dict.fromkeys(self._links)
        self._placements = -1
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
        planes = [one for one in found if isinstance(one[1].geometry, Plane)]
        self._halves, self._radii = np.array(halves).reshape(-1, 3).T, np.array(radii)
        self._centres, self._axes = np.zeros((len(solids), 3)), np.zeros((len(solids), 3, 3))
        self._corners = np.zeros((3, 8, len(solids)))  # from the centres, in the world's axes
        self._points, self._normals = np.zeros((len(planes), 3)), np.zeros((len(planes), 3))
        self._retro = np.array([collision.surface.laser_retro for _, collision in solids])
        self._plane_retro = np.array([collision.surface.laser_retro for _, collision in planes])
        self._shines = bool(self._retro.any() or self._plane_retro.any())
        own: dict[Link, list[int]] = {link: [] for link in self._links}
        for row, (link, _) in enumerate(solids):
            own[link].append(row)
        offsets = {row: mesh.centre for row, mesh in self._meshes.items()}
        self._solids = {
            link: LinkSolids.of(
                rows, [solids[row][1].pose for row in rows], self._halves, offsets)
            for link, rows in own.items()}
        self._planes: dict[Link, list[tuple[int, Pose, Vector]]] = {
            link: [] for link in self._links}
        for row, (link, collision) in enumerate(planes):
            if isinstance(collision.geometry, Plane):
                self._planes[link].append((row, collision.pose, collision.geometry.normal))

    def _place(self, link: 'Link', pose: Pose) -> None:
        """Update the shapes of a link."""
        solids = self._solids[link]
        if len(solids.rows):
            rows = solids.rows
            self._centres[rows], self._axes[rows], self._corners[:, :, rows] = solids.at(pose)
        for row, in_link, normal in self._planes[link]:
            position, orientation = compose(pose, in_link)
            self._points[row], self._normals[row] = position, rotate(orientation, normal)

    def _build(self, shapes: Iterable[Geometry]) -> None:
        """Begin to build the meshes among some shapes, unless that was done before."""
        self._known_meshes.update(build_later(
            shape for shape in dict.fromkeys(shapes)
            if isinstance(shape, Mesh) and shape not in self._known_meshes))

    def _built_mesh(self, shape: Geometry) -> RayMesh | None:
        """Return the RayMesh of a mesh once it is built; None for others, and if it cannot be."""
        if not isinstance(shape, Mesh):
            return None
        self._build([shape])  # of a model that is being spawned
        try:
            return self._known_meshes[shape].result()
        except ModelError as error:
            if shape not in self._unreadable:
                logger.error('rays do not see a mesh: %s', error)
                self._unreadable.add(shape)
            return None


def _collisions(models: 'list[Model]') -> 'Iterator[tuple[Link, Collision]]':
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
    radius = x if isinstance(shape, Sphere) else \
        math.hypot(x, z) if isinstance(shape, Cylinder) else math.hypot(x, y, z)
    return radius * (1.0 + 1e-9) + 1e-9


_SCENES: WeakKeyDictionary['World', RayScene] = WeakKeyDictionary()
