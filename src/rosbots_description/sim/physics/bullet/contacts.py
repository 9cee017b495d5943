"""Contacts in one PyBullet world, with the collision names of the ModelSpec."""

import itertools
import math
from collections.abc import Callable, Iterable

import numpy as np

from ...core import Pose, Vector, conjugate, rotate, subtract
from ...core.arrays import FloatArray
from ...description import Box, Collision, Cylinder, Mesh, Plane, Sphere
from ...meshes import read_stl
from ..engine import CollisionName, Contact
from .body import Body, Place
from .client import pybullet
from .generated_urdf import MeshFile

_MARGIN = 0.02  # by which a contact point may be beside the surface of its shape [m]


class ContactQueries:
    """Reports the contacts in a PyBullet world."""

    def __init__(
        self, client: int, link_pose: Callable[[Body, str], Pose], mesh_file: MeshFile
    ) -> None:
        """Work in the world of that PyBullet client.

        Args:
            link_pose: gives the pose of a link's frame.
            mesh_file: gives an .stl file of a mesh.
        """
        self._client, self._link_pose, self._mesh_file = client, link_pose, mesh_file
        self._owners: dict[Place, tuple[Body, str]] = {}
        self._triangles: dict[Mesh, FloatArray] = {}
        self._bounds: dict[Place, FloatArray] = {}

    def add(self, body: Body) -> None:
        """Register the names of a body."""
        for link, places in body.surfaces.items():
            for place in places:
                self._owners[place] = body, link

    def remove(self, body: Body) -> None:
        """Forget a body."""
        for places in body.surfaces.values():
            for place in places:
                self._owners.pop(place, None)
                self._bounds.pop(place, None)

    def clear(self) -> None:
        """Forget all bodies."""
        self._owners.clear()
        self._triangles.clear()
        self._bounds.clear()

    def contacts(self, body: Body | None, link: str | None) -> list[Contact]:
        """Return contacts; see `PhysicsEngine.contacts`."""
        found = []
        # Queried for one body, PyBullet flips normals where it is the second, but not friction.
        for point in pybullet.getContactPoints(physicsClientId=self._client):
            _, a, b, index_a, index_b, on_a, on_b, normal, distance, load, *friction = point
            if distance > 0.0 and load <= 0.0:
                continue  # near, but not touching
            one, other = Place(a, index_a), Place(b, index_b)
            is_first = self._is_of(one, body, link)
            if not is_first and not self._is_of(other, body, link):
                continue
            force = tuple(
                load * n + friction[0] * p + friction[2] * q
                for n, p, q in zip(normal, friction[1], friction[3], strict=True)
            )
            if not is_first:
                one, other, on_a, on_b = other, one, on_b, on_a
                normal, force = (tuple(-x for x in vector) for vector in (normal, force))
            found.append(
                Contact(
                    self._name(one, on_a), self._name(other, on_b), on_a, normal, -distance, force
                )
            )
        return found

    def extent(self, body: Body) -> float:
        """Return the longest side of a model's bounding box [m]; see `PhysicsEngine.extent`."""
        if any(
            isinstance(one.geometry, Plane) for shapes in body.shapes.values() for one in shapes
        ):
            return math.inf
        boxes = [
            pybullet.getAABB(*place, self._client)
            for place, shapes in body.shapes.items()
            if shapes
        ]
        if not boxes:
            return 0.0
        return float(
            max(
                max(high[axis] for _, high in boxes) - min(low[axis] for low, _ in boxes)
                for axis in range(3)
            )
        )

    def touching(self, body: Body) -> set[Body]:
        """Return the bodies that touched a body in the last step; not itself."""
        return {
            self._owners[Place(point[2], point[4])][0]
            for number in body.bodies
            for point in pybullet.getContactPoints(number, physicsClientId=self._client)
            if point[8] <= 0.0 or point[9] > 0.0
        } - {body}

    def _is_of(self, place: Place, body: Body | None, link: str | None) -> bool:
        owner, name = self._owners[place]
        return (body is None or owner is body) and link in (None, name)

    def _name(self, place: Place, position: Vector) -> CollisionName:
        """Return the collision of a part at a point of its surface, in the world."""
        body, link = self._owners[place]
        shapes = body.shapes[place]
        if len({shape.name for shape in shapes}) == 1:
            return CollisionName(body, link, shapes[0].name)
        pose = self._link_pose(body, link)
        local = rotate(conjugate(pose.orientation), subtract(position, pose.position))
        # Distances to meshes are costly, so they are left to points that several boxes contain.
        if place not in self._bounds:
            self._bounds[place] = np.array([self._bounding_box(shape) for shape in shapes])
        low, high = self._bounds[place].transpose(1, 0, 2)
        beside = np.maximum(np.maximum(low - local, np.array(local) - high), 0.0)
        distances = np.sqrt((beside * beside).sum(axis=1))
        near = [shapes[k] for k in np.flatnonzero(distances <= distances.min() + _MARGIN)]
        if len(near) > 1:
            near.sort(key=lambda shape: abs(self._distance(shape, local)))
        return CollisionName(body, link, near[0].name)

    def _bounding_box(self, shape: Collision) -> FloatArray:
        """Return the lowest and highest corner of a shape in the link's frame, shape (2, 3) [m]."""
        match shape.geometry:
            case Plane():
                return np.array([[-math.inf] * 3, [math.inf] * 3])
            case Mesh() as mesh:
                corners = self._triangles_of(mesh).reshape(-1, 3)
                low, high = corners.min(axis=0), corners.max(axis=0)
            case Sphere(radius):
                high = np.full(3, radius)
                low = -high
            case Box(size):
                high = np.array(size) / 2.0
                low = -high
            case Cylinder(radius, length):
                high = np.array([radius, radius, length / 2.0])
                low = -high
        turned = [
            rotate(shape.pose.orientation, corner)
            for corner in itertools.product(*zip(low, high, strict=True))
        ]
        return np.add([np.min(turned, axis=0), np.max(turned, axis=0)], shape.pose.position)

    def _distance(self, shape: Collision, point: Vector) -> float:
        """Return the signed distance of a point in the link's frame to a shape's surface [m]."""
        x, y, z = local = rotate(
            conjugate(shape.pose.orientation), subtract(point, shape.pose.position)
        )
        match shape.geometry:
            case Sphere(radius):
                return math.hypot(x, y, z) - radius
            case Box(size):
                return _outside(abs(a) - b / 2.0 for a, b in zip(local, size, strict=True))
            case Cylinder(radius, length):
                return _outside((math.hypot(x, y) - radius, abs(z) - length / 2.0))
            case Plane(normal):
                return sum(a * b for a, b in zip(local, normal, strict=True))
            case Mesh() as mesh:
                return _to_triangles(self._triangles_of(mesh), np.array(local))

    def _triangles_of(self, mesh: Mesh) -> FloatArray:
        """Return the n triangles of a mesh, shape (n, 3, 3) [m]."""
        if mesh not in self._triangles:
            with open(self._mesh_file(mesh), 'rb') as file:
                self._triangles[mesh] = read_stl(file.read())
        return self._triangles[mesh]


def _outside(reaches: Iterable[float]) -> float:
    """Return the signed distance to a convex shape, given those along each of its directions."""
    reaches = list(reaches)
    if max(reaches) <= 0.0:
        return max(reaches)
    return math.hypot(*(max(reach, 0.0) for reach in reaches))


def _to_triangles(triangles: FloatArray, point: FloatArray) -> float:
    """Return the distance of a point to the nearest of n triangles, shape (n, 3, 3) [m]."""
    a, b, c = (triangles[:, k] - point for k in range(3))
    nearest = math.inf
    for start, end in ((a, b), (b, c), (c, a)):
        side = end - start
        share = -(start * side).sum(axis=1) / np.maximum((side * side).sum(axis=1), 1e-300)
        on_side = start + np.clip(share, 0.0, 1.0)[:, None] * side
        nearest = min(nearest, float((on_side * on_side).sum(axis=1).min()))
    normal = np.cross(b - a, c - a)
    sides = [(np.cross(v - u, -u) * normal).sum(axis=1) for u, v in ((a, b), (b, c), (c, a))]
    above = (np.min(sides, axis=0) >= 0.0) & ((normal * normal).sum(axis=1) > 0.0)
    if above.any():
        flat = normal[above]
        height = (a[above] * flat).sum(axis=1) ** 2 / (flat * flat).sum(axis=1)
        nearest = min(nearest, float(height.min()))
    return math.sqrt(nearest)
