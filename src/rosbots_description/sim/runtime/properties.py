"""Properties of models that can be changed while they move: friction and mass."""

import math
from dataclasses import replace

from ..core import MAX_INERTIA, MAX_MASS, MIN_MASS, NotFoundError, SimError
from ..description import Collision, Inertial, LinkSpec
from ..description.inertia import is_positive, regularised
from .model import CollisionFrame, Link
from .world import World


def collisions_named(world: World, name: str) -> list[CollisionFrame]:
    """Return the collisions of that name, or in the link or model of that name.

    Raises:
        NotFoundError: there is none of them.
    """
    model = world.find_model(name)
    if model is not None:
        return [one for link in model.links.values() for one in link.collisions.values()]
    match world.find_entity(name):
        case Link() as link:
            return list(link.collisions.values())
        case CollisionFrame() as collision:
            return [collision]
    raise NotFoundError(f"there is no model, link or collision named '{name}'")


def set_friction(world: World, name: str, mu: float, mu2: float) -> None:
    """Set the friction coefficients of a collision, or of all in a link or model; motion stays.

    Raises:
        NotFoundError: nothing has that name.
        SimError: it has no collision, or a coefficient is negative or not finite.
    """
    found = collisions_named(world, name)
    if not found:
        raise SimError(f"'{name}' has no collision, so it has no friction")
    if not 0.0 <= min(mu, mu2) <= max(mu, mu2) < math.inf:
        raise SimError(f"friction of '{name}' is {min(mu, mu2):g}; it must not be negative")

    def changed(collision: Collision) -> Collision:
        return replace(collision, surface=replace(collision.surface, mu=mu, mu2=mu2))

    names = {(frame.link.name, frame.name) for frame in found}

    def with_friction(link: LinkSpec) -> LinkSpec:
        collisions = (
            changed(one) if (link.name, one.name) in names else one for one in link.collisions
        )
        return replace(link, collisions=tuple(collisions))

    found[0].link.model.change_links(with_friction)


def set_inertial(link: Link, inertial: Inertial, gravity: bool) -> None:
    """Set the mass, the inertia and the gravity mode of a link; its velocity is kept.

    Args:
        inertial: its tensor is in the axes of the link.
        gravity: whether gravity acts on the link.
    Raises:
        SimError: the link moves, and mass or inertia are out of range.
    """
    model = link.model
    if not model.static:
        inertial = _movable(link, inertial)
    changed = replace(link.spec, inertial=inertial, gravity=gravity)
    before = link.spec
    model.change_links(lambda spec: changed if spec is before else spec)


def _movable(link: Link, inertial: Inertial) -> Inertial:
    """Return an inertial that can be simulated."""
    if not inertial.mass > 0.0:
        raise SimError(
            f"mass is {inertial.mass}; link '{link.scoped_name}' moves, so it must be greater "
            'than zero [kg]'
        )
    moments = (inertial.ixx, inertial.iyy, inertial.izz, inertial.ixy, inertial.ixz, inertial.iyz)
    if not MIN_MASS <= inertial.mass <= MAX_MASS or max(map(abs, moments)) > MAX_INERTIA:
        raise SimError(
            f"mass or inertia of link '{link.scoped_name}' is out of range: "
            f'{MIN_MASS:g} to {MAX_MASS:g} kg and at most {MAX_INERTIA:g} kg m^2 are accepted'
        )
    if not is_positive(inertial):
        raise SimError(
            f"the inertia tensor for link '{link.scoped_name}' has a negative principal moment; "
            'give the tensor about the centre of mass [kg m^2]'
        )
    return regularised(inertial)
