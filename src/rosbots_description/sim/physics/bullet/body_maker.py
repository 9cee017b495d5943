"""Creates PyBullet bodies from compiled models (compiler.py)."""

import os
from collections.abc import Mapping, Sequence
from itertools import combinations, product

from ...core import Pose, Vector, compose, inverse
from ...description import FIXED, PRISMATIC, ModelSpec, Surface
from ...description.inertia import is_balanced
from .body import Body, Mass, Masses, Part, Place
from .client import pybullet
from .collision_filter import Bitmasks, CollisionFilter
from .compiler import CompiledContactPart, CompiledTree
from .contact_stiffness import contact_spring, is_rigid, parting_rate
from .friction_axes import ISOTROPIC
from .friction_pairs import FrictionPairs, Side
from .generated_urdf import AUXILIARY_MASS, Tree, filtered_links
from .sleep import rest_for_good
from .springs import compliance
from .tuning import Tuning

ANY_SPEED = 1e6  # [rad/s or m/s]; PyBullet's default limit is 100


def _masses(tree: Tree, body: Body, moments: Sequence[Vector]) -> Masses:
    """Return the inertial and joint parameters of a tree."""
    parts = tuple(
        Mass(body.parts[link.name].index, link.inertial.mass, of_link, link.gravity)
        for link, of_link in zip(tree.links, moments, strict=True)
        if link.inertial and not (tree.fixed_base and link is tree.links[0])
    )
    movable = [
        (joint, link)
        for link, joint in zip(tree.links, tree.joints, strict=True)
        if joint is not None and joint.type != FIXED
    ]
    parents = {joint.parent for joint in tree.joints if joint}
    joints = tuple(body.joints[joint.name][1] for joint, _ in movable)
    unbalanced = tuple(
        body.joints[joint.name][1]
        for joint, link in movable
        if link.name in parents or link.inertial is None or not is_balanced(link.inertial, joint)
    )
    links = {link.name: link for link in tree.links[tree.fixed_base :] if link.inertial}
    given = [
        (
            joint.damping,
            joint.stiffness,
            joint.reference,
            compliance(joint, link, links.get(joint.parent))
            if joint.damping or joint.stiffness
            else 1.0,
        )
        for joint, link in movable
    ]
    damping, stiffness, reference, compliances = zip(*given, strict=True) if given else ((),) * 4
    return Masses(
        parts, joints, damping, stiffness, reference, compliances, unbalanced, tree.fixed_base
    )


class BodyMaker:
    """Creates bodies in one PyBullet world: rigid bodies, with all motors off."""

    def __init__(self, client: int, tuning: Tuning) -> None:
        """Work in the world of that PyBullet client."""
        self._client = client
        self._tuning = tuning
        self._collision_filter = CollisionFilter(client)
        self._friction_pairs = FrictionPairs()
        self._sides: dict[Place, tuple[Side, tuple[int, int]]] = {}  # with group and mask
        # Compliant parts: surface, and the rate at which their penetration is corrected [1/s].
        self._soft: dict[Place, tuple[Surface, float]] = {}
        self._bitmasks = Bitmasks(self._collision_filter)
        self._step_size = 0.001

    def set_step_size(self, step_size: float) -> None:
        """Set the step size [s]; the damping of compliant contacts depends on it."""
        if step_size != self._step_size:
            self._step_size = step_size
            for place in self._soft:
                self._set_spring(place)

    def add_tree(self, body: Body, compiled: CompiledTree, model_pose: Pose) -> None:
        """Add a kinematic tree to the world, and record its links and joints in `body`.

        Args:
            model_pose: pose of the model's frame in the world.
        """
        tree = compiled.tree
        place = compose(model_pose, tree.links[0].pose)
        numbers = []
        for one in compiled.bodies:
            numbers.append(self._load_urdf(one.text, tree, place))
            body.bodies.append(numbers[-1])
        number, *also = numbers
        body.roots.append(tree.links[0].name)
        if tree.fixed_base:
            body.fixed_roots.add(tree.links[0].name)
        index_of = self._indices(number)
        # A separate call: given an inertia as well, PyBullet would assign it to the base.
        self._change(
            Place(number, -1),
            linearDamping=tree.links[0].linear_damping,
            angularDamping=tree.links[0].angular_damping,
            maxJointVelocity=ANY_SPEED,
        )
        for i, (link, joint) in enumerate(zip(tree.links, tree.joints, strict=True)):
            com = compiled.inertials[i]
            part = Part(number, index_of[f'l{i}'], inverse(com), com, tuple(also))
            body.parts[link.name] = part
            self._change(Place(number, part.index), localInertiaDiagonal=compiled.moments[i])
            contact_parts = compiled.bodies[0].contact_parts[i]
            places = [part.index, *(index_of[f'l{i}a{k}'] for k in range(1, len(contact_parts)))]
            self._set_auxiliary_inertias(number, places[1:])
            body.surfaces[link.name] = []
            for index, touching in zip(places, contact_parts, strict=True):
                self._set_contact_part(body, link.name, Place(number, index), touching)
            if joint is not None and joint.type != FIXED:
                body.joints[joint.name] = (number, part.index)
                body.joint_axes[joint.name] = joint.axis_in_child, joint.type != PRISMATIC
                indices = body.indices.setdefault(number, [])
                body.rows[joint.name] = number, len(indices)
                indices.append(part.index)
            if not link.gravity and not (tree.fixed_base and i == 0):
                mass = link.inertial.mass if link.inertial else 0.0
                body.weightless.append((number, part.index, mass))
        if tree.is_static:
            for still in numbers:
                rest_for_good(still, self._client)
        else:
            body.masses[number] = _masses(tree, body, compiled.moments)
        for other, one in zip(also, compiled.bodies[1:], strict=True):
            self._set_contact_part(
                body, tree.links[0].name, Place(other, -1), one.contact_parts[0][0]
            )

    def exclude_collisions_within(self, body: Body, spec: ModelSpec) -> None:
        """Disable collisions between the links of a model that do not collide in Gazebo."""
        if len(body.bodies) == 1 and not any(link.self_collide for link in spec.links):
            return  # a body without the self-collision flag never collides with itself
        if spec.static:
            return  # static bodies do not collide with each other
        places = body.surfaces
        for own in places.values():
            for one, other in combinations(own, 2):
                self._collision_filter.add(one, other)
        for a, b in filtered_links(spec):
            for one, other in product(places[a], places[b]):
                self._collision_filter.add(one, other)

    def remove(self, body: Body) -> None:
        """Take a body out of the world."""
        for number in body.bodies:
            pybullet.removeBody(number, self._client)
        for number in body.bodies:
            self._collision_filter.remove(number)
        for place in [place for place in self._sides if place.body in body.bodies]:
            del self._sides[place]
            self._bitmasks.remove(place)
            self._soft.pop(place, None)

    def set_masses(self, bodies: Mapping[int, Masses]) -> None:
        """Give bodies, by PyBullet's numbers, other masses and moments."""
        for number, masses in bodies.items():
            for part in masses.parts:
                # Two calls: the first one also sets moments, those of the shape.
                self._change(Place(number, part.link), mass=part.mass)
                self._change(Place(number, part.link), localInertiaDiagonal=part.moments)

    def scale_link_friction(self, body: Body, link: str, factor: float) -> None:
        """Multiply the friction of each contact of a link by a factor."""
        body.friction_scales.pop(link, None)
        if factor != 1.0:
            body.friction_scales[link] = factor
        for place in body.surfaces[link]:
            self._change(place, lateralFriction=factor * body.frictions[place])

    def reset(self) -> None:
        """Remove everything."""
        pybullet.resetSimulation(physicsClientId=self._client)
        self._collision_filter.clear()
        self._bitmasks.clear()
        self._friction_pairs.clear()
        self._sides.clear()
        self._soft.clear()

    def _load_urdf(self, text: str, tree: Tree, pose: Pose) -> int:
        flags = pybullet.URDF_USE_INERTIA_FROM_FILE
        if self._tuning.exact_cylinders:
            flags |= pybullet.URDF_USE_IMPLICIT_CYLINDER
        if sum(link.self_collide for link in tree.links) > 1:
            # Makes a step four times as expensive, so only on request.
            flags |= pybullet.URDF_USE_SELF_COLLISION
        # A file in memory: uses no disk space and needs no clean-up.
        descriptor = os.memfd_create('model')
        try:
            os.write(descriptor, text.encode())
            number: int = pybullet.loadURDF(
                f'/proc/self/fd/{descriptor}',
                *pose,
                useFixedBase=tree.fixed_base,
                useMaximalCoordinates=tree.is_static,
                flags=flags,
                physicsClientId=self._client,
            )
            return number
        finally:
            os.close(descriptor)

    def _indices(self, number: int) -> dict[str, int]:
        """Return PyBullet's index of each link of a body; the root `l0` is the base, -1."""
        indices = {'l0': -1}
        for index in range(pybullet.getNumJoints(number, self._client)):
            indices[pybullet.getJointInfo(number, index, self._client)[12].decode()] = index
        return indices

    def _set_auxiliary_inertias(self, number: int, indices: Sequence[int]) -> None:
        for index in indices:
            self._change(Place(number, index), localInertiaDiagonal=(AUXILIARY_MASS,) * 3)

    def _change(self, place: Place, **properties: object) -> None:
        """Set dynamic properties of a link or a part."""
        pybullet.changeDynamics(*place, **properties, physicsClientId=self._client)

    def _set_contact_part(
        self, body: Body, link: str, place: Place, part: CompiledContactPart | None
    ) -> None:
        """Set the contact properties of a part of a link, and record the part in `body`."""
        if part is None:
            return
        body.surfaces[link].append(place)
        self._change(
            place,
            lateralFriction=part.friction,
            spinningFriction=0.0,
            rollingFriction=part.rolling_friction,
            restitution=part.restitution,
        )
        if part.restitution:
            # Else PyBullet slows a body before it touches, so that no speed is left for a bounce.
            self._change(place, contactProcessingThreshold=0.0)
        self._set_filter(place, part.side)
        self._bitmasks.add(place, part.surface)
        if not is_rigid(part.surface):
            self._soft[place] = part.surface, self._parting_rate(place)
            self._set_spring(place)
        body.shapes[place] = part.shapes
        body.frictions[place] = part.friction
        body.friction_axes[place] = part.axes
        if part.axes.scales != ISOTROPIC:
            self.scale_friction(place, part.axes.scales)

    def _set_spring(self, place: Place) -> None:
        """Set contact stiffness and damping of a compliant part for the current step size."""
        surface, rate = self._soft[place]
        stiffness, damping = contact_spring(surface, self._step_size, rate)
        self._change(place, contactStiffness=stiffness, contactDamping=damping)

    def _parting_rate(self, place: Place) -> float:
        """Return the rate at which contacts of a part correct penetration [1/s]."""
        low, high = pybullet.getAABB(*place, self._client)
        reach = max(b - a for a, b in zip(low, high, strict=True))
        return parting_rate(reach, self._tuning.push_out)

    def _set_filter(self, place: Place, side: Side) -> None:
        """Set the collision filter of a part; a new mu changes the masks of other parts."""
        self._sides[place] = side, (0, 0)
        changed = list(self._sides) if self._friction_pairs.add(side.mu) else [place]
        for one in changed:
            of_one, before = self._sides[one]
            now = self._friction_pairs.group_and_mask(of_one)
            if now != before:
                self._sides[one] = of_one, now
                pybullet.setCollisionFilterGroupMask(*one, *now, self._client)

    def scale_friction(self, place: Place, scales: Sequence[float]) -> None:
        """Scale the friction of a part along its own axes."""
        pybullet.changeDynamics(*place, anisotropicFriction=scales, physicsClientId=self._client)
