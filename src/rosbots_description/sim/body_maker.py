"""Makes PyBullet's bodies of links and joints; their text is that of bullet_description.py."""

import os
from itertools import combinations, product

from .body import Body, Part, Place
from .bounds import MAX_JOINTS
from .bullet import pybullet
from .bullet_description import RIDER_MASS, MeshFile, Tree, describe_tree, untouching_links
from .inertia import principal_axes
from .pose import Pose, Vector, compose, inverse
from .spec import FIXED, Inertial, JointSpec, Mesh, ModelSpec, Surface
from .surfaces import (
    Groups,
    compliant,
    contact_spring,
    friction,
    is_floor,
    is_one_body,
    is_rigid,
    jointed_mass,
    parting_rate,
    rolling_arm,
    surface_groups,
    with_edges,
    with_inner_first,
)
from .tuning import Tuning
from .untouching import Untouching

ANY_SPEED = 1e6  # [rad/s or m/s] PyBullet would stop every joint at 100
_MASSLESS = Inertial(0.0)
# Groups of bodies. Two collide if the group of either is in the mask of the other.
_STANDING = 2  # PyBullet's own for what never moves; its mask is all but these
_INNER = 8  # what no plane can touch


def grouped(tree: Tree, mesh_file: MeshFile) -> tuple[list[Groups], bool]:
    """Return the groups of each link of a tree (surfaces.py); of the root first what lies inside.

    And whether there is something inside. What takes time about it is remembered.
    """
    groups = [surface_groups(tree, i) for i in range(len(tree.links))]
    inner_first = None
    if len(tree.links) + sum(len(of_link) - 1 for of_link in groups) <= MAX_JOINTS:
        inner_first = with_inner_first(tree, groups[0], mesh_file)
    if inner_first:
        inner, *outer = inner_first
        return [[inner, *with_edges(tree, outer)], *groups[1:]], True
    return [with_edges(tree, groups[0]), *groups[1:]], False


class BodyMaker:
    """Makes bodies in one PyBullet world. They move as rigid bodies do, with no motor on."""

    def __init__(
        self, client: int, tuning: Tuning, mesh_file: MeshFile, surface_file: MeshFile
    ) -> None:
        """Work in the world of that PyBullet client; the rest is as for the Engine."""
        self._client = client
        self._tuning = tuning
        self._mesh_file = mesh_file
        self._surface_file = surface_file
        self._untouching = Untouching(client)

    def add_tree(self, body: Body, tree: Tree, model_pose: Pose, step_size: float) -> None:
        """Put links that joints connect into the world, and note in `body` where they are.

        Args:
            model_pose: where the model's frame is.
            step_size: of the simulation [s]; the contacts of soft surfaces depend on it.
        """
        inertials = [link.inertial or _MASSLESS for link in tree.links]
        moments, axes = zip(*(principal_axes(inertial) for inertial in inertials), strict=True)
        coms = [
            Pose(inertial.pose.position, orientation)
            for inertial, orientation in zip(inertials, axes, strict=True)
        ]
        mesh_file = self._surface_file if tree.stands else self._mesh_file
        groups, inner_first = grouped(tree, mesh_file)
        text = describe_tree(tree, coms, groups, mesh_file)
        place = compose(model_pose, tree.links[0].pose)
        number = self._load_urdf(text, tree, place, is_one_body(tree, groups))
        body.bodies.append(number)
        shapes = [collision.geometry for link in tree.links for collision in link.collisions]
        meshes = [mesh_file(shape) for shape in shapes if isinstance(shape, Mesh)]
        body.size += len(text) + sum(map(os.path.getsize, meshes))
        body.roots.append(tree.links[0].name)
        if tree.fixed_base:
            body.bolted.add(tree.links[0].name)
        index_of = self._indices(number)
        # In a call of its own: together with an inertia PyBullet gives that inertia to the base.
        pybullet.changeDynamics(
            number,
            -1,
            linearDamping=tree.links[0].linear_damping,
            angularDamping=tree.links[0].angular_damping,
            maxJointVelocity=ANY_SPEED,
            physicsClientId=self._client,
        )
        mass = jointed_mass(tree)
        for i, (link, joint) in enumerate(zip(tree.links, tree.joints, strict=True)):
            part = Part(number, index_of[f'l{i}'], inverse(coms[i]), coms[i])
            body.parts[link.name] = part
            self._set_inertia(part, moments[i], joint)
            self._set_surfaces(body, tree, i, groups[i], index_of, step_size, mass)
            if joint is not None and joint.type != FIXED:
                body.joints[joint.name] = (number, part.index)
                body.indices.setdefault(number, []).append(part.index)
            if not link.gravity and not (tree.fixed_base and i == 0):
                body.weightless.append((number, part.index, inertials[i].mass))
        if inner_first:
            self._set_filter(number, _INNER, ~_STANDING)
        elif is_floor(tree):
            self._set_filter(number, _STANDING, ~(_STANDING | _INNER))

    def _set_filter(self, number: int, group: int, mask: int) -> None:
        """Put the base of a body into a group, and let it meet those of the mask."""
        pybullet.setCollisionFilterGroupMask(number, -1, group, mask, self._client)

    def exclude_collisions_within(self, body: Body, spec: ModelSpec) -> None:
        """Let those links of a model pass through each other that do so in Gazebo."""
        if len(body.bodies) == 1 and not any(link.self_collide for link in spec.links):
            return  # one body without the self-collision flag never touches itself
        if spec.static:
            return  # what stands does not touch what stands
        places = body.surfaces
        for own in places.values():
            for one, other in combinations(own, 2):
                self._untouching.add(one, other)
        for a, b in untouching_links(spec):
            for one, other in product(places[a], places[b]):
                self._untouching.add(one, other)

    def remove(self, body: Body) -> None:
        """Take a body out of the world."""
        for number in body.bodies:
            pybullet.removeBody(number, self._client)
        for number in body.bodies:
            self._untouching.forget(number)

    def reset(self) -> None:
        """Remove everything."""
        pybullet.resetSimulation(physicsClientId=self._client)
        self._untouching.clear()

    def _load_urdf(self, text: str, tree: Tree, pose: Pose, one_body: bool) -> int:
        flags = pybullet.URDF_USE_INERTIA_FROM_FILE
        if self._tuning.exact_cylinders:
            flags |= pybullet.URDF_USE_IMPLICIT_CYLINDER
        if sum(link.self_collide for link in tree.links) > 1:
            # Quadruples the cost of a step, so only where asked for.
            flags |= pybullet.URDF_USE_SELF_COLLISION
        # A file that lives in memory only: no disk to fill, nothing left behind.
        descriptor = os.memfd_create('model')
        try:
            os.write(descriptor, text.encode())
            return pybullet.loadURDF(
                f'/proc/self/fd/{descriptor}',
                *pose,
                useFixedBase=tree.fixed_base,
                useMaximalCoordinates=one_body,
                flags=flags,
                physicsClientId=self._client,
            )
        finally:
            os.close(descriptor)

    def _indices(self, number: int) -> dict[str, int]:
        """Return PyBullet's index of every link of a body; the root `l0` is the base, -1."""
        indices = {'l0': -1}
        for index in range(pybullet.getNumJoints(number, self._client)):
            indices[pybullet.getJointInfo(number, index, self._client)[12].decode()] = index
        return indices

    def _set_inertia(self, part: Part, inertia: Vector, joint: JointSpec | None) -> None:
        pybullet.changeDynamics(
            part.body,
            part.index,
            localInertiaDiagonal=inertia,
            jointDamping=joint.damping if joint else 0.0,
            physicsClientId=self._client,
        )

    def _set_surfaces(
        self,
        body: Body,
        tree: Tree,
        i: int,
        groups: Groups,
        index_of: dict[str, int],
        step_size: float,
        mass: float,
    ) -> None:
        """Set up what link `i` touches with, itself and its riders, and note it in `body`.

        Args:
            mass: as `jointed_mass` tells it [kg].
        """
        link, joint = tree.links[i], tree.joints[i]
        part = body.parts[link.name]
        body.surfaces[link.name] = surfaces = []
        for k, group in enumerate(groups):
            index = part.index
            if k:
                index = index_of[f'l{i}r{k}']
                pybullet.changeDynamics(
                    part.body,
                    index,
                    localInertiaDiagonal=(RIDER_MASS,) * 3,
                    physicsClientId=self._client,
                )
            if group:
                rolling = rolling_arm(group, joint)
                surface = compliant(group[0].surface, mass)
                self._set_surface(part.body, index, surface, rolling, step_size)
                surfaces.append(Place(part.body, index))

    def _set_surface(
        self, number: int, index: int, surface: Surface, rolling: float, step_size: float
    ) -> None:
        """Set up what a body touches with.

        Args:
            rolling: PyBullet's rolling friction [m].
            step_size: of the simulation [s].
        """
        pybullet.changeDynamics(
            number,
            index,
            lateralFriction=friction(surface),
            spinningFriction=0.0,
            rollingFriction=rolling,
            restitution=0.0,
            physicsClientId=self._client,
        )
        if not is_rigid(surface):
            rate = self._parting_rate(number, index)
            stiffness, damping = contact_spring(surface, step_size, rate)
            pybullet.changeDynamics(
                number,
                index,
                contactStiffness=stiffness,
                contactDamping=damping,
                physicsClientId=self._client,
            )

    def _parting_rate(self, number: int, index: int) -> float:
        """Return the rate at which contacts of a part take away an overlap [1/s]."""
        low, high = pybullet.getAABB(number, index, self._client)
        reach = max(b - a for a, b in zip(low, high, strict=True))
        return parting_rate(reach, self._tuning.push_out)
