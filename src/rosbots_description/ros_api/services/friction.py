"""Services about the friction of collisions, which Gazebo does not have."""

from dataclasses import replace

from rosbots_msgs.srv import (
    GetFriction,
    GetFrictionRequest,
    GetFrictionResponse,
    SetFriction,
    SetFrictionRequest,
    SetFrictionResponse,
)

from ...sim.core import NotFoundError
from ...sim.description import Collision
from ...sim.runtime import CollisionFrame, Link, World
from ..messages import RequestError, require_finite
from ..server import Server
from .registry import EXTENSIONS, service


@service('get_friction', GetFriction, table=EXTENSIONS)
def get_friction(server: Server, request: GetFrictionRequest) -> GetFrictionResponse:
    """Return the friction coefficients of the collisions of a model, a link, or of one."""
    found = _collisions(server.world, request.name)
    surfaces = [frame.spec.surface for frame in found]
    return GetFrictionResponse(
        True, 'GetFriction: got friction', [frame.scoped_name for frame in found],
        [surface.mu for surface in surfaces], [surface.mu2 for surface in surfaces])


@service('set_friction', SetFriction, table=EXTENSIONS)
def set_friction(server: Server, request: SetFrictionRequest) -> SetFrictionResponse:
    """Change the friction coefficients of those collisions; the motion stays."""
    require_finite(request)
    found = _collisions(server.world, request.name)
    if not found:
        raise RequestError(f"'{request.name}' has no collision, so it has no friction")
    if min(request.mu, request.mu2) < 0.0:
        raise RequestError(f"friction of '{request.name}' is {min(request.mu, request.mu2):g}; "
                           'it must not be negative')

    def changed(collision: Collision) -> Collision:
        return replace(
            collision, surface=replace(collision.surface, mu=request.mu, mu2=request.mu2))

    model, names = found[0].link.model, {(frame.link.name, frame.name) for frame in found}
    model.respecify(replace(model.spec, links=tuple(
        replace(link, collisions=tuple(
            changed(one) if (link.name, one.name) in names else one for one in link.collisions))
        for link in model.spec.links)))
    return SetFrictionResponse(True, 'SetFriction: friction set')


def _collisions(world: World, name: str) -> list[CollisionFrame]:
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
