"""Makes PyBullet's bodies of links and joints; their text is that of generated_urdf.py."""

import os
from collections.abc import Sequence
from itertools import combinations, product

from ...core import NO_ROTATION, Pose, Quaternion, Vector, compose, inverse
from ...description import FIXED, Inertial, JointSpec, LinkSpec, Mesh, ModelSpec, Surface
from ...description.inertia import is_balanced, principal_axes
from .body import Body, FrictionAxes, Mass, Masses, Part, Place
from .client import pybullet
from .collision_filter import Untouching
from .faces import Face, faces, slab
from .friction_axes import EVENLY, friction_scales, restitution
from .friction_filter import FrictionFilter, Side
from .generated_urdf import RIDER_MASS, MeshFile, Tree, describe_tree, untouching_links
from .size_limits import MAX_JOINTS
from .springs import compliance
from .surfaces import (
    Groups,
    compliant,
    contact_spring,
    is_rigid,
    jointed_mass,
    parting_rate,
    rolling_arm,
    surface_groups,
    with_edges,
    with_inner_first,
)
from .tuning import Tuning

ANY_SPEED = 1e6  # [rad/s or m/s] PyBullet would stop every joint at 100
_MASSLESS = Inertial(0.0)


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


def _masses(tree: Tree, body: Body, moments: Sequence[Vector]) -> Masses:
    """Return what of a tree weighs, and which of its joints move masses as they turn."""
    parts = tuple(
        Mass(body.parts[link.name].index, link.inertial.mass, of_link, link.gravity)
        for link, of_link in zip(tree.links, moments, strict=True)
        if link.inertial and not (tree.fixed_base and link is tree.links[0])
    )
    movable = [(joint, link) for link, joint in zip(tree.links, tree.joints, strict=True)
               if joint is not None and joint.type != FIXED]
    parents = {joint.parent for joint in tree.joints if joint}
    joints = tuple(body.joints[joint.name][1] for joint, _ in movable)
    unbalanced = tuple(body.joints[joint.name][1] for joint, link in movable
                       if link.name in parents or not is_balanced(link.inertial, joint))
    links = {link.name: link for link in tree.links[tree.fixed_base:] if link.inertial}
    given = [(joint.damping, joint.stiffness, joint.reference,
              compliance(joint, link, links.get(joint.parent))
              if joint.damping or joint.stiffness else 1.0) for joint, link in movable]
    return Masses(parts, joints, *(zip(*given, strict=True) if given else ((),) * 4), unbalanced,
                  tree.fixed_base)


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
        self._friction_filter = FrictionFilter()
        self._sides: dict[Place, tuple[Side, tuple[int, int]]] = {}  # with group and mask
        # What gives way, how, and the rate at which its overlaps are taken away [1/s].
        self._soft: dict[Place, tuple[Surface, float]] = {}
        self._step_size = 0.001

    def set_step_size(self, step_size: float) -> None:
        """Simulate in steps of that size [s] from now on; what soft contacts do depends on it."""
        if step_size != self._step_size:
            self._step_size = step_size
            for place in self._soft:
                self._set_spring(place)

    def add_tree(self, body: Body, tree: Tree, model_pose: Pose) -> None:
        """Put links that joints connect into the world, and note in `body` where they are.

        Args:
            model_pose: where the model's frame is.
        """
        inertials = [link.inertial or _MASSLESS for link in tree.links]
        moments, axes = zip(*(principal_axes(inertial) for inertial in inertials), strict=True)
        coms = [
            Pose(inertial.pose.position, orientation)
            for inertial, orientation in zip(inertials, axes, strict=True)
        ]
        mesh_file = self._surface_file if tree.stands else self._mesh_file
        groups, inner_first = grouped(tree, mesh_file)
        found = faces(tree, groups, inner_first, MAX_JOINTS + 1)
        place = compose(model_pose, tree.links[0].pose)
        # What stands is a rigid body for each of its faces; the first is the one that is asked.
        own, *others = [[[face]] for face in (*found[0], *slab(tree))] if tree.stands else [found]
        numbers = []
        for one in (own, *others):
            shapes = [[face.shapes for face in of_link] for of_link in one]
            text = describe_tree(tree, coms, shapes, mesh_file)
            numbers.append(self._load_urdf(text, tree, place))
            body.bodies.append(numbers[-1])
            body.size += len(text)
        number, *also = numbers
        shapes = [collision.geometry for link in tree.links for collision in link.collisions]
        meshes = [mesh_file(shape) for shape in shapes if isinstance(shape, Mesh)]
        body.size += sum(map(os.path.getsize, meshes))
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
            part = Part(number, index_of[f'l{i}'], inverse(coms[i]), coms[i], tuple(also))
            body.parts[link.name] = part
            pybullet.changeDynamics(
                number, part.index, localInertiaDiagonal=moments[i], physicsClientId=self._client
            )
            self._set_surfaces(body, tree, i, own[i], index_of, mass)
            if joint is not None and joint.type != FIXED:
                body.joints[joint.name] = (number, part.index)
                body.indices.setdefault(number, []).append(part.index)
            if not link.gravity and not (tree.fixed_base and i == 0):
                body.weightless.append((number, part.index, inertials[i].mass))
        if not tree.stands:
            body.masses[number] = _masses(tree, body, moments)
        for other, ((face,),) in zip(also, others, strict=True):
            self._add_face(body, tree.links[0], Place(other, -1), face)

    def _add_face(self, body: Body, link: LinkSpec, place: Place, face: Face) -> None:
        """Set up another body that a standing link touches with."""
        self._set_surface(place, face, face.shapes[0].surface, None)
        turn = body.parts[link.name].com_in_origin.orientation
        self._set_directions(body, place, face, link, turn)
        body.surfaces[link.name].append(place)

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
        for place in [place for place in self._sides if place.body in body.bodies]:
            del self._sides[place]
            self._soft.pop(place, None)

    def reset(self) -> None:
        """Remove everything."""
        pybullet.resetSimulation(physicsClientId=self._client)
        self._untouching.clear()
        self._friction_filter.clear()
        self._sides.clear()
        self._soft.clear()

    def _load_urdf(self, text: str, tree: Tree, pose: Pose) -> int:
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
                useMaximalCoordinates=tree.stands,
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

    def _set_surfaces(
        self,
        body: Body,
        tree: Tree,
        i: int,
        found: list[Face],
        index_of: dict[str, int],
        mass: float,
    ) -> None:
        """Set up what link `i` touches with, itself and its riders, and note it in `body`.

        Args:
            mass: as `jointed_mass` tells it [kg].
        """
        link, joint = tree.links[i], tree.joints[i]
        part = body.parts[link.name]
        body.surfaces[link.name] = surfaces = []
        for k, face in enumerate(found):
            index, turn = part.index, part.com_in_origin.orientation
            if k:  # a rider stands in the frame of the joint above its link
                index = index_of[f'l{i}r{k}']
                turn = joint.pose.orientation if joint else NO_ROTATION
                pybullet.changeDynamics(
                    part.body,
                    index,
                    localInertiaDiagonal=(RIDER_MASS,) * 3,
                    physicsClientId=self._client,
                )
            if face.shapes:
                place = Place(part.body, index)
                surface = compliant(face.shapes[0].surface, mass)
                self._set_surface(place, face, surface, joint)
                self._set_directions(body, place, face, link, turn)
                surfaces.append(place)

    def _set_surface(
        self, place: Place, face: Face, surface: Surface, joint: JointSpec | None
    ) -> None:
        """Set up a part of a body that touches with a face.

        Args:
            surface: that of the face, as compliant as it is to be.
            joint: what turns the part, if anything does.
        """
        pybullet.changeDynamics(
            *place,
            lateralFriction=face.friction,
            spinningFriction=0.0,
            rollingFriction=rolling_arm(face.shapes, joint),
            restitution=restitution(surface),
            physicsClientId=self._client,
        )
        if restitution(surface):
            # Else PyBullet brakes what is about to touch, and nothing is left to be given back.
            pybullet.changeDynamics(
                *place, contactProcessingThreshold=0.0, physicsClientId=self._client
            )
        self._set_filter(place, face.side)
        if not is_rigid(surface):
            self._soft[place] = surface, self._parting_rate(place)
            self._set_spring(place)

    def _set_spring(self, place: Place) -> None:
        """Let a part give way as its surface does in steps of the present size."""
        surface, rate = self._soft[place]
        stiffness, damping = contact_spring(surface, self._step_size, rate)
        pybullet.changeDynamics(
            *place,
            contactStiffness=stiffness,
            contactDamping=damping,
            physicsClientId=self._client,
        )

    def _parting_rate(self, place: Place) -> float:
        """Return the rate at which contacts of a part take away an overlap [1/s]."""
        low, high = pybullet.getAABB(*place, self._client)
        reach = max(b - a for a, b in zip(low, high, strict=True))
        return parting_rate(reach, self._tuning.push_out)

    def _set_filter(self, place: Place, side: Side) -> None:
        """Let a part meet those it is to meet; a new mu changes whom others meet."""
        self._sides[place] = side, (0, 0)
        changed = list(self._sides) if self._friction_filter.add(side.mu) else [place]
        for one in changed:
            of_one, before = self._sides[one]
            now = self._friction_filter.group_and_mask(of_one)
            if now != before:
                self._sides[one] = of_one, now
                pybullet.setCollisionFilterGroupMask(*one, *now, self._client)

    def _set_directions(
        self, body: Body, place: Place, face: Face, link: LinkSpec, turn: Quaternion
    ) -> None:
        """Let a part hold less along some of its axes; `turn` turns them into those of its link."""
        scales = friction_scales(face.shapes[0], link, turn, face.friction)
        body.friction_axes[place] = FrictionAxes(turn, scales)
        if scales != EVENLY:
            self.scale_friction(place, scales)

    def scale_friction(self, place: Place, scales: Sequence[float]) -> None:
        """Let a part hold these shares of its friction along its own axes."""
        pybullet.changeDynamics(*place, anisotropicFriction=scales, physicsClientId=self._client)
